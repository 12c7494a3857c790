"""Simulations of gases of hard needles."""

from __future__ import annotations

import operator
import os
import warnings
import weakref
from collections.abc import Callable, Mapping
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import column, rows_of_vectors, whole_numbers
from .collisions import (COLLISION, COLLISION_WITH_STATES, HAPPENING,
                         HAPPENING_WITH_STATES)
from .data import Data
from .errors import Error, InputError
from .progress import progress_line
from .reading import undisturbed_until
from .scene_text import SceneLike, scene_text
from .state import NUMBERS_OF_BODIES, OWN_NUMBERS, Bodies, State
from .values import NotPickled, Values, html_table

Callback = Callable[[np.ndarray], object]


class SceneWarning(UserWarning):
    """A setting of a scene that is allowed but probably not intended."""


class Totals(Values):
    """Sums over all needles at one instant."""

    # numbers of totals
    time: float
    """Time since the start of the run [time]."""
    t_tr: float
    """Translational temperature: two thirds of the mean energy of translation [energy]."""
    t_rot: float
    """Rotational temperature: the mean energy of rotation per two degrees of freedom
    [energy]."""
    energy: float
    """Kinetic energy per needle, and that in gravity between walls [energy]."""
    momentum: np.ndarray
    """Total momentum of all needles [mass times length per time], [3]."""
    collisions: int
    """Number of collisions since the start of the run."""
    tc_collisions: int
    """Number of collisions since the start of the run that the contact-time rule made
    elastic."""
    # end of numbers


class SpeciesTotals(Values):
    """Sums over the needles of one species at one instant."""

    # numbers of species
    count: int
    """Number of needles."""
    t_tr: float
    """Translational temperature, two thirds of the mean energy of translation [energy]."""
    t_rot: float
    """Rotational temperature, the mean energy of rotation per two degrees of freedom
    [energy]."""
    # end of numbers


class WallTotals(Values):
    """Hits on one wall since the start."""

    axis: str
    """"x", "y" or "z"."""
    side: str
    """"low" or "high"."""
    # numbers of walls
    hits: int
    """Number of hits, which are no collisions."""
    impulse: float
    """Sum of the magnitudes of their impulses [mass times length per time]."""
    normal_impulse: float
    """Sum of the components of these impulses along the normal into the gas, which thermal
    walls may draw negative [mass times length per time]."""
    area: float
    """Area of the face of the box at the wall [length squared]."""
    phase: float
    """Phase of the motion of the wall now, from 0 to 2 pi, so that its surface is off by
    amplitude times its sine; NaN at rest [radians]."""
    energy: float
    """Energy that hits have put into the gas, per needle; negative: taken out [energy]."""
    pressure: float
    """Mean over the run, impulse along the normal over area and time; NaN at its start [energy
    per volume]."""
    place: float
    """Place of its surface along its axis now [length]."""
    work: float
    """Of its energy, what its motion has done as work, per needle; the rest is heat, or what
    its restitution takes [energy]."""
    impulse_x: float
    """Sum of the impulses on the gas, along x [mass times length per time]."""
    impulse_y: float
    """The same along y [mass times length per time]."""
    impulse_z: float
    """The same along z [mass times length per time]."""
    # end of numbers


class RodTotals(Values):
    """Room and pressure of rods of finite width."""

    # numbers of rods
    packing_fraction: float
    """Share of the volume of the box that rods take up."""
    virial: float
    """Sum of r12 . dp over the collisions since the start of the run, r12 from the second
    centre to the first and dp the impulse on the first [mass times length squared per time]."""
    pressure: float
    """Mean over the run: N T_tr and a third of what the virial gains in a unit of time, over
    the volume of the box; where there are walls, what all of them feel, over their area; NaN at
    its start, and with gravity along an axis with walls [energy per volume]."""
    # end of numbers
    pressure_meaning: str
    """Which mean that is: by the virial, on the walls, or why there is none."""


