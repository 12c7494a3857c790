"""Simulates gases of hard needles: infinitely thin rods that fly, spin and collide.

    import needlework

    sim = needlework.Simulation({"needles": {"count": 1000, "box": 10},
                                 "collisions": {"epsilon": 0.9, "tc_relative": 1e-3}})
    sim.run(energy_ratio=0.1)
    print(sim.time, sim.totals.t_tr, sim.totals.t_rot)

Simulation runs a gas, predict() finds first contacts of pairs, theory has rates and cooling curves,
read() opens files of runs, and plot draws them. docs/python.md is the guide.
"""

from . import plot, theory
from ._core import version as __version__
from .collisions import (COLLISION, COLLISION_WITH_STATES, HAPPENING, HAPPENING_WITH_STATES,
                         KINDS)
from .contacts import FirstContacts, predict
from .data import Data
from .errors import Error, InputError, InvalidStateError, IoError
from .frames import Frame, Frames
from .gsd_file import GsdFrame, from_gsd, to_gsd
from .order import NematicOrder, nematic_order
from .reading import Events, Recording, Series, VelocitiesSet, read
from .sweeps import SweepSummary
from .simulation import (Counters, EnergyBudget, GrowthTotals, PressureTensor, SceneWarning, Simulation, SlidingContacts,
                         SpeciesTotals, Totals, WallTotals)
from .state import Bodies, State
from .values import Table, Values

__all__ = ["Bodies", "COLLISION", "COLLISION_WITH_STATES", "Counters", "Data", "EnergyBudget", "Error",
           "Events", "FirstContacts", "Frame", "Frames", "GsdFrame", "HAPPENING", "HAPPENING_WITH_STATES", "InputError",
           "InvalidStateError", "IoError", "KINDS", "NematicOrder", "Recording", "SceneWarning", "Series",
           "PressureTensor", "Simulation", "SlidingContacts", "SpeciesTotals", "State", "SweepSummary", "Table", "Totals", "Values", "VelocitiesSet",
           "WallTotals", "from_gsd", "nematic_order", "plot", "predict", "read", "theory", "to_gsd", "__version__"]
