"""What the documents show works: scenes, configurations, the Python and the C++ programs.

    examples.py NEEDLEWORK README_PROGRAM
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def blocks(document, language):
    found = re.findall(rf"^```{language}\n(.*?)^```", (ROOT / document).read_text(),
                       flags=re.M | re.S)
    assert found, f"{document}: expected a block of {language}"
    return found


def main(needlework, readme_program):
    with tempfile.TemporaryDirectory() as folder:
        def run(*command):
            done = subprocess.run([str(part) for part in command], cwd=folder, text=True,
                                  capture_output=True, timeout=200)
            assert done.returncode == 0, (command, done.returncode, done.stdout, done.stderr)
            return done.stdout

        # The first run of the guide, but shorter.
        run(needlework, "run", ROOT / "profiles/quickstart.toml", "--out", "cooling.h5",
            "--set", "until.energy_ratio=1e-2")
        run(needlework, "export", "cooling.h5", "first.xyz", "--frame", "first")
        run(needlework, "export", "cooling.h5", "run.xyz")
        for number, script in enumerate(blocks("docs/user-guide.md", "python") +
                                        blocks("docs/formats.md", "python")):
            path = Path(folder, f"script{number}.py")
            path.write_text(script)
            assert run(sys.executable, path).strip(), path.read_text()
        run(needlework, "export", "cooling.h5", "cooling.vtkhdf")
        run(needlework, "view", "cooling.h5", "-o", "needles.png")

        lines, = blocks("docs/formats.md", "xml")
        Path(folder, "lines.xml").write_text(lines)
        run(needlework, "import", "lines.xml", "--out", "lines")
        run(needlework, "run", "lines/scene.toml", "--set", "until.collisions_per_needle=1")

        for language in ("xyz", "lammps"):
            text, = blocks("docs/formats.md", language)
            Path(folder, "two").write_text(text)
            run(needlework, "import", "two", "--out", language)
            printed = run(needlework, "run", f"{language}/scene.toml")
            assert "2 needles in a box of 6 x 6 x 6, elastic" in printed, printed

        for document in ("README.md", "docs/scenes.md", "docs/user-guide.md"):
            for text in blocks(document, "toml"):
                Path(folder, "gas.toml").write_text(text)
                run(needlework, "check", "gas.toml")

        gas, = blocks("README.md", "toml")
        Path(folder, "gas.toml").write_text(gas)
        run(needlework, "run", "gas.toml", "--log", "gas.jsonl")
        ended = json.loads(Path(folder, "gas.jsonl").read_text().splitlines()[-1])
        # What packages must give where they are installed: packaging/test.sh.
        assert ended["trajectory_hash"] == (ROOT / "packaging/first-run.hash").read_text().strip(), ended
        script, = blocks("docs/json.md", "python")
        printed = run(sys.executable, "-c", script)
        assert "energy at collision" in printed, printed
        assert "/particles/needles: 1000 particles" in run(needlework, "info", "gas.h5")
        printed = run(readme_program).splitlines()
        assert len(printed) == 5 and printed[-1].startswith("hash "), printed
        # The library's program says when to end by itself, and what is wrong with a scene.
        without_end = "\n".join(line for line in gas.splitlines() if "until" not in line)
        Path(folder, "gas.toml").write_text(without_end)
        assert run(readme_program).splitlines() == printed
        Path(folder, "gas.toml").write_text(without_end + "\nwrong = 1\n")
        refused = subprocess.run([readme_program], cwd=folder, capture_output=True, text=True)
        assert refused.returncode == 1 and "gas.toml: line" in refused.stderr, refused


if __name__ == "__main__":
    main(*(Path(argument).resolve() for argument in sys.argv[1:]))
