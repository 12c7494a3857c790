#!/usr/bin/python3
"""Draws the two pictures of the README from two runs: needles.png and cooling.png, beside this file.

    docs/pictures/draw.py [--program build/release/needlework]

needles.png is what `needlework view` makes of the last frame of profiles/quickstart.toml.
cooling.png shows the series of profiles/cooling-dilute.toml beside kinetic theory. The runs take
less than a minute. Needs python3-h5py and python3-matplotlib.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402
from PIL import Image  # noqa: E402

HERE = Path(__file__).resolve().parent
PROFILES = HERE.parents[1] / "profiles"


def run(program, scene, file):
    subprocess.run([program, "run", PROFILES / scene, "--out", file, "--quiet"], check=True)


def make_small(picture):
    """With 256 colours, which make the file a third as large."""
    Image.open(picture).convert("RGB").quantize(256, kmeans=4).save(picture, optimize=True)


def theory(program, tau):
    """Temperatures of the scene at these times, by kinetic theory."""
    flags = [part for t in tau for part in ("--tau", repr(float(t)))]
    printed = subprocess.run([program, "theory", "--epsilon", "0.8", "--k", "6", "--t-rot0", "0",
                              "--json", *flags], check=True, capture_output=True, text=True).stdout
    curve = json.loads(printed)
    return [np.array(curve[name]) for name in ("energy", "t_tr", "t_rot")]


def draw_cooling(program, file, picture):
    with h5py.File(file) as f:
        time = f["series/energy/time"][1:]
        energy, t_tr, t_rot = (f["series"][name]["value"][:] for name in ("energy", "t_tr", "t_rot"))
        box = np.diagonal(f["particles/needles/box/edges/value"][0])
        count = len(f["particles/needles/id"])
    tau = 2 / 3 * np.sqrt(np.pi) * count / np.prod(box) * time
    energy_theory, t_tr_theory, t_rot_theory = theory(program, tau)
    start = energy[0]
    energy, ratio = energy[1:], t_tr[1:] / t_rot[1:]

    plt.rcParams["font.size"] = 11
    figure, (top, middle, bottom) = plt.subplots(
        3, 1, figsize=(6.4, 6.4), sharex=True, gridspec_kw={"height_ratios": [3.2, 1, 1]})
    measured = {"color": "#d1495b", "marker": "o", "markersize": 3.6, "linestyle": "none"}
    line = {"color": "#1d3557", "linewidth": 1.6}
    top.loglog(time, energy_theory / start, **line, label="kinetic theory")
    top.loglog(time, energy / start, **measured, label="10000 needles")
    top.set_ylabel("E / E(0)")
    top.set_ylim(3e-12, 4)
    top.annotate("E ~ 1 / time²", (2e4, 2.5e-6), xytext=(1.2e5, 2e-4),
                 arrowprops={"arrowstyle": "-", "color": "#888888"}, color="#444444")
    top.legend(frameon=False, loc="lower left")
    middle.axhline(1, **line)
    middle.semilogx(time, energy / energy_theory, **measured)
    middle.set_ylim(0.9, 1.1)
    middle.set_ylabel("E / theory")
    bottom.loglog(time, t_tr_theory / t_rot_theory, **line)
    bottom.loglog(time, ratio, **measured)
    bottom.set_ylim(0.8, 30)
    bottom.set_yticks([1, 3, 10, 30], labels=["1", "3", "10", "30"])
    bottom.yaxis.set_minor_formatter(NullFormatter())
    bottom.set_ylabel(r"$T_{\rm tr}\ /\ T_{\rm rot}$")
    bottom.set_xlabel(r"time  [$L\sqrt{m/T}$]")
    for axes in (top, middle, bottom):
        axes.grid(color="#e4e4e4", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(0.1, 3e7)
    figure.align_ylabels()
    figure.tight_layout(h_pad=0.6)
    figure.savefig(picture, dpi=130)
    make_small(picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/needlework", help="the program to run")
    program = parser.parse_args().program
    with tempfile.TemporaryDirectory() as folder:
        quickstart, cooling = Path(folder, "quickstart.h5"), Path(folder, "cooling.h5")
        run(program, "quickstart.toml", quickstart)
        subprocess.run([program, "view", quickstart, "-o", HERE / "needles.png", "--force"],
                       check=True)
        make_small(HERE / "needles.png")
        run(program, "cooling-dilute.toml", cooling)
        draw_cooling(program, cooling, HERE / "cooling.png")


if __name__ == "__main__":
    main()
