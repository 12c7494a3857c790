"""Scenes as the TOML text that the library reads, so that its messages name keys and values."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any, Union

import numpy as np

from .errors import InputError

SceneLike = Union[Mapping[str, Any], str, "os.PathLike[str]"]

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def scene_text(scene: SceneLike) -> tuple[str | None, str, bool]:
    """Text of the scene, the name that messages give it, and whether its lines mean something.

    The text is None for a path, which the library reads itself.
    """
    if isinstance(scene, Mapping):
        return toml_text(scene), "scene", False
    if isinstance(scene, os.PathLike):
        return None, os.fsdecode(scene), True
    if isinstance(scene, str):
        is_text = "\n" in scene or ("=" in scene and not scene.endswith(".toml"))
        if not is_text:
            return None, scene, True
        _require_utf8("text", scene)
        return scene, "scene", True
    raise InputError(f"scene = {scene!r}: expected a dictionary of sections, TOML text or a path")


def toml_text(scene: Mapping[str, Any]) -> str:
    """A dictionary of sections as TOML. Keys whose value is None are left out."""
    top, sections = [], []
    for name, content in scene.items():
        if content is None:
            continue
        if isinstance(content, Mapping):
            sections += [f"[{_key(name)}]", *_lines(name, content)]
        elif _is_list_of_tables(content):
            for entry in content:
                sections += [f"[[{_key(name)}]]", *_lines(name, entry)]
        else:
            top.append(f"{_key(name)} = {_value(name, content)}")
    return "\n".join([*top, *sections, ""])


def _lines(section: str, content: Mapping[str, Any]) -> list[str]:
    return [f"{_key(name)} = {_value(f'{section}.{name}', value)}"
            for name, value in content.items() if value is not None]


def _is_list_of_tables(content: Any) -> bool:
    return (isinstance(content, (list, tuple)) and len(content) > 0
            and all(isinstance(entry, Mapping) for entry in content))


def _key(name: Any) -> str:
    if not isinstance(name, str):
        raise InputError(f"scene: key {name!r}: expected a string")
    return name if _BARE_KEY.fullmatch(name) else _string("key", name)


def _string(place: str, text: str) -> str:
    _require_utf8(place, text)
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda c: f"\\u{ord(c[0]):04x}", escaped) + '"'


def _require_utf8(place: str, text: str) -> None:
    try:
        text.encode()
    except UnicodeEncodeError:  # such as a name of a file, as os.fsdecode() has it
        raise InputError(f"scene: {place} = {text!r}: expected text that UTF-8 can hold, as scenes "
                         "are in UTF-8") from None


def _value(place: str, value: Any) -> str:
    if isinstance(value, np.longdouble):
        value = float(value)  # of which item() gives a longdouble again
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    # Of classes that are made from these the value counts, not their own repr.
    if isinstance(value, int):
        return int.__repr__(value)
    if isinstance(value, float):
        return float.__repr__(value)  # nan and inf read the same in TOML
    if isinstance(value, (str, os.PathLike)):
        return _string(place, os.fsdecode(value))
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(place, entry) for entry in value) + "]"
    if isinstance(value, Mapping):
        inside = ", ".join(f"{_key(name)} = {_value(f'{place}.{name}', entry)}"
                           for name, entry in value.items() if entry is not None)
        return "{" + inside + "}"
    raise InputError(f"scene: {place} = {value!r}: expected a number, a string, true or false, "
                     "or a list or dictionary of these")