class PressureTensor(Values):
    """Pressure tensor since the start, a mean over the run."""

    # numbers of pressure_tensor
    kinetic_xx: float
    """P_xx by flights: n <m c_x c_x> [energy per volume]."""
    kinetic_xy: float
    """P_xy by flights [energy per volume]."""
    kinetic_xz: float
    """P_xz by flights [energy per volume]."""
    kinetic_yx: float
    """P_yx by flights, momentum along x that goes along y [energy per volume]."""
    kinetic_yy: float
    """P_yy by flights [energy per volume]."""
    kinetic_yz: float
    """P_yz by flights [energy per volume]."""
    kinetic_zx: float
    """P_zx by flights [energy per volume]."""
    kinetic_zy: float
    """P_zy by flights [energy per volume]."""
    kinetic_zz: float
    """P_zz by flights [energy per volume]."""
    collisional_xx: float
    """P_xx by collisions: r12_x dp_x between centres [energy per volume]."""
    collisional_xy: float
    """P_xy by collisions [energy per volume]."""
    collisional_xz: float
    """P_xz by collisions [energy per volume]."""
    collisional_yx: float
    """P_yx by collisions, r12_y dp_x [energy per volume]."""
    collisional_yy: float
    """P_yy by collisions [energy per volume]."""
    collisional_yz: float
    """P_yz by collisions [energy per volume]."""
    collisional_zx: float
    """P_zx by collisions [energy per volume]."""
    collisional_zy: float
    """P_zy by collisions [energy per volume]."""
    collisional_zz: float
    """P_zz by collisions [energy per volume]."""
    shear_stress: float
    """-P_yx [energy per volume]."""
    shear_stress_error: float
    """Its standard error [energy per volume]."""
    viscosity: float
    """-P_yx over the rate; NaN without shear [energy times time per volume]."""
    viscosity_error: float
    """Its standard error [energy times time per volume]."""
    first_normal_difference: float
    """P_xx - P_yy [energy per volume]."""
    first_normal_difference_error: float
    """Its standard error [energy per volume]."""
    second_normal_difference: float
    """P_yy - P_zz [energy per volume]."""
    second_normal_difference_error: float
    """Its standard error [energy per volume]."""
    # end of numbers


class GrowthTotals(Values):
    """Sizes, packing and pressure of bodies that grow."""

    # numbers of growth
    scale: float
    """Present sizes of bodies in those of the start."""
    rate: float
    """What this scale gains in a unit of time [per time]."""
    packing_fraction: float
    """Share of the volume of the box that bodies take up now."""
    pressure: float
    """P V / (N T) by the virial, as it was last measured, over the collisions between two times
    at which velocities were scaled back; NaN before."""
    # end of numbers


class SlidingContacts(Values):
    """Contacts of needles that slide on each other, since the start."""

    # numbers of contacts
    entered: int
    """Number of contacts that have begun."""
    ended_by_force: int
    """Number of them that have ended where the force that holds the needles together would
    pull."""
    ended_by_tip: int
    """Number of them that have ended as a tip was reached; the needles pass each other."""
    ended_by_strike: int
    """Number of them that have ended as anything else changed the velocities of one of the
    needles."""
    crowded: int
    """Number of collisions whose epsilon was raised, as one of the needles had just touched
    another one or a wall."""
    time: float
    """Time that pairs have been in contact, of all together, without that of present steps
    [time]."""
    share: float
    """Share of its time that a needle has been in contact, the mean of all: 2 time / (N t); NaN
    at the start."""
    # end of numbers


class EnergyBudget(Values):
    """Energy per needle that each effect has put in since the start; negative: taken out. The sum
    is the change of Totals.energy, up to rounding. Effects that the scene has not are missing."""

    # numbers of energy_budget
    pairs: float
    """Energy by collisions of two needles [energy]."""
    walls: np.ndarray
    """Energy by hits on each wall [energy]."""
    thermostat: float
    """Energy by the thermostat [energy]."""
    kicks: float
    """Energy by kicks [energy]."""
    velocities_set: float
    """Energy by velocities that a caller has replaced [energy]."""
    gravity: float
    """Energy by gravity along periodic axes [energy]."""
    shear: float
    """Energy by uniform shear [energy]."""
    growth: float
    """Energy by growth, which pushes bodies apart [energy]."""
    cooling: float
    """Energy by velocities that are scaled back as bodies grow [energy]."""
    # end of numbers

    @property
    def total(self) -> float:
        """The sum."""
        return float(sum(np.sum(energy) for energy in self.values()))


