"""What the scripts that measure share: rounds of repetitions that are kept and continued, figures
with their ranges, compact results and small pictures.

Everything that a script measures is kept in the folder of the build (study/), where no version is
tracked. Tables, pictures and compact results are made from it.
"""

import json
import math
import os
import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

BENCH = Path(__file__).resolve().parent
ROOT = BENCH.parent
UNKNOWN = "unknown"
# What a commit may change without another program being measured.
NOT_CODE = [":(top,exclude)bench/results", ":(top,exclude)docs", ":(top,exclude,glob)**/*.md"]


class OutOfTime(Exception):
    """The time budget is used up."""


class Budget:
    """The time in which a script may measure. What runs at its end is stopped."""

    def __init__(self):
        self.end = math.inf

    def begin(self, seconds):
        self.end = time.monotonic() + seconds

    def left(self):
        """Seconds, as timeouts of processes take them."""
        return None if self.end == math.inf else max(0.0, self.end - time.monotonic())

    def allows(self, seconds):
        return time.monotonic() + seconds <= self.end


budget = Budget()


def output_of(command):
    try:
        return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True,
                              timeout=budget.left()).stdout
    except subprocess.TimeoutExpired:
        raise OutOfTime from None


def built(build, target):
    """The executable of a target; ends the script, saying how to build it, if it is not there."""
    program = Path(build) / target
    if not program.exists():
        name = "needlework_program" if target == "needlework" else target
        sys.exit(f"{program}: not built yet: cmake --preset release -D NEEDLEWORK_BENCH=ON && "
                 f"cmake --build {build} --target {name}")
    return str(program)


def commit():
    """The last commit that changed code, and whether files differ from it; "unknown" where the
    sources are not a git checkout."""
    git, code = ["git", "-C", str(ROOT)], ["--", ".", *NOT_CODE]
    try:
        top = subprocess.run([*git, "rev-parse", "--show-toplevel"], capture_output=True, text=True)
    except OSError:  # no git
        return UNKNOWN
    if top.returncode or Path(top.stdout.strip()).resolve() != ROOT:
        return UNKNOWN
    last = output_of([*git, "log", "-1", "--abbrev=12", "--format=%h", *code]).strip()
    changed = output_of([*git, "status", "--porcelain", "--untracked-files=no", *code])
    return last + (" with changes" if changed.strip() else "")


def about(build):
    """What is measured: commit, processor, compiler, flags."""
    of_program = json.loads(output_of([built(build, "needlework"), "bench", "smoke", "--repetitions",
                                       "1", "--min-time", "0", "--json"]))
    keys = ("machine", "cores", "compiler", "flags", "version")
    return {"commit": commit(), **{key: of_program[key] for key in keys}}


def cores():
    return len(os.sched_getaffinity(0))


def processor(cpuinfo="/proc/cpuinfo"):
    """What this machine says of its first core: name, family, model and clock. Names of virtual
    machines stand for many processors, which family and model tell apart; the clock is the present
    one where it changes. Empty if nothing is said."""
    try:
        text = Path(cpuinfo).read_text().split("\n\n")[0]
    except OSError:
        return ""
    said = dict(re.findall(r"^([^\t:]+?)\s*: (.*)$", text, re.M))
    if "model name" not in said:
        return ""
    words = [said["model name"]]
    words += [f"{key} {said[key]}" for key in ("cpu family", "model") if key in said]
    if "cpu MHz" in said:
        words.append(f"{float(said['cpu MHz']) / 1000:.2f} GHz")
    return ", ".join(words)


def machine_name(build):
    version = output_of([str(build / "needlework"), "--version"])
    widest = re.search(r"^ISA +(.*)$", version, re.M)[1].split()[-1]
    processor = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), re.M)
    name = processor[1].lower() if processor else "machine"
    name = re.sub(r"\((r|tm)\)|\b(processor|cpu)\b|@.*", " ", name)
    return re.sub(r"[^a-z0-9]+", "-", name).strip("-") + f"-{widest}"


