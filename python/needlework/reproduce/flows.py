"""Beyond the paper: pistons, and flows between walls that slide or along a channel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .course import mean_and_error, mean_of, measure
from .figure import Result, parts
from .runs import Conditions, FinishedRun, PaperRuns, Point

NEEDLES, RODS, SPHERES = range(3)
"""The column kind of the data."""

NAMES = ("needles", "rods, $L/D = 5$", "spheres")

PISTONS = {"piston": NEEDLES, "piston-out": NEEDLES, "piston-spheres": SPHERES}

COUETTE, CHANNEL = "couette", "channel"
"""The column flow of the data counts them 0 and 1."""

FLOWS = {f"{flow}-{kind}": (flow, number) for flow in (COUETTE, CHANNEL)
         for number, kind in enumerate(("needles", "rods", "spheres"))}

STEADY = 0.2
"""Share of a run after which a flow is taken to be steady: several times the time in which momentum
spreads over the channel."""

VISCOSITY = {NEEDLES: 1.65, SPHERES: 0.179}
"""Of dilute elastic gases over sqrt(m T) / L^2: spheres by Chapman and Enskog, 1.016 times
5 / (16 sqrt(pi)); needles (k = 6) by direct simulation Monte Carlo of encounters, 1.65(1)."""


def measure_pistons(runs: PaperRuns) -> Result:
    """By how much the energy exceeds that of a slow piston, after the room has been halved or
    doubled at some velocity."""
    result = Result(("kind", "out", "velocity", "excess", "error", "seeds"))
    for name, kind in PISTONS.items():
        for point in runs.points(name):
            velocity = point.conditions.scene["walls"][1]["motion"]["velocity"]
            excess = measure(point, lambda run, kind=kind: run.energy[-1] / run.energy[0]
                             / slow_piston(run.conditions, kind) - 1)
            result.rows.append((kind, velocity > 0, abs(velocity), *excess[:2], point.seeds))
            result.add(f"piston-{'spheres' if kind == SPHERES else 'needles'}",
                       excess, f"velocity {velocity:g}")
    return result


def slow_piston(gas: Conditions, kind: int) -> float:
    """E / E(0) of a slow piston: the room of the centres to the power of minus two over the number
    of degrees of freedom for each of these, beside the momentum along the walls, which is 0; of
    spheres with the second virial coefficient."""
    before, after = gas.box[2], gas.scene["walls"][1]["motion"]["stop_at"]
    if kind == NEEDLES:
        return float(((before - 0.5) / (after - 0.5)) ** (2 * gas.count / (5 * gas.count - 2)))
    packing = [gas.count * np.pi / 6 / (gas.box[0] * gas.box[1] * edge) for edge in (before, after)]
    return float(((before - 1) / (after - 1)) ** (2 * gas.count / (3 * gas.count - 2))
                 * np.exp(8 / 3 * (packing[1] - packing[0])))


def draw_pistons(table: Table) -> Figure:
    """The excess against the velocity of the piston."""
    figure, (panel,) = style.panels("Energy after a piston has moved", 1, width=5.2, height=3.4)
    for number, ((kind, out), part) in enumerate(parts(table, "kind", "out")):
        what = f"{NAMES[int(kind)]}, {'twice' if out else 'half'} the room"
        style.points(panel, part.velocity, part.excess, part.error, label=what,
                     color=style.COLOURS[number])
    panel.axhline(0, color=style.COLOURS[5], linewidth=0.8)
    panel.set_yscale("symlog", linthresh=0.01)
    style.label(panel, r"velocity of the piston / $(T/m)^{1/2}$", "$E$ / slow piston $- 1$",
                log="x")
    return figure


class Slabs(NamedTuple):
    """Means of a run over the samples of its steady state, in each slab between the walls."""

    velocity: np.ndarray
    temperature: np.ndarray
    density: np.ndarray
    order: np.ndarray


def measure_flows(runs: PaperRuns) -> Result:
    """Profiles across the channel, and what walls and middle say of the viscosity."""
    result = Result(("kind", "flow", "place", "velocity", "velocity_error", "no_slip", "temperature",
                     "temperature_error", "density", "order", "order_error"))
    for name, (flow, kind) in FLOWS.items():
        for point in runs.points(name):
            _add_flow(result, point, flow, kind)
    return result


def _add_flow(result: Result, point: Point, flow: str, kind: int) -> None:
    gas = point.conditions
    place = middles(point.first) / gas.box[2] - 0.5
    slabs = [Slabs(*columns) for columns in zip(*(
        mean_and_error([getattr(_slabs(run), name) for run in point.runs])
        for name in Slabs._fields))]
    mean, error = slabs
    result.add_rows(kind, flow == CHANNEL, place, mean.velocity, error.velocity,
                    _no_slip(gas, kind, flow, place), mean.temperature, error.temperature,
                    mean.density, mean.order, error.order)
    variant = f"{flow}, {('needles', 'rods', 'spheres')[kind]}"
    viscosity = measure(point, lambda run: _viscosity(run, flow))
    result.add("flow-viscosity", viscosity, variant)
    if kind in VISCOSITY:
        result.add("flow-viscosity-dilute", viscosity.over(VISCOSITY[kind]), variant)
    low, high = (mean_of(forces) for forces in zip(*(_forces(run) for run in point.runs)))
    balance = low.over_measured(high) if flow == COUETTE else mean_of(
        [sum(_forces(run)) for run in point.runs]).over(_weight(gas))
    result.add("flow-balance", balance._replace(value=-balance.value), variant)


def draw_flows(table: Table) -> Figure:
    """Velocity, temperature and order across the channel."""
    figure, axes = style.panels("Flow between sliding walls (above), and along a channel (below)", 6,
                                columns=3)
    for (kind, flow), part in parts(table, "kind", "flow"):
        look = {"color": style.COLOURS[int(kind)], "label": NAMES[int(kind)]}
        velocity, temperature, order = axes[3 * int(flow):3 * int(flow) + 3]
        style.points(velocity, part.place, part.velocity, part.velocity_error, **look)
        velocity.plot(part.place, part.no_slip, color=look["color"], linewidth=0.8)
        style.band(temperature, part.place, part.temperature, part.temperature_error, **look)
        if kind != SPHERES:
            style.band(order, part.place, part.order, part.order_error, **look)
    for velocity, temperature, order in (axes[:3], axes[3:]):
        style.label(velocity, "$z / H$", "$v_x$", "without slip as lines")
        style.label(temperature, "$z / H$", "$T_{tr}$ beside the flow", legend=False)
        style.label(order, "$z / H$", "$P_2$ of the angle to the normal", legend=False)
    return figure


def middles(run: FinishedRun) -> np.ndarray:
    """Of the slabs, from the low wall on."""
    return run.observable("wall_profiles", "position").ravel()


def _slabs(run: FinishedRun) -> Slabs:
    fields = {name: run.observable("wall_profiles", name)[:, 0]
              for name in ("density", "velocity", "t_tr_beside_flow", "p2")}
    late = run.series.time >= STEADY * run.series.time[-1]
    density = fields["density"][late]

    def mean(values: np.ndarray) -> np.ndarray:
        there = np.isfinite(values)
        return np.sum(density * np.where(there, values, 0), 0) / np.sum(density * there, 0)

    return Slabs(mean(fields["velocity"][late, :, 0]), mean(fields["t_tr_beside_flow"][late]),
                 density.mean(axis=0), mean(fields["p2"][late]))


def _forces(run: FinishedRun) -> tuple[float, float]:
    """Along x, of the low and of the high wall on the gas per area."""
    impulse, time = run.observable("walls", "impulse_x"), run.series.time
    first = int(np.argmax(time >= STEADY * time[-1]))
    area = run.conditions.box[0] * run.conditions.box[1]
    low, high = (impulse[-1] - impulse[first]) / ((time[-1] - time[first]) * area)
    return float(low), float(high)


def _weight(gas: Conditions) -> float:
    """Of the gas along the channel, per area of a wall."""
    return gas.count * gas.scene["forces"]["gravity"][0] / (gas.box[0] * gas.box[1])


def _viscosity(run: FinishedRun, flow: str) -> float:
    """By the profile in the middle seven tenths, over the root of the temperature
    there."""
    gas, slabs = run.conditions, _slabs(run)
    z = middles(run) - gas.box[2] / 2
    middle = np.abs(z) < 0.35 * gas.box[2]
    root = np.sqrt(slabs.temperature[middle].mean())
    low, high = _forces(run)
    if flow == COUETTE:
        return float((high - low) / 2 / np.polyfit(z[middle], slabs.velocity[middle], 1)[0] / root)
    curvature = np.polyfit(z[middle], slabs.velocity[middle], 2)[0]
    pull = slabs.density[middle].mean() * gas.scene["forces"]["gravity"][0]
    return float(-pull / (2 * curvature) / root)


def _no_slip(gas: Conditions, kind: int, flow: str, place: np.ndarray) -> np.ndarray:
    """What a gas of this viscosity does that has the velocities of the walls next to them."""
    if flow == COUETTE:
        return 2 * place * gas.scene["walls"][1]["motion"]["tangential"][0]
    if kind not in VISCOSITY:
        return np.full_like(place, np.nan)
    pull = gas.density * gas.scene["forces"]["gravity"][0]
    return pull * gas.box[2] ** 2 / (2 * VISCOSITY[kind]) * (0.25 - place**2)