class Counters(Values):
    """Counters of the work done, such as events, candidates and predicted. No trajectory depends
    on them."""


class Simulation(NotPickled):
    """A gas of hard needles, simulated collision by collision.

    Parameters
    ----------
    scene : dict, str or path
        A dictionary of the scene's sections, such as ``{"needles": {"count": 1000, "box": 10}}``,
        TOML text, or the path of a scene file. docs/scenes.md lists all keys. Without
        [until] and driving.growth in it, each call of run() needs limits.
    position, velocity, orientation, angular_velocity : arrays [N, 3], optional
        The state to start from: centres in the box or not [L], velocities [L / time], directors
        of any length but 0, which are made unit vectors, and angular velocities, whose part normal
        to the directors counts [1 / time]. Positions and directors need each other; velocities are
        0 if they are not given. The scene then needs no needles.count, and temperatures in it are
        an error.
    peculiar_velocity : array [N, 3], optional
        Velocities beside the flow of [shear], in place of velocity [L / time].
    species : array [N] of whole numbers, optional
        Which of the scene's species each needle is of, from 0 in their order. Counts of the
        scene, where given, must agree. If it is not given, ids go through the species in their
        order.
    bodies : mapping, optional
        What the species are made of: length, diameter, mass and k of each, and name; mass is
        infinite of fixed ones. It is taken where the scene is silent; what the scene says otherwise
        is an error.
    length, diameter, mass, inertia : arrays [N], optional
        Numbers of each needle, where those of a species differ [L, L, m, m L^2]: lengths of axes,
        diameters, masses, and moments of inertia about axes normal to the director. What is not
        given follows from the scene.
    flow : mapping, optional
        What a sheared state says of its box: slide, of the row of boxes above [L], and shear_rate
        [1 / time]. Velocities beside the flow are kept where the scene has another rate.
    box, low : arrays [3], optional
        Edges of the box, as walls with a velocity have moved them, and where the low ones are, 0 if
        not given [L]; the simulation moves those to 0. needles.box, where given, must agree.
    image : array [N, 3] of whole numbers, optional
        Boxes crossed by these needles before, from which their images go on; 0 if not given.
    id : array [N] of whole numbers, optional
        Distinct ids of these needles; 0 to N - 1 if not given. The needles are put in their order.
        ``Simulation(scene, **other.state)`` starts from the state of another simulation, and
        ``**needlework.read(path).frames[-1].state`` from that in a file.
    force : bool
        Whether output.file may replace an existing file. One that a program or another simulation
        is writing is not replaced: close() that simulation first.

    Units: the length and the mass of needles are 1 unless the scene says otherwise, temperatures
    are energies, and time is in L sqrt(m / T).

    A simulation whose scene names output.file writes it as the program does. close() completes
    the file, and so does the end of a ``with`` block.

    Only one thread at a time may use a simulation; the others, and callbacks, may only call
    interrupt(). Everything else raises Error while it runs. The interpreter is free for other
    threads meanwhile, also for simulations of their own.

    Raises InputError for a scene or a state that cannot be simulated, and IoError for files.
    """

    _on_collisions: Optional[Callback] = None
    _on_happenings: Optional[Callback] = None
    _instead = ("sim.save(path) for a file that initial.file of a scene can name, "
                "Simulation(scene, **sim.state) for another one, or sim.checkpoint() and "
                "Simulation.resume(path) for the same run in another process")

    def __init__(self, scene: SceneLike, *, position: ArrayLike | None = None,
                 velocity: ArrayLike | None = None, orientation: ArrayLike | None = None,
                 angular_velocity: ArrayLike | None = None, image: ArrayLike | None = None,
                 id: ArrayLike | None = None, species: ArrayLike | None = None,
                 bodies: Mapping[str, ArrayLike] | None = None, force: bool = False,
                 peculiar_velocity: ArrayLike | None = None,
                 flow: Mapping[str, float] | None = None, length: ArrayLike | None = None,
                 diameter: ArrayLike | None = None, mass: ArrayLike | None = None,
                 inertia: ArrayLike | None = None, box: ArrayLike | None = None,
                 low: ArrayLike | None = None) -> None:
        text, name, has_lines = scene_text(scene)
        if velocity is not None and peculiar_velocity is not None:
            raise InputError("velocity and peculiar_velocity: expected one of them")
        beside_flow = peculiar_velocity is not None
        state = _state({"position": position,
                        "velocity": peculiar_velocity if beside_flow else velocity,
                        "orientation": orientation, "angular_velocity": angular_velocity},
                       image, id, species, bodies, (length, diameter, mass, inertia))
        if state is not None:
            state = (*state, beside_flow, *_flow(flow or {}), _three("box", box), _three("low", low))
        self._run = _core.Run(text, os.fsencode(name), has_lines, state, bool(force))
        for message in self._run.warnings():
            warnings.warn(message, SceneWarning, stacklevel=2)
        self._facts = Values(self._run.facts())
        self._note_velocities_set()
        self._forget()

    @classmethod
    def resume(cls, path: str | os.PathLike[str]) -> Simulation:
        """Continues the run of an output file from its last checkpoint, which is beside it.

        The collisions are the same, to the last bit, as if the run had never ended, and the same
        file goes on. Time, counts and the limits of run() go on from the start of the run;
        on_collisions() has to be called again. A run that the program, C or a pipe began can be
        continued as well.

        If the newest checkpoint is damaged, the one before is used, with a RuntimeWarning. Raises
        InputError if there is no checkpoint, and IoError if the file is missing or is being
        written.
        """
        self = cls.__new__(cls)
        self._run = _core.Run.resume(os.fsencode(path))
        for message in self._run.warnings():
            warnings.warn(message, RuntimeWarning, stacklevel=2)
        self._facts = Values(self._run.facts())
        self._note_velocities_set()
        self._forget()
        return self

    # Running

    def run(self, time: float | None = None, collisions: int | None = None,
            collisions_per_needle: float | None = None, energy_ratio: float | None = None,
            wall_s: float | None = None, *, progress: bool | None = None) -> str:
        """Runs until the first of these limits is met. They count from the start of the run.

        Parameters
        ----------
        time : float
            Simulated time [time].
        collisions : int
            Number of collisions of all needles together.
        collisions_per_needle : float
            2 collisions / N, because a collision counts for both needles.
        energy_ratio : float
            Energy over that at the start.
        wall_s : float
            Wall-clock time of this call [s].
        progress : bool
            Whether to show a line with the progress; by default in notebooks only.

        Without limits, the ends of the scene hold: [until], and those of driving.growth.

        Returns
        -------
        str
            Why it stopped: "time", "collisions", "energy", "wall_time", "interrupted",
            "nothing_can_happen", "walls_meet", "jammed", "grown", "pressure" or "no_room".

        Raises
        ------
        InvalidStateError
            If the simulation cannot go on correctly. It stays as it was before that event.
        KeyboardInterrupt
            By Ctrl-C. The trajectory is not changed: the run may be continued by another call.
        """
        return self._drive(self._run.run, progress, collisions, time=time,
                           collisions_per_needle=collisions_per_needle,
                           energy_ratio=energy_ratio, wall_s=wall_s)

    def advance(self, time: float | None = None, collisions: int | None = None,
                collisions_per_needle: float | None = None, energy_ratio: float | None = None,
                wall_s: float | None = None, *, progress: bool | None = None) -> str:
        """Runs on until the first of these limits is met. They count from the present state.

        The limits, the return value and the errors are those of run(). At least one limit is
        required.
        """
        return self._drive(self._run.advance, progress, collisions, time=time,
                           collisions_per_needle=collisions_per_needle,
                           energy_ratio=energy_ratio, wall_s=wall_s)

    def interrupt(self) -> None:
        """Stops run() or advance() soon: the call in progress, or else the next one.

        It returns "interrupted". May be called by any thread and by callbacks.
        """
        self._run.interrupt()

    def on_collisions(self, callback: Callback | None, batch: int = 1024, *,
                      states: bool = False) -> None:
        """Calls ``callback(rows)`` for all collisions from now on, up to ``batch`` at once.

        Rows are a structured array of the type needlework.COLLISION, in order of time. The
        collisions that are left when run() or advance() stops are passed on before it returns, so
        that each collision is passed on exactly once. None ends it.

        With ``states``, each row has the states of both needles after the collision, as
        ``rows["after"]``; see needlework.COLLISION_WITH_STATES.

        An exception of the callback stops the advance, which raises it. Collisions that happened
        in between are passed on by the next advance.

        The callback must not use the simulation, which is ahead of the collisions passed on;
        only interrupt() may be called.
        """
        self._listen(self._run.on_collisions, "_on_collisions", callback, batch,
                     COLLISION_WITH_STATES if states else COLLISION)

    def on_happenings(self, callback: Callback | None, batch: int = 1024, *,
                      states: bool = False) -> None:
        """The same for all that happens: collisions of two needles, and events of one needle, such
        as hits on walls.

        Rows are of the type needlework.HAPPENING, whose field ``kind`` says what each is, or of
        needlework.HAPPENING_WITH_STATES. Both functions may be set.
        """
        self._listen(self._run.on_happenings, "_on_happenings", callback, batch,
                     HAPPENING_WITH_STATES if states else HAPPENING)

    def _listen(self, listen: Callable[..., None], name: str, callback: Callback | None,
                batch: int, rows: np.dtype) -> None:
        if callback is not None and not callable(callback):
            raise InputError(f"callback = {callback!r}: expected a function or None")
        size = _whole("batch", batch)
        if size is None or size < 1:
            raise InputError(f"batch = {batch!r}: expected a whole number, 1 or more")
        listen(None if callback is None else _callback_of(self, name), size, rows)
        setattr(self, name, callback)

    def set_velocities(self, velocity: ArrayLike,
                       angular_velocity: ArrayLike | None = None) -> None:
        """Replaces the velocities of all needles, as arrays [N, 3] in order of id.

        Without angular velocities these are set to 0, with a SceneWarning. The part of an angular
        velocity along the director is removed. Counts, the hash and the energy that energy_ratio
        refers to are kept. Costs about as much as a new simulation.

        The output file says when that was and by how much the energy changed
        (``Recording.velocities_set``), and kinetic theory is left out of it from then on. A sample
        or a frame that is due at this instant is taken when the run goes on, and holds the new
        velocities; call sample() before this for one with the old ones.
        """
        count = self._facts.count
        given = np.zeros((count, 3)) if angular_velocity is None else angular_velocity
        self._forget()
        self._run.set_velocities(rows_of_vectors("velocity", velocity, count),
                                 rows_of_vectors("angular_velocity", given, count))
        if angular_velocity is None and self._facts.turn:
            warnings.warn(_core.no_rotation_given, SceneWarning, stacklevel=2)
        self._note_velocities_set()

    def _note_velocities_set(self) -> None:
        time = self._run.velocities_set()
        self._undisturbed_until: float = np.inf if time is None else time

    def sample(self, frame: bool = False) -> None:
        """Adds a sample of the present state to output.file, and a frame if it is wanted, unless
        the file has just got them. Raises Error without an open file, and IoError."""
        self._run.sample(bool(frame))

    @property
    def data(self) -> Data:
        """Data of your own by name, such as notes or the state of a random number generator, which
        checkpoints, output.file and the files of save() carry: bytes, or what JSON can hold."""
        return Data(self._run)

    def save(self, path: str | os.PathLike[str], force: bool = False) -> None:
        """Writes the present state to a file, from which ``initial.file`` of a scene starts.

        ``force`` replaces an existing file. Raises IoError.
        """
        self._run.save(os.fsencode(path), force)

    def checkpoint(self) -> None:
        """Saves the simulation beside its output.file, so that resume() continues it from here.

        That happens by itself every output.checkpoint_every seconds, and in close(). All
        collisions up to now count as passed on to the function of on_collisions(). Raises Error
        without an output file, if output.checkpoint_every is 0, and after close(); IoError if it
        cannot be written.
        """
        self._run.checkpoint()

    def close(self) -> None:
        """Completes output.file, if there is one, and saves it for resume(). The state can be
        read, but not advanced."""
        self._run.close()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # The present state

    @property
    def state(self) -> State:
        """All needles: the arrays position, velocity, orientation, angular_velocity, image, id and
        species by name, and length, diameter, mass and inertia where bodies of a species differ.
        ``Simulation(scene, **state)`` starts from it."""
        if self._copy is None:
            *arrays, own = self._run.state()
            growth, bodies = self.growth, Bodies.of(self._facts.bodies)
            self._copy = State.of(arrays, bodies.grown(growth.scale) if growth else bodies,
                                  self._run.flow(),
                                  own and dict(zip(OWN_NUMBERS, own)),
                                  self._run.box() if self._facts.moving_walls else None)
        return self._copy

    @property
    def position(self) -> np.ndarray:
        """Centres in the box, [N, 3] [L]. Like all arrays of the state: in order of id,
        read-only, valid for good, and copied from the simulation once for each advance."""
        return self.state.position

    @property
    def velocity(self) -> np.ndarray:
        """Velocities of the centres, [N, 3] [L / time]."""
        return self.state.velocity

    @property
    def peculiar_velocity(self) -> np.ndarray:
        """Velocities beside the uniform flow of [shear], [N, 3] [L / time]."""
        flow = self._run.flow()
        return self.velocity if flow is None else flow[2]

    @property
    def orientation(self) -> np.ndarray:
        """Unit directors, [N, 3]."""
        return self.state.orientation

    @property
    def angular_velocity(self) -> np.ndarray:
        """Angular velocities, normal to the directors, [N, 3] [1 / time]."""
        return self.state.angular_velocity

    @property
    def image(self) -> np.ndarray:
        """Number of box edges to add to each centre to follow its path, [N, 3]."""
        return self.state.image

    @property
    def id(self) -> np.ndarray:
        """Ids of the needles, [N]."""
        return self.state.id

    @property
    def species(self) -> np.ndarray:
        """Index of the species of each needle, from 0 in the order of the scene, [N]."""
        return self.state.species

    @property
    def length(self) -> np.ndarray:
        """Length of the axis of each needle, [N] [L]."""
        return self.state.numbers("length")

    @property
    def diameter(self) -> np.ndarray:
        """Diameter of each needle, 0 of thin ones, [N] [L]."""
        return self.state.numbers("diameter")

    @property
    def mass(self) -> np.ndarray:
        """Mass of each needle, infinite of fixed ones, [N] [m]."""
        return self.state.numbers("mass")

    @property
    def inertia(self) -> np.ndarray:
        """Moment of inertia of each needle about axes normal to its director, [N] [m L^2]."""
        return self.state.numbers("inertia")

    @property
    def time(self) -> float:
        """Since the start of the run [time]."""
        return self._run.time()

    @property
    def totals(self) -> Totals:
        """Sums over all needles: time, t_tr, t_rot, energy, momentum, collisions, ..."""
        if self._totals is None:
            self._totals = Totals(self._run.totals())
        return self._totals

    @property
    def species_totals(self) -> dict[str, SpeciesTotals]:
        """Count, t_tr and t_rot of each species by its name, in the order of the scene. The name
        is "" in a scene without species."""
        return {name: SpeciesTotals(totals) for name, totals in self._run.species_totals()}

    @property
    def collisions_by_pair(self) -> dict[str, int]:
        """Number of collisions since the start between needles of each two species, by their names
        in the order of the scene, such as "a-a", "a-b" and "b-b"."""
        return self._run.collisions_by_pair()

    @property
    def wall_totals(self) -> list[WallTotals]:
        """Hits on each wall, in the order of the scene, where "both" counts as low, then high;
        empty without walls. The index of a wall here is that in rows of on_happenings()."""
        return [WallTotals(sums) for sums in self._run.wall_totals()]

    @property
    def rod_totals(self) -> RodTotals:
        """Packing fraction and pressure of rods; for needles, packing fraction and virial are 0."""
        return RodTotals(self._run.rod_totals())

    @property
    def sliding_contacts(self) -> Optional[SlidingContacts]:
        """Contacts and how they have ended; None in a scene without collisions.sliding."""
        contacts = self._run.sliding_contacts()
        return None if contacts is None else SlidingContacts(contacts)

    @property
    def growth(self) -> Optional[GrowthTotals]:
        """Present sizes, packing fraction and pressure of bodies that grow; None in a scene without
        driving.growth."""
        growth = self._run.growth()
        return None if growth is None else GrowthTotals(growth)

    @property
    def scale(self) -> float:
        """Sizes of bodies that grow in those of the start; 1 where bodies do not grow."""
        growth = self._run.growth()
        return 1.0 if growth is None else growth["scale"]

    @property
    def pressure_tensor(self) -> Optional[PressureTensor]:
        """Pressure tensor, viscosity and normal stress differences, where the scene has [shear] or
        output.observables has "pressure_tensor"; else None."""
        stress = self._run.stress()
        return None if stress is None else PressureTensor(stress)

    @property
    def energy_budget(self) -> EnergyBudget:
        """What has put energy into the needles, or taken it out, since the start."""
        return EnergyBudget(self._run.energy_budget())

    @property
    def counters(self) -> Counters:
        """Counters of the work done so far."""
        return Counters(self._run.counters())

    @property
    def hash(self) -> str:
        """Hash of all collisions so far, 32 hexadecimal digits. Equal for the same trajectory."""
        return self._run.hash()

    @property
    def mean_free_time(self) -> float:
        """By kinetic theory, from the temperatures of the present window [time]."""
        return self._run.mean_free_time()

    @property
    def box(self) -> np.ndarray:
        """Edges of the box now, which walls with a velocity move, [3] [L]."""
        return self._run.box()[0] if self._facts.moving_walls else self._facts.box

    @property
    def low(self) -> np.ndarray:
        """Where its low edges are now: 0, but where such a wall has moved one, [3] [L]."""
        return self._run.box()[1] if self._facts.moving_walls else np.zeros(3)

    # What does not change

    def __len__(self) -> int:
        """Number of needles."""
        return self._facts.count

    @property
    def periodic(self) -> np.ndarray:
        """Along which axes the box is periodic, [3]; along the others there are walls."""
        walled = {wall.axis for wall in self.wall_totals}
        return np.array([axis not in walled for axis in "xyz"])

    @property
    def gas(self) -> Values:
        """What theory has to know: count, box, k, epsilon, beta, length and mass; of several
        species the arrays species (their names), counts, k, length and mass, [species], and
        epsilon and beta of each two, [species, species]; meet, of each two whether they do, where
        some pass through each other; diameter of rods of finite width, and q = 4 I / (m D^2)
        where spheres are rough, of each species of several; differ, whether bodies of a species do, of whom length, diameter, mass
        and k are means; and undisturbed_until, the time of the
        first set_velocities(), 0 where more than collisions acts on the gas, or inf."""
        names = [name for name in ("count", "box", "species", "counts", "k", "epsilon", "beta",
                                   "meet", "length", "mass", "diameter", "q", "differ")
                 if name in self._facts]
        return Values({**{name: self._facts[name] for name in names}, "box": self.box,
                       "undisturbed_until": undisturbed_until(self.energy_budget,
                                                              self._undisturbed_until)})

    @property
    def engine(self) -> Values:
        """The parts of the engine in use: search, queue, isa, threads and effects. Search and
        queue may change with the density, where the scene leaves them to be chosen."""
        names = ("search", "queue", "isa", "threads", "effects")
        facts = self._run.facts()
        return Values({name: facts[name] for name in names})

    @property
    def file(self) -> str:
        """The file that is written, or an empty string."""
        return self._facts.file

    @property
    def scene(self) -> str:
        """The scene as TOML."""
        return self._facts.text

    def __repr__(self) -> str:
        return f"<Simulation of {len(self)} needles>"

    def _repr_html_(self) -> str:
        facts = self._facts
        edges = " x ".join(f"{edge:g}" for edge in facts.box)
        rows = {"title": facts.title} if facts.title else {}
        rows |= {"needles": f"{facts.count} in a box of {edges}", "collisions are": facts.effects}
        try:
            now = self.totals
        except Error:
            rows["state"] = "running"
        else:
            rows |= {"time": now.time, "energy": now.energy, "T_tr": now.t_tr,
                     "T_rot": now.t_rot, "collisions": now.collisions, "hash": self.hash}
        if facts.file:
            rows["file"] = facts.file
        return html_table(rows)

    # The copies of the state that are handed out

    def _forget(self) -> None:
        self._copy: Optional[State] = None
        self._totals: Optional[Totals] = None

    def _drive(self, call: Callable[..., str], progress: bool | None,
               collisions: int | None, **limits: float | None) -> str:
        count = _whole("collisions", collisions)
        numbers = {name: _number(name, limit) for name, limit in limits.items()}
        line = progress_line(progress)
        self._forget()
        try:
            return call(collisions=count, **numbers, show=line.show if line else None)
        finally:
            if line:
                line.clear()


