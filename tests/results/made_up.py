#!/usr/bin/python3
"""A number that is added to the list of a result is in every interface: this adds one to that of
contacts and one to the totals of the gas, in a copy of the sources, and looks for them in JSON, over a
pipe, in the summary, the series of a file, the summary of a sweep, Python, C, Fortran, the documents
and what a report is made of.

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
  needlework_totals totals;
  if (!gas || needlework_get_contacts(gas, &contacts) || needlework_get_totals(gas, &totals)) return 1;
  printf("%llu %llu %g", (unsigned long long)contacts.made_up, (unsigned long long)totals.made_up_sum,
         totals.epoch_length);
  needlework_close(gas);
  return 0;
}
"""


SWEEP = "scene = 'scene.toml'\nseeds = [1, 2]\n"


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
    changed(totals, "  std::uint64_t tc_collisions = 0;\n",
            "  std::uint64_t tc_collisions = 0;\n  std::uint64_t made_up_sum = 43;\n")
    changed(totals, "          &Totals::tc_collisions);\n",
            "          &Totals::tc_collisions);\n"
            '    visit(Described{"made_up_sum", unit::none, "Sum that a test made up"},'
            " &Totals::made_up_sum);\n")

    # To compile quickly.
    run("cmake", "--preset", "release", "-S", copy, "-B", build, "-DNEEDLEWORK_TESTS=ON",
        "-DCMAKE_CXX_FLAGS_RELEASE=-O0", cwd=copy)
    run("cmake", "--build", build, "--target", "describe_results")
    declare = copy / "tests/results/declare.py"
    run(declare, build / "describe_results")
    run("cmake", "--build", build, "--target", "needlework_program", "needlework_c", "needlework_python")

    program = build / "needlework"
    (folder / "scene.toml").write_text(SCENE)
    run_once = [program, "run", "scene.toml", "--force"]
    result = json.loads(run(*run_once, "--json", "--quiet", cwd=folder))
    assert result["contacts"]["made_up"] == 42 and result["made_up_sum"] == 43, result
    summary = run(*run_once, cwd=folder)
    assert "made up 42" in summary and "made up sum 43" in summary, summary
    named = SCENE.replace("series_every", 'observables = ["made_up_sum"], series_every')
    (folder / "named.toml").write_text(named)
    run(program, "check", "named.toml", cwd=folder)
    requests = "".join(json.dumps(each) + "\n" for each in (
        {"do": "create", "scene": SCENE.replace("output", "#")},
        {"do": "advance", "simulation": 1, "time": 1}))
    answers = run(program, "serve", cwd=folder, input=requests).splitlines()
    answer = json.loads(answers[-1])
    assert answer["contacts"]["made_up"] == 42 and answer["made_up_sum"] == 43, answer

    (folder / "grid.toml").write_text(SWEEP)
    run(program, "sweep", "grid.toml", "--out", "sweep", "--quiet", cwd=folder)
    look = ("import h5py, needlework; "
            "file = h5py.File('made_up.h5'); "
            "assert list(file['series/contacts/made_up/value']) == [42] * 3; "
            "assert list(file['series/made_up_sum/value']) == [43] * 3; "
            "assert set(file['observables/made_up_sum/value']) == {43}; "
            "assert 'Sum that a test made up' in file['series/made_up_sum'].attrs['description']; "
            "assert list(needlework.read('made_up.h5').series.made_up_sum) == [43] * 3; "
            "means = h5py.File('sweep/summary.h5'); "
            "assert list(means['results/made_up_sum/mean']) == [43]; "
            "assert set(means['series/00000/made_up_sum/mean']) == {43}; "
            "file.close(); sim = needlework.Simulation('scene.toml', force=True); "
            "assert sim.sliding_contacts.made_up == 42 and sim.totals.made_up_sum == 43; sim.close()")
    run("/usr/bin/python3", "-c", look, cwd=folder,
        env={**os.environ, "PYTHONPATH": str(build / "python")})

    (folder / "client.c").write_text(CLIENT)
    run("cc", "client.c", f"-I{copy}/include", f"-L{build}", "-lneedlework", f"-Wl,-rpath,{build}",
        "-o", "client", cwd=folder)
    printed = run(folder / "client", cwd=folder).split()
    assert printed[:2] == ["42", "43"] and float(printed[2]) > 0, printed

    for file, texts in {"examples/fortran/needlework.f90": [":: made_up\n", ":: made_up_sum\n"],
                        "python/needlework/simulation.py": ["made_up: int", "made_up_sum: int"],
                        "python/needlework/reading.py": ["made_up_sum: np.ndarray"],
                        "docs/json.md": ["| `made_up` |", "| `made_up_sum` |"],
                        "docs/file-format.md": ["| `/series/contacts/made_up` |",
                                                "| `/series/made_up_sum`, ",
                                                "| `/results/made_up_sum`, "]}.items():
        for text in texts:
            assert text in (copy / file).read_text(), (file, text)
    # The page of a report lists what it finds in the file.
    run(program, "report", "made_up.h5", "-o", "report.html", "--force", cwd=folder)
    page = (folder / "report.html").read_text()
    assert '"made_up"' in page and '"made_up_sum"' in page
    print("a number that was added to one list is everywhere")


if __name__ == "__main__":
    main()
