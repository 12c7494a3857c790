"""Rows that describe collisions, as the library writes them."""

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
_REPORTED = [*_RECORDED, ("sin_angle", "f8"), ("energy_change", "f8")]

RECORDED_COLLISION = np.dtype(_RECORDED)
"""Type of a collision in a file: the fields of COLLISION up to tc."""

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