def _callback_of(simulation: Simulation, name: str) -> Callback:
    """Calls the callback that the simulation holds under this name.

    The compiled part keeps this and no more. A callback that refers to its simulation would keep
    it alive there, where the garbage collector does not look.
    """
    reference = weakref.ref(simulation)

    def call(rows: np.ndarray) -> None:
        owner = reference()
        callback = getattr(owner, name, None)
        if callback is not None:
            callback(rows)

    return call


def _state(arrays: dict[str, ArrayLike | None], image: ArrayLike | None, ids: ArrayLike | None,
           species: ArrayLike | None, bodies: Mapping[str, ArrayLike] | None,
           own: tuple[ArrayLike | None, ...]) -> tuple[np.ndarray | tuple | None, ...] | None:
    """The arrays of an initial state, or None if there are none."""
    given = {name: values for name, values in arrays.items() if values is not None}
    if not given and all(values is None for values in (image, ids, species, *own)):
        return None
    for name in ("position", "orientation"):
        if name not in given:
            raise InputError(f"{name} is missing: expected position and orientation, where a "
                             "state is given")
    first = rows_of_vectors("position", given["position"])
    count, most = len(first), 2**31 - 1
    return (*(rows_of_vectors(name, given.get(name, np.zeros_like(first)), count)
              for name in arrays),
            None if image is None else
            whole_numbers("image", image, (count, 3), -most, most).astype(np.int32),
            None if ids is None else
            whole_numbers("id", ids, (count,), 0, 2**32 - 1).astype(np.uint32),
            None if species is None else
            whole_numbers("species", species, (count,), 0, 254).astype(np.uint8),
            _columns_of(bodies or {}),
            tuple(None if values is None else column(name, values, count)
                  for name, values in zip(OWN_NUMBERS, own)))