class Store:
    """Results of one commit and one build, a file for each part, in the folder of the build."""

    def __init__(self, build, about, quick=False):
        self.folder = build / ("study-quick" if quick else "study")
        self.about = about
        self.quick = quick

    def load(self, part):
        """What is there of a part; none if it was measured of another commit or build."""
        file = self.folder / f"{part}.json"
        if not file.exists():
            return None
        content = json.loads(file.read_text())
        if any(content.get(key) != value for key, value in self.about.items()):
            return None
        return content

    def save(self, part, content):
        self.folder.mkdir(parents=True, exist_ok=True)
        content = {**self.about, "processor": processor(),
                   "date": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), **content}
        fresh = self.folder / f"{part}.new"
        fresh.write_text(json.dumps(content) + "\n")
        fresh.replace(self.folder / f"{part}.json")

    def rounds(self, part):
        content = self.load(part)
        return content["rounds"] if content else 0

    def seconds(self, part):
        """How long the last round of a part took; 0 before the first one."""
        content = self.load(part)
        return content.get("seconds", 0) if content else 0

    def begun(self, part):
        """The cases of a round that was not completed."""
        content = self.load(f"{part}-begun")
        return content["cases"] if content else []

    def keep_begun(self, part, cases):
        self.save(f"{part}-begun", {"cases": cases})

    def add_round(self, part, command, cases, seconds=0):
        """Adds one repetition of all cases: lists are continued, other values replaced."""
        content = self.load(part) or {"rounds": 0, "cases": []}
        old = {case["name"]: case for case in content["cases"]}
        if content["rounds"] and old.keys() != {case["name"] for case in cases}:
            raise ValueError(f"{part}: expected the cases of the rounds before")
        merged = []
        for case in cases:
            before = old.get(case["name"], {})
            if before.get("warm_up_hash") != case.get("warm_up_hash") and before:
                raise ValueError(f"{case['name']}: the trajectory is not that of the rounds before")
            merged.append({key: before.get(key, []) + value if isinstance(value, list) else value
                           for key, value in case.items()})
        self.save(part, {"command": command, "rounds": content["rounds"] + 1, "seconds": seconds,
                         "cases": merged})
        (self.folder / f"{part}-begun.json").unlink(missing_ok=True)

    def place(self, machine, complete):
        """Where tables go: to bench/results/MACHINE when all is of one commit, else to a folder
        that is not tracked."""
        of_commit = "changes" not in self.about["commit"] and self.about["commit"] != UNKNOWN
        tracked = complete and not self.quick and of_commit
        out = BENCH / "results" / machine if tracked else self.folder / "results"
        out.mkdir(parents=True, exist_ok=True)
        return out


def measure_rounds(store, parts, budget_s):
    """Measures the rounds that are missing: the first of all parts, the second of all, and so on,
    until the budget is used: no round begins that would take longer, as the one before did, and one
    that does nevertheless is stopped. `parts` is {name: (rounds, function that returns the command
    and the cases)}. Returns the names of those that are not complete."""
    budget.begin(budget_s)
    try:
        for number in range(max(rounds for rounds, _ in parts.values())):
            for part, (rounds, measure) in parts.items():
                if store.rounds(part) > number or number >= rounds:
                    continue
                if not budget.allows(store.seconds(part)):
                    continue
                start = time.monotonic()
                command, cases = measure()
                seconds = time.monotonic() - start
                store.add_round(part, command, cases, seconds)
                print(f"{part}: round {number + 1} of {rounds}, {seconds:.0f} s", flush=True)
    except OutOfTime:
        print("the time budget is used up")
    finally:
        budget.begin(math.inf)
    return [part for part, (rounds, _) in parts.items() if store.rounds(part) < rounds]


def report_missing(store, missing, place, tracked=False):
    """Says what is left to do, where the tables are, and why not in bench/results if they should be."""
    if missing:
        print(f"not complete at {store.about['commit']}: {', '.join(missing)}; the same command "
              "continues")
    elif not tracked:
        pass
    elif not store.quick and "changes" in store.about["commit"]:
        print("not put into bench/results: the working tree differs from the commit")
    elif not store.quick and store.about["commit"] == UNKNOWN:
        print("not put into bench/results: these sources are not a git checkout")
    print(f"tables and pictures: {place}")


