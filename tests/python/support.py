"""Scenes that the tests of the Python package share."""

import copy

GAS = {
    "title": "Cooling needles",
    "needles": {"count": 200, "box": 6.0, "seed": 3},
    "collisions": {"epsilon": 0.8, "tc_relative": 1e-3},
    "until": {"collisions_per_needle": 20},
}
ELASTIC = {"needles": {"count": 200, "box": 6.0}}


def gas(**sections):
    """GAS with keys replaced: gas(needles={"count": 3}, output={...})."""
    scene = copy.deepcopy(GAS)
    for section, keys in sections.items():
        scene[section] = {**scene.get(section, {}), **keys}
    return scene