def _three(name: str, values: ArrayLike | None) -> list[float]:
    """A vector, or 0."""
    return [0.0] * 3 if values is None else column(name, values, 3).tolist()


def _flow(flow: Mapping[str, float]) -> tuple[float, float]:
    unknown = set(flow) - {"slide", "shear_rate"}
    if unknown:
        raise InputError(f"flow: {', '.join(sorted(unknown))}: expected slide and shear_rate")
    try:
        return float(flow.get("slide", 0)), float(flow.get("shear_rate", 0))
    except (TypeError, ValueError):
        raise InputError("flow: expected numbers") from None


def _columns_of(bodies: Mapping[str, ArrayLike]) -> tuple[list, ...]:
    """The columns of bodies, empty where they are not known."""
    names = ("name", *NUMBERS_OF_BODIES)
    unknown = set(bodies) - set(names)
    if unknown:
        raise InputError(f"bodies: {', '.join(sorted(unknown))}: expected {', '.join(names)}")
    try:
        return ([str(name) for name in bodies.get("name", ())],
                *([float(value) for value in np.ravel(bodies.get(name, ()))]
                  for name in NUMBERS_OF_BODIES))
    except (TypeError, ValueError):
        raise InputError("bodies: expected a number for each species") from None


def _number(name: str, value: float | None) -> float | None:
    try:
        if isinstance(value, (str, bytes, bool, np.bool_)):
            raise TypeError
        return None if value is None else float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} = {value!r}: expected a number >= 0") from None


def _whole(name: str, value: float | None) -> int | None:
    """A number such as 1000 or 1e3 as an integer."""
    if isinstance(value, (float, np.floating)) and float(value).is_integer():
        value = int(value)
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = None if value is None else operator.index(value)
    except TypeError:
        number = -1
    if number is not None and not 0 <= number < 2**63:
        raise InputError(f"{name} = {value!r}: expected a whole number from 0 to 2^63 - 1")
    return number
