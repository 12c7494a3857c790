#!/usr/bin/python3
"""A number that is added to the list of a result is in every interface: this adds one to that of
contacts, in a copy of the sources, and looks for it in JSON, over a pipe, in the summary, the series of
a file, Python, C, Fortran, the documents and what a report is made of.

    made_up.py FOLDER    builds in FOLDER, which takes some minutes

"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = """needles = { count = 20, box = 3 }
collisions = { epsilon = 0.5, sliding = true }
until.time = 1
output = { file = "made_up.h5", series_every = 0.5 }
"""
CLIENT = """
#include <needlework.h>
#include <stdio.h>
int main(void) {
  needlework_error error;
  needlework_simulation* gas = needlework_open("scene.toml", NEEDLEWORK_REPLACE, &error);
  needlework_contacts contacts;
  if (!gas || needlework_get_contacts(gas, &contacts)) return 1;
  printf("%llu %g", (unsigned long long)contacts.made_up, contacts.share);
  needlework_close(gas);
  return 0;
}
"""


def changed(path, old, new):
    text = path.read_text()
    assert text.count(old) == 1, f"{path}: expected once: {old}"
    path.write_text(text.replace(old, new))


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          check=False, **options)
    assert done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
    return done.stdout


def main():
    folder = Path(sys.argv[1]).resolve()
    copy, build = folder / "sources", folder / "build"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns("build", "build-*", ".git"))

    totals = copy / "include/needlework/totals.h"
    changed(totals, "  double time = 0, share = 0;\n",
            "  std::uint64_t made_up = 42;\n  double time = 0, share = 0;\n")
    changed(totals, '        Described{"time", unit::time,',
            '        Described{"made_up", unit::none, "Number that a test made up"}, made_up);\n'
            '    visit(\n        Described{"time", unit::time,')

    run("cmake", "--preset", "release", "-S", copy, "-B", build, "-DNEEDLEWORK_TESTS=ON", cwd=copy)
    targets = ["describe_results", "needlework_program", "needlework_c", "needlework_python"]
    run("cmake", "--build", build, "--target", *targets)
    declare = copy / "tests/results/declare.py"
    run(declare, build / "describe_results")
    run("cmake", "--build", build, "--target", *targets)

    program = build / "needlework"
    (folder / "scene.toml").write_text(SCENE)
    run_once = [program, "run", "scene.toml", "--force"]
    assert json.loads(run(*run_once, "--json", "--quiet", cwd=folder))["contacts"]["made_up"] == 42
    assert "made up 42" in run(*run_once, cwd=folder)
    requests = "".join(json.dumps(each) + "\n" for each in (
        {"do": "create", "scene": SCENE.replace("output", "#")},
        {"do": "advance", "simulation": 1, "time": 1}))
    answers = run(program, "serve", cwd=folder, input=requests).splitlines()
    assert json.loads(answers[-1])["contacts"]["made_up"] == 42, answers[-1]

    look = ("import h5py, needlework; "
            "assert list(h5py.File('made_up.h5')['series/contacts/made_up/value']) == [42] * 3; "
            "sim = needlework.Simulation('scene.toml', force=True); "
            "assert sim.sliding_contacts.made_up == 42; sim.close()")
    run("/usr/bin/python3", "-c", look, cwd=folder,
        env={**os.environ, "PYTHONPATH": str(build / "python")})

    (folder / "client.c").write_text(CLIENT)
    run("cc", "client.c", f"-I{copy}/include", f"-L{build}", "-lneedlework", f"-Wl,-rpath,{build}",
        "-o", "client", cwd=folder)
    assert run(folder / "client", cwd=folder).startswith("42 ")

    for file, text in {"examples/fortran/needlework.f90": ":: made_up",
                       "python/needlework/simulation.py": "made_up: int",
                       "docs/json.md": "| `made_up` |",
                       "docs/file-format.md": "| `/series/contacts/made_up` |"}.items():
        assert text in (copy / file).read_text(), file
    # The page of a report lists what it finds in this group of the file.
    run(program, "report", "made_up.h5", "-o", "report.html", "--force", cwd=folder)
    assert "made_up" in (folder / "report.html").read_text()
    print("a number that was added to one list is everywhere")


if __name__ == "__main__":
    main()
