#!/usr/bin/env python3
"""Draws the pictures of ../reproduction.md from the data beside it, as `needlework reproduce all
--from` does, but as PNG of few colours, which are small. Each names the digest of its data.

    PYTHONPATH=build/release/python /usr/bin/python3 docs/reproduction/pictures.py [FIGURE]...
"""

import hashlib
import io
import sys
from pathlib import Path

from needlework.reproduce import FIGURES
from needlework.reproduce.figure import read_table
from needlework.reproduce.style import styled
from PIL import Image
from PIL.PngImagePlugin import PngInfo

HERE = Path(__file__).resolve().parent


def draw(figure):
    data, drawn = HERE / figure.data_file, io.BytesIO()
    with styled():
        figure.draw(read_table(data)).savefig(drawn, format="png", dpi=110)
    text = PngInfo()
    text.add_text("Title", figure.title)
    text.add_text("Data", hashlib.sha256(data.read_bytes()).hexdigest())
    picture = Image.open(drawn).convert("RGB").quantize(160, dither=Image.Dither.NONE)
    picture.save(HERE / f"figure-{figure.name}.png", optimize=True, pnginfo=text)


if __name__ == "__main__":
    committed = (name for name, figure in FIGURES.items() if (HERE / figure.data_file).exists())
    for name in sys.argv[1:] or committed:
        draw(FIGURES[name])
