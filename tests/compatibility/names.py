#!/usr/bin/python3
"""The names that other programs use are those of names.txt.

    names.py DESCRIBE            exit code 1, and the names that have come or gone, if they are others
    names.py DESCRIBE --write    adds those that have come; none may have gone
    names.py DESCRIBE --write --gone    the list is what there is now

DESCRIBE is build/release/describe_results. Keys of scenes and of results come from the program, other
names, with types and defaults, from the documents, declarations of C and C++ from the public headers as
Universal Ctags reads them, those of Python from the package, which PYTHONPATH names. Exit code 77: one of
the last two is not there, and its names were not compared.
"""

import dataclasses
import functools
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


def without_links(text):
    return re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text).strip()


def of_scenes(lists):
    for key, expected in lists["scene_keys"].items():
        yield key
        yield f"{key} takes {expected}"
    for heading, names, cells in rows("scenes.md"):
        section = re.match(r"\[+(\w+)\]", heading)
        value = without_links(cells[3])
        default = re.search(r"\(([^()]*)\)$", value)
        for name in names:
            key = f"{section[1]}.{name}" if section else name
            if default and "*" not in name:
                yield f"{key} without a value: {default[1]}"
            if "required" in value:
                yield f"{key} is required"
    for heading, names, cells in rows("sweeps.md"):
        if heading == "Grid files":
            yield f"grid of a sweep: {names[0]} without a value: {cells[4].strip()}"


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
    for heading, names, cells in rows("json.md"):
        yield from (f"{heading}: {name}" for name in names)
        if names == ["stop"]:
            yield from (f"stop = {word}" for word in re.findall(r"`(\w+)`", without_links(cells[2])))


def of_pipe(_lists):
    page = (ROOT / "docs/serve.md").read_text()
    lines = [json.loads(line.replace(", ...", "").replace("…", "0"))
             for line in re.findall(r"^    (\{.*\})$", page, re.M)]
    yield from (f"a line has {name}" for line in lines for name in line)
    requests = [row for row in rows("serve.md") if row[0] == "Requests"]
    others = {names[0] for _, names, _ in requests}
    for _, names, cells in requests:
        for part, cell in zip(("takes", "answers"), cells[2:4]):
            for name in re.findall(r"`(\w+)`", re.sub(r"\([^()]*\)", "", cell)):
                if name not in others:
                    yield f"{names[0]} {part} {name}"
    fields = re.search(r"`fields` chooses some of (.*?) \[collisions in Python\]", page, re.S)[1]
    yield from (f"collisions: {name}" for name in re.findall(r"`(\w+)`", fields))


def of_files(lists):
    yield from (f"/series/{name}: {field['type']}{', ' if field['unit'] else ''}{field['unit']}"
                for name, field in lists["series"].items())
    for page in ("file-format.md", "observables.md", "sweeps.md"):
        for heading, names, cells in rows(page):
            kind = without_links(cells[3]).replace("`", "") if len(cells) == 5 else ""
            yield from (f"{'' if name.startswith('/') else f'{heading}: '}{name}{': ' if kind else ''}{kind}"
                        for name in names if "/" in name)


def types_of(signature):
    """Of parameters, whose names may change, with what follows them."""
    def type_of(parameter):
        what, given, _ = parameter.partition("=")
        named = re.fullmatch(r"(.*[ &*>])\w+((?:\[.*)?)", what.strip())
        return f"{(named[1].strip() + named[2]) if named else what.strip()}{' = ...' if given else ''}"
    whole = re.fullmatch(r"\((.*)\)([^)]*)", signature)
    parts, depth = [""], 0
    for letter in whole[1]:
        depth += (letter in "<({[") - (letter in ">)}]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return f"({', '.join(map(type_of, parts))}){whole[2]}"


def declarations(language, kinds, headers):
    """What is not private, with types."""
    ctags = shutil.which("ctags-universal")
    if not ctags:
        raise ImportError("Universal Ctags are not installed")
    tags = subprocess.run([ctags, "--output-format=json", f"--languages={language}",
                           f"--langmap={language}:.h", f"--kinds-{language}={kinds}", "--fields=+aiStsZ",
                           "-f", "-", *headers], stdout=subprocess.PIPE, check=True)
    for tag in map(json.loads, tags.stdout.splitlines()):
        scope, name = tag.get("scope", ""), tag["name"]
        if tag.get("access") in ("private", "protected") or "__anon" in name:
            continue
        # ctags makes names of what has none from the path of the header.
        scope = re.sub(r"__anon\w+", "...", re.sub(r"^__anon\w+$", "", scope))
        kind = re.sub(r"__anon\w+", "...", tag.get("typeref", "").removeprefix("typename:"))
        bases = f" of {tag['inherits']}" if tag.get("inherits") else ""
        what = f"{tag['kind']} " if tag["kind"] in ("class", "struct", "enum", "union") else ""
        signature = types_of(tag["signature"]) if "signature" in tag else ""
        yield (f"{what}{scope}{'::' if scope else ''}{name}{signature}{bases}{': ' if kind else ''}{kind}")


def of_c(_lists):
    header = ROOT / "include/needlework.h"
    code = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.S)
    yield from (f"{name} = {value}" for name, value in
                re.findall(r"\b(NEEDLEWORK_[A-Z_]+) = (\d+)", code))
    yield from (f"{name} {value}".strip() for name, value in
                re.findall(r"^#define (NEEDLEWORK_[A-Z_]+)[ \t]+(.+)$", code, re.M) if name != "NEEDLEWORK_API")
    yield from declarations("C", "+p-deh", [header])


def of_cxx(_lists):
    headers = sorted((ROOT / "include/needlework").glob("*.h"))
    yield from declarations("C++", "+p-dhn", headers)


def parameters(function):
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # of a compiled function
        return "(...)"
    return str(signature.replace(return_annotation=inspect.Signature.empty, parameters=[
        parameter.replace(annotation=inspect.Parameter.empty)
        for parameter in signature.parameters.values()]))


def members(name, kind):
    if issubclass(kind, Exception):
        yield f"{name} of {', '.join(base.__name__ for base in kind.__bases__)}"
    else:
        yield f"{name}{parameters(kind) if '__init__' in vars(kind) else ''}"
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
        is_method = inspect.isroutine(value) and not isinstance(value, functools.cached_property)
        yield f"{name}.{each}{parameters(value) if is_method else ''}"


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
    left_out = False
    for section, names_of in SECTIONS.items():
        try:
            now[section] = sorted(set(names_of(lists)))
        except ImportError as error:
            print(f"{section}: not compared: {error}")
            left_out = True
            now[section] = before.get(section, [])
            continue
        assert len(now[section]) > 15, (section, now[section])
    gone, come = differences(before, now), differences(now, before)
    for what, names in (("gone", gone), ("new", come)):
        for name in names:
            print(f"{what}: {name}")
    if "--write" in options and ("--gone" in options or not gone):
        text = "# Names that other programs use, written by tests/compatibility/write.sh: COMPATIBILITY.md.\n"
        LIST.write_text(text + "".join(
            f"\n[{section}]\n" + "".join(f"{name}\n" for name in names) for section, names in now.items()))
        return 0
    if gone or come:
        print("""New names are to stay: list them by tests/compatibility/write.sh. A name goes only with a new major
version, after a warning in a minor one (COMPATIBILITY.md); then, and where only the words of a document
changed, or more is allowed than before: names.py with --write --gone.""")
        return 1
    return 77 if left_out else 0


def differences(one, other):
    """What only one has."""
    return [f"{section}: {name}" for section, names in one.items()
            for name in sorted(set(names) - set(other.get(section, ())))]


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
