"""The scenes in which Needlework is compared with its peers."""

import math
from dataclasses import dataclass

import versus

# Restitution of the inelastic scenes: DynamO has no contact time, and lower values let needles
# collapse before the scenes end.
INELASTIC = 0.98
FALLING = {"falling": (10000, 24.0, 10)}  # as dilute, between walls and under gravity
SPHERES = {  # bodies, packing fraction, collisions per body
    "spheres-0.1": (10000, 0.1, 40),
    "spheres-0.3": (10000, 0.3, 40),
    "spheres-0.49": (10000, 0.49, 40),
    "spheres-falling": (10000, 0.1, 40),
}
SETTLED = 20.0  # collisions per body before a gas that is not in equilibrium as it is drawn
BARRIER = 2.0  # m g H / T of the falling ones


@dataclass(frozen=True)
class Scene:
    """A gas, and for how long it is measured."""

    text: str  # of its scene file
    count: int
    collisions: float  # per body
    settled: float  # collisions per body before the state from which all engines start
    spheres: bool
    falling: bool


def _falling(edge):
    return (f"forces.gravity = [0, 0, {-BARRIER / edge!r}]\n"
            "walls = [{ axis = 'z', side = 'both' }]\n")


def all_scenes():
    """By name."""
    scenes = {}
    for name, (count, box, collisions) in {**versus.SCENES, **FALLING}.items():
        falling = name in FALLING
        if name not in ("dilute", "dense", *FALLING):
            continue
        for suffix, epsilon in (("", 1.0), ("-inelastic", INELASTIC)):
            if falling and epsilon != 1:
                continue
            text = (f"needles = {{ count = {count}, box = {box!r} }}\n"
                    f"collisions.epsilon = {epsilon!r}\n" + (_falling(box) if falling else ""))
            scenes[name + suffix] = Scene(text, count, collisions, SETTLED if falling else 0.0,
                                          False, falling)
    for name, (count, packing, collisions) in SPHERES.items():
        edge = math.cbrt(count * math.pi / 6 / packing)
        falling = name.endswith("falling")
        text = (f"needles.box = {edge!r}\ncollisions.epsilon = 1.0\n"
                + (_falling(edge) if falling else "")
                + f"[[species]]\nname = 'sphere'\ncount = {count}\nlength = 0\ndiameter = 1\n")
        scenes[name] = Scene(text, count, collisions, SETTLED, True, falling)
    return scenes