def kept_of(store, names):
    """What has been measured, by part; ends the script if nothing has."""
    contents = {name: store.load(name) for name in names}
    contents = {name: content for name, content in contents.items() if content}
    if not contents:
        sys.exit(f"{store.folder}: no round is complete yet at {store.about['commit']}; the same "
                 "command continues")
    return contents


def write_compact(file, about, cases, time_key):
    """One line for each case: its times, by repetition, and what `needlework bench` needs."""
    lines = [f" {json.dumps(key)}: {json.dumps(value)}," for key, value in about.items()]
    rows = []
    for case in cases:
        row = {key: case[key] for key in ("name", "baseline") if key in case}
        row[time_key] = [float(f"{value:.5g}") for value in case[time_key]]
        rows.append("  " + json.dumps(row))
    file.write_text("{\n" + "\n".join(lines) + '\n "cases": [\n' + ",\n".join(rows) + "\n ]\n}\n")


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def number(x):
    """Three digits."""
    if x == 0 or not math.isfinite(x):
        return "-"
    x = float(f"{x:.2e}")
    digits = max(0, 2 - math.floor(math.log10(abs(x))))
    return f"{x:.{digits}f}"


def spread(values):
    """The median, and the range if there are several values."""
    middle = number(statistics.median(values))
    if len(values) == 1:
        return middle
    return f"{middle} ({number(min(values))}–{number(max(values))})"


def quotients(values, others):
    """By repetition."""
    return [a / b for a, b in zip(values, others, strict=True)]


def origin(content):
    """Where the figures of a part are from."""
    rounds = content["rounds"]
    figures = (f"median (range) of {rounds} interleaved repetitions" if rounds > 1 else
               "one repetition")
    return (f"`{content['command']}`, {figures}; commit {content['commit']}, "
            f"{content['date'][:10]}; {content.get('processor') or content['machine']}, "
            f"{content['cores']} cores; "
            f"{content['compiler']}, {content['flags']}.")


def pyplot():
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "needlework", "svg.fonttype": "none",
                                "font.size": 10, "axes.spines.top": False,
                                "axes.spines.right": False, "legend.frameon": False})
    import matplotlib.pyplot
    return matplotlib.pyplot


def bars(axes, x, values, **style):
    """A line through medians, with a bar over the range of each."""
    middles = [statistics.median(v) for v in values]
    below = [m - min(v) for m, v in zip(middles, values)]
    above = [max(v) - m for m, v in zip(middles, values)]
    axes.errorbar(x, middles, yerr=[below, above], capsize=2, markersize=4, **style)
    return middles


def save_picture(figure, file):
    """An SVG of text and rounded numbers, without what only tools read."""
    for axes in figure.axes:
        axes.minorticks_off()
    figure.tight_layout()
    figure.savefig(file, metadata={"Date": None})
    text = re.sub(r"<!DOCTYPE.*?>|<!--.*?-->|<metadata>.*?</metadata>", "", file.read_text(),
                  flags=re.S)
    text = re.sub(r"-?\d+\.\d{2,}", lambda found: f"{float(found[0]):.1f}".removesuffix(".0"), text)
    text = text.replace("'DejaVu Sans', ", "").replace("'Bitstream Vera Sans', ", "")
    text = re.sub(r"font: (\d+)px [^;\"]*", r"font: \1px sans-serif", text)
    text = " ".join(text.split())
    file.write_text(re.sub(r" (?=<(g|svg|/svg|text)\b)", "\n", text) + "\n")


def add_options(parser):
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--time-budget", type=float, default=math.inf, metavar="MINUTES",
                        help="measure no longer than this; the same command continues later")
    parser.add_argument("--quick", action="store_true",
                        help="short runs, to try the script; results stay in the build folder")


def add_machine(parser):
    parser.add_argument("--machine", help="name of the folder in bench/results")


def store_of(arguments):
    return Store(arguments.build, about(arguments.build), arguments.quick)


def run(main):
    """Runs a script to its end, or to the error that it stops with."""
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; the same command continues")
    except (subprocess.CalledProcessError, ValueError, OSError) as error:
        sys.exit(str(error))
