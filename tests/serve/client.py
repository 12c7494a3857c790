"""The example of a client over a pipe runs, and gets the trajectory of the program.

    client.py NEEDLEWORK
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

CLIENT = Path(__file__).resolve().parents[2] / "examples/pipe/client.pl"


def main(needlework):
    printed = subprocess.run(["perl", CLIENT, needlework], check=True, text=True,
                             capture_output=True, timeout=300).stdout
    hash_of_client, = re.findall(r"^hash (\w+)$", printed, flags=re.M)
    scene, = re.findall(r"<<'TOML';\n(.*?)^TOML$", CLIENT.read_text(), flags=re.M | re.S)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "scene.toml")
        file.write_text(scene + "[until]\ncollisions_per_needle = 20\n")
        report = json.loads(subprocess.run([needlework, "run", file, "--json", "--quiet"],
                                           check=True, text=True, capture_output=True).stdout)
    assert hash_of_client == report["trajectory_hash"], (printed, report)


if __name__ == "__main__":
    main(*sys.argv[1:])
