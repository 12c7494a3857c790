#!/usr/bin/python3
"""The names that other programs use are those of names.txt.

    names.py DESCRIBE            exit code 1, and the names that have come or gone, if they are others
    names.py DESCRIBE --write    writes the list

DESCRIBE is build/release/describe_results. Keys of scenes and of results come from the program, other
names and defaults of keys from the pages that tests compare with it, declarations of C++ from the public
headers as Universal Ctags reads them, those of Python from the package, which PYTHONPATH names. Without
one of the last two, its names are left as they are.
"""

import dataclasses
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIST = Path(__file__).with_name("names.txt")


def rows(page):
    """The names in backticks of the first cell of each row, with the heading above and the row."""
    heading = ""
    for line in (ROOT / "docs" / page).read_text().splitlines():
        if line.startswith("#"):
            heading = line.lstrip("#").strip()
        elif line.startswith("| `"):
            cells = re.split(r"(?<!\\)\|", line)
            yield heading, re.findall(r"`([^`]+)`", cells[1]), cells


def of_scenes(lists):
    for key, expected in lists["scene_keys"].items():
        yield key
        yield from (f"{key} = \"{choice}\"" for choice in re.findall(r'"([a-z][\w-]*)"', expected))
    for heading, names, cells in rows("scenes.md"):
        section = re.match(r"\[+(\w+)\]", heading)
        default = re.search(r"\((.*)\) *$", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", cells[3]))
        if default:
            yield f"{section[1] + '.' if section else ''}{names[0]} without a value: {default[1]}"


def of_commands(_lists):
    page = (ROOT / "docs/commands.md").read_text()
    codes = re.search(r"^Exit codes:\n\n((?:    .*\n)+)", page, re.M)[1]
    yield from (f"exit code {code}" for code in re.findall(r"^    (\d+) ", codes, re.M))
    variables = re.search(r"^Environment:\n\n((?:    .*\n)+)", page, re.M)[1]
    yield from (f"environment {name}" for name in re.findall(r"^    ([A-Z]\w+)", variables, re.M))
    command = "needlework"
    for line in page.splitlines():
        if line.startswith("## "):
            command = line[3:]
            if command.startswith("needlework "):
                yield command
        option = re.match(r"\| `(-[^`]*)`", line)
        for name in re.findall(r"(?:^|, ?)(--?[a-z][\w-]*)", option[1]) if option else ():
            if command != "Common arguments":
                yield f"{command} {name}"
        if line.startswith("[Common](#common-arguments): "):
            yield from (f"{command} {name}" for name in re.findall(r"`(--[\w-]+)", line))


def of_json(_lists):
    for heading, names, _ in rows("json.md"):
        yield from (f"{heading}: {name}" for name in names)


def of_pipe(_lists):
    for heading, names, cells in rows("serve.md"):
        if heading != "Requests":
            continue
        for part, cell in zip(("takes", "answers"), cells[2:4]):
            for name in re.findall(r"`(\w+)`", re.sub(r"\([^()]*\)", "", cell)):
                yield f"{names[0]} {part} {name}"
    text = (ROOT / "docs/serve.md").read_text()
    fields = re.search(r"`fields` chooses some of (.*?) \[collisions in Python\]", text, re.S)[1]
    yield from (f"collisions: {name}" for name in re.findall(r"`(\w+)`", fields))


def of_files(lists):
    yield from (f"/series/{name}" for name in lists["series"])
    for page in ("file-format.md", "observables.md"):
        for heading, names, _ in rows(page):
            yield from (f"{heading}: {name}" if not name.startswith("/") else name
                        for name in names if "/" in name)


def of_c(_lists):
    code = re.sub(r"/\*.*?\*/", "", (ROOT / "include/needlework.h").read_text(), flags=re.S)
    yield from (f"{name} = {value}" for name, value in
                re.findall(r"\b(NEEDLEWORK_[A-Z_]+) = (\d+)", code))
    yield from (f"{name} {value}".strip() for name, value in
                re.findall(r"^#define (NEEDLEWORK_[A-Z_]+)[ \t]+(.+)$", code, re.M) if name != "NEEDLEWORK_API")


def of_cxx(_lists):
    """What is not private, with types and parameters."""
    ctags = shutil.which("ctags-universal")
    if not ctags:
        raise ImportError("Universal Ctags are not installed")
    headers = sorted((ROOT / "include/needlework").glob("*.h"))
    tags = subprocess.run([ctags, "--output-format=json", "--languages=C++", "--kinds-C++=+p-dhn",
                           "--fields=+aStsZ", "-f", "-", *headers], stdout=subprocess.PIPE, check=True)
    for tag in map(json.loads, tags.stdout.splitlines()):
        scope, name = tag.get("scope", ""), tag["name"]
        if tag.get("access") in ("private", "protected") or "__anon" in scope + name:
            continue
        kind = tag.get("typeref", "").removeprefix("typename:")
        yield f"{scope}::{name}{tag.get('signature', '')}{f': {kind}' if kind else ''}"


def parameters(function):
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # of a compiled function
        return "(...)"
    return str(signature.replace(return_annotation=inspect.Signature.empty, parameters=[
        parameter.replace(annotation=inspect.Parameter.empty)
        for parameter in signature.parameters.values()]))


def members(name, kind):
    yield f"{name}{parameters(kind) if '__init__' in vars(kind) and not issubclass(kind, Exception) else ''}"
    names = {each for base in kind.__mro__[:-1] if base.__module__.startswith("needlework")
             for each in (*vars(base), *getattr(base, "__annotations__", ()))}
    if dataclasses.is_dataclass(kind):
        names |= {field.name for field in dataclasses.fields(kind)}
    for each in sorted(names):
        if each.startswith("_"):
            continue
        value = inspect.getattr_static(kind, each, None)
        if isinstance(value, (staticmethod, classmethod)):
            value = value.__func__
        yield f"{name}.{each}{parameters(value) if inspect.isroutine(value) else ''}"


def of_python(_lists):
    if not os.environ.get("PYTHONPATH"):
        raise ImportError("PYTHONPATH names no build of the package")
    import needlework
    modules = {"needlework": needlework, "needlework.theory": needlework.theory,
               "needlework.plot": needlework.plot}
    for module_name, module in modules.items():
        names = getattr(module, "__all__", None) or [
            name for name, value in vars(module).items()
            if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__]
        for each in sorted(names):
            value, name = getattr(module, each), f"{module_name}.{each}"
            if inspect.isclass(value):
                yield from members(name, value)
            elif inspect.isroutine(value):
                yield f"{name}{parameters(value)}"
            elif inspect.ismodule(value):
                yield name
            elif hasattr(value, "fields"):  # a type of NumPy's
                yield from (f"{name}: {field}" for field in value.names)
            elif isinstance(value, dict):
                yield from (f"{name}: {key}" for key in map(str, value))
            else:
                yield name


SECTIONS = {"scenes": of_scenes, "commands": of_commands, "json": of_json, "pipe": of_pipe,
            "files": of_files, "c": of_c, "c++": of_cxx, "python": of_python}


def read():
    found, section = {}, None
    for line in LIST.read_text().splitlines() if LIST.exists() else ():
        if line.startswith("["):
            section = found.setdefault(line.strip("[]"), [])
        elif line and not line.startswith("#"):
            section.append(line)
    return found


def main(describe, *options):
    lists = json.loads(subprocess.run([describe], stdout=subprocess.PIPE, check=True).stdout)
    before, now = read(), {}
    for section, names_of in SECTIONS.items():
        try:
            now[section] = sorted(set(names_of(lists)))
        except ImportError as error:
            print(f"{section}: as before: {error}")
            now[section] = before.get(section, [])
            continue
        assert len(now[section]) > 15, (section, now[section])
    if "--write" in options:
        text = "# Names that other programs use, written by tests/compatibility/write.sh: COMPATIBILITY.md.\n"
        LIST.write_text(text + "".join(
            f"\n[{section}]\n" + "".join(f"{name}\n" for name in names) for section, names in now.items()))
        return 0
    failed = False
    for section, names in now.items():
        gone = sorted(set(before.get(section, ())) - set(names))
        come = sorted(set(names) - set(before.get(section, ())))
        for name in gone:
            print(f"{section}: gone: {name}")
        for name in come:
            print(f"{section}: new: {name}")
        failed = failed or bool(gone or come)
    if failed:
        print("New names are to stay: list them by tests/compatibility/write.sh. A name goes only with a "
              "new major version, after a warning in a minor one (COMPATIBILITY.md).")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
