"""Rows that describe collisions and other events, as the library writes them."""

import numpy as np

STATE_AFTER = np.dtype([("position", "f8", 3), ("velocity", "f8", 3), ("orientation", "f8", 3),
                        ("angular_velocity", "f8", 3)], align=True)
"""Type of the state of a needle just after a collision."""

_RECORDED = [
    ("time", "f8"),
    ("epoch", "i8"),
    ("offset", "f8"),
    ("pair", "u4", 2),
    ("arms", "f8", 2),
    ("normal_velocity", "f8"),
    ("impulse", "f8", 3),
    ("shift", "i4", 3),
    ("tc", "?"),
]
_KIND = [("kind", "u1")]
_MORE = [("sin_angle", "f8"), ("energy_change", "f8")]
_REPORTED = [*_RECORDED, *_MORE]
_HAPPENED = [*_RECORDED, *_KIND, *_MORE]  # kind where _REPORTED has padding

RECORDED_COLLISION = np.dtype(_RECORDED)
"""Type of a collision in a file: the fields of COLLISION up to tc."""

RECORDED_HAPPENING = np.dtype([*_RECORDED, *_KIND])
"""Type of an event in a file whose scene has others than collisions of two needles."""

COLLISION = np.dtype(_REPORTED, align=True)
"""Type of a collision of the needles ``pair`` (ids, the lower one first).

time             since the start of the run [time]; exactly epoch * epoch_length + offset
arms             places of the contact along both directors, from -L/2 to L/2 [L]
normal_velocity  before the collision, of the first needle relative to the second [L / time]
impulse          on the first needle [m L / time]
shift            boxes added to the recorded centre of the second needle
tc               whether the t_c rule made the collision elastic
sin_angle        sine of the angle between the needles
energy_change    of the total energy, 0 for an elastic collision [energy]
"""

COLLISION_WITH_STATES = np.dtype([*_REPORTED, ("after", STATE_AFTER, 2)], align=True)
"""The same with the states of both needles after the collision, such as
``rows["after"]["velocity"]`` of shape [E, 2, 3]."""

HAPPENING = np.dtype(_HAPPENED, align=True)
"""Type of a collision, or of an event of one needle: the fields of COLLISION and

kind             KINDS says which: 0 a collision, 1 a hit on a wall, 4 velocities of a thermostat

Of an event of one needle, ``pair`` is its id and the index of the wall or 0; ``arms`` are that of
the tip and 0; ``normal_velocity`` is that of the tip relative to the surface, along the normal
into the gas; ``shift`` is 0.
"""

HAPPENING_WITH_STATES = np.dtype([*_HAPPENED, ("after", STATE_AFTER, 2)], align=True)
"""The same with the states after the event; the second of an event of one needle is 0."""

KINDS = {0: "pair", 1: "wall", 2: "contact entered", 3: "contact ended", 4: "thermostat",
         255: "other"}
"""What the kinds of events are."""
