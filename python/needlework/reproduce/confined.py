"""Beyond the paper: gases between walls, and above a floor under gravity."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..reading import Recording
from ..values import Table
from . import style
from .course import late_ratio, mean_and_error, mean_of, measure, slope
from .driving import STEADY, steady_mean
from .exact import LAYER, Atmosphere, WallRates, between_walls
from .figure import Result, parts
from .runs import Conditions, FinishedRun, PaperRuns, Point

COLD = 0.1
"""E/E(0) below which a gas that cools between walls is late."""


def measure_walls(runs: PaperRuns) -> Result:
    """Cooling between elastic walls at several distances, beside the theory of a gas without
    walls that collides as often; in elastic equilibrium hits, force and collisions."""
    result = Result(("distance", "tau", "energy", "energy_error", "energy_theory", "ratio",
                     "ratio_error", "ratio_theory"))
    for point in runs.points("walls"):
        if point.conditions.epsilon == 1:
            _add_equilibrium(result, point)
        else:
            _add_cooling(result, point)
    return result


def _add_equilibrium(result: Result, point: Point) -> None:
    gas = point.conditions
    # The energy is given exactly. The momentum across the walls is not kept.
    temperature = 5 * gas.count / (5 * gas.count - 2)
    hits, force, collisions = _exact_rates(gas)
    for claim, exact, of_run in (("walls-hits", hits * temperature**0.5, _hits),
                                 ("walls-force", force * temperature, _force),
                                 ("walls-collisions", collisions * temperature**0.5,
                                  _collision_rate)):
        result.add(claim, measure(point, of_run).over(exact), f"H = {gas.box[2]:g}")


def _add_cooling(result: Result, point: Point) -> None:
    gas, at_distance = point.conditions, f"H = {point.conditions.box[2]:g}"
    # The density at which a gas without walls collides as often.
    density = _exact_rates(gas).collisions / float(theory.collision_rate(gas.k, 1.0))
    length = min(len(run.series.time) for run in point.runs)
    curve = theory.cooling(gas.epsilon, gas.k, gas.beta, 1.0,
                           tau=theory.tau(point.first.series.time[:length], density))
    energies = [run.energy[:length] / run.energy[0] for run in point.runs]
    expected = curve.energy / curve.energy[0]
    ratio = measure(point, lambda run: late_ratio(run, run.energy <= COLD * run.energy[0]))
    result.add_rows(gas.box[2], curve.tau, *mean_and_error(energies), expected, *ratio[:2],
                    theory.ratio(gas.epsilon, gas.k, gas.beta))
    result.add("walls-energy", mean_of([energy[-1] / expected[-1] for energy in energies]),
               at_distance)
    result.add("walls-ratio", ratio, at_distance)
    result.add("walls-anisotropy", measure(point, _late_anisotropy), at_distance)


def draw_walls(table: Table) -> Figure:
    """Energy against scaled time, the same over theory, and the ratio of temperatures."""
    figure, (cooling, over, ratios) = style.panels("A gas that cools between walls", 3)
    for number, ((distance,), part) in enumerate(parts(table, "distance")):
        look = {"color": style.COLOURS[number % len(style.COLOURS)],
                "label": f"$H = {distance:g}$"}
        style.band(cooling, part.tau, part.energy, part.energy_error, **look)
        style.band(over, part.tau, part.energy / part.energy_theory,
                   part.energy_error / part.energy_theory, **look)
        style.points(ratios, distance, part.ratio[0], part.ratio_error[0], color=look["color"])
        longest = part
    cooling.plot(longest.tau, longest.energy_theory, "--", color=style.COLOURS[5], label="theory")
    over.axhline(1, color=style.COLOURS[5], linestyle="--")
    ratios.axhline(longest.ratio_theory[0], color=style.COLOURS[5], linestyle="--",
                   label="theory without walls")
    style.label(cooling, r"scaled time $\tau$", "$E / E(0)$", log="y")
    style.label(over, r"scaled time $\tau$", "$E$ / theory", legend=False)
    style.label(ratios, "$H / L$", r"$T_{\rm tr} / T_{\rm rot}$, late")
    return figure


def _exact_rates(gas: Conditions) -> WallRates:
    return between_walls(gas.k, gas.count, gas.box[0] * gas.box[1], gas.box[2])


def _since(run: FinishedRun, values: np.ndarray) -> float:
    """What a counter has gained per time since the state is steady."""
    first = int(np.argmax(run.series.time >= STEADY * run.series.time[-1]))
    return float((values[-1] - values[first]) / (run.series.time[-1] - run.series.time[first]))


def _hits(run: FinishedRun) -> float:
    """Per needle, time and wall."""
    hits = run.observable("walls", "hits")
    return _since(run, hits.mean(axis=1)) / run.conditions.count


def _force(run: FinishedRun) -> float:
    """On a wall."""
    return _since(run, run.observable("walls", "impulse").mean(axis=1))


def _collision_rate(run: FinishedRun) -> float:
    """Of each needle with others per time."""
    return _since(run, run.collisions)


def _late_anisotropy(run: FinishedRun) -> float:
    """T_tr along z over the mean of that along x and y, late."""
    by_axis = run.observable("temperature_by_axis", "t_tr")
    late = run.energy <= COLD * run.energy[0]
    if not late.any():
        return np.nan
    return float(np.mean(2 * by_axis[late, 2] / (by_axis[late, 0] + by_axis[late, 1])))


def measure_sedimentation(runs: PaperRuns) -> Result:
    """The elastic gas above a floor: density and order of the directors against height, exact."""
    result = Result(("z", "density", "density_error", "density_exact", "order", "order_error",
                     "order_exact"))
    for point in runs.points("sedimentation"):
        gravity = gravity_of(point.conditions)
        exact = Atmosphere(measure(point, _steady_temperature).value, gravity)
        borders = _borders(exact.scale)
        layers = [_layers(run, borders) for run in point.runs]
        middles = (borders[1:] + borders[:-1]) / 2
        result.add_rows(middles, *mean_and_error([layer.density for layer in layers]),
                        exact.density(middles),
                        *mean_and_error([layer.order for layer in layers]), exact.order(middles))
        result.add("sedimentation-height", measure(point, lambda run: (
            _steady_height(run) / Atmosphere(_steady_temperature(run), gravity).mean_height)))
        result.add("sedimentation-force",
                   measure(point, _force).over(point.conditions.count * gravity))
        result.add("sedimentation-depletion", mean_of(
            [layer.at_floor / exact.share_at_floor for layer in layers]))
    return result


def draw_sedimentation(table: Table) -> Figure:
    """Density and order near the floor, and the density over many heights."""
    figure, (near, far, order) = style.panels("Elastic needles above a floor", 3)
    for panel in (near, far):
        style.points(panel, table.z, table.density, table.density_error, label="simulation")
        panel.plot(table.z, table.density_exact, color=style.COLOURS[1], label="exact")
    near.set_xlim(0, 4 * LAYER)
    style.label(near, "$z / L$", r"$\rho L / N$ per area", "Near the floor")
    style.label(far, "$z / L$", r"$\rho L / N$ per area", "The whole atmosphere", log="y")
    low = table.z < 4 * LAYER
    style.points(order, table.z[low], table.order[low], table.order_error[low], label="simulation")
    order.plot(table.z[low], table.order_exact[low], color=style.COLOURS[1], label="exact")
    style.label(order, "$z / L$", r"$\langle (3 u_z^2 - 1) / 2 \rangle$", "Directors")
    return figure


class Layers(NamedTuple):
    """Means over the frames of the steady state of a run."""

    density: np.ndarray
    """Probability density of a centre, in each layer [1 / L]."""
    order: np.ndarray
    """Mean of (3 u_z^2 - 1) / 2 in each layer."""
    at_floor: float
    """Share of the centres nearer to the floor than L/2."""


def _layers(run: FinishedRun, borders: np.ndarray) -> Layers:
    begin = STEADY * run.series.time[-1]
    with Recording(run.path) as recording:
        frames = [frame for frame in recording.frames if frame.time >= begin]
        z = np.concatenate([frame.position[:, 2] for frame in frames])
        u_z = np.concatenate([frame.orientation[:, 2] for frame in frames])
    counts, _ = np.histogram(z, borders)
    orders, _ = np.histogram(z, borders, weights=(3 * u_z**2 - 1) / 2)
    return Layers(counts / len(z) / np.diff(borders), orders / counts,
                  float(np.mean(z < LAYER)))


def _borders(scale: float) -> np.ndarray:
    """Borders of layers: ten near the floor, then twenty over six heights T / (m g)."""
    return np.concatenate([np.linspace(0, 2 * LAYER, 11),
                           np.linspace(2 * LAYER, 6 / scale, 21)[1:]])


def gravity_of(gas: Conditions) -> float:
    """How strongly needles are drawn to the floor, across z."""
    return -gas.scene["forces"]["gravity"][2]


def _motion(run: FinishedRun) -> np.ndarray:
    """Energy of translation and rotation per needle at the samples."""
    return 1.5 * run.series.t_tr + run.series.t_rot


def _steady_temperature(run: FinishedRun) -> float:
    return steady_mean(run, _motion(run)) / 2.5


def _steady_height(run: FinishedRun) -> float:
    """Mean height of the centres, by the energy of the weight."""
    return steady_mean(run, run.series.energy - _motion(run)) / gravity_of(run.conditions)


def measure_settling(runs: PaperRuns) -> Result:
    """Inelastic needles that settle on the floor: sqrt(E) against time, beside theory."""
    result = Result(("epsilon", "time", "root", "root_error", "root_theory"))
    for point in runs.points("settling"):
        gas, variant = point.conditions, f"epsilon = {point.conditions.epsilon:g}"
        length = min(len(run.series.time) for run in point.runs)
        time = point.first.series.time[:length]
        expected = settling_theory(gas, time)
        roots = [_root(run)[:length] for run in point.runs]
        result.add_rows(gas.epsilon, collapse_rate(gas) * time, *mean_and_error(roots), expected)
        result.add("settling-rate", mean_of([_rate(time, root) for root in roots]).over(
            _rate(time, expected)), variant)
        result.add("settling-limit", mean_of([_rate(time, root) for root in roots]).over(
            collapse_rate(gas)), variant)
    return result


def draw_settling(table: Table) -> Figure:
    """sqrt(E) against scaled time, theory dashed, and the straight line far above L."""
    figure, (axes,) = style.panels("Inelastic needles settle on a floor", 1, width=5.6, height=3.6)
    for number, ((epsilon,), part) in enumerate(parts(table, "epsilon")):
        colour = style.COLOURS[number % len(style.COLOURS)]
        style.band(axes, part.time, part.root, part.root_error, color=colour,
                   label=rf"$\epsilon = {epsilon:g}$")
    axes.plot(part.time, part.root_theory, "--", color=style.COLOURS[5], label="theory")
    axes.plot([0, 1], [1, 0], ":", color=style.COLOURS[5], label="theory for $T \gg m g L$")
    style.label(axes, r"time / collapse time for $T \gg m g L$", r"$(E / E(0))^{1/2}$")
    return figure


SETTLING_FROM, SETTLING_TO = 0.9, 0.5
"""Shares of sqrt(E / E(0)) between which its slope is fitted."""


def _root(run: FinishedRun) -> np.ndarray:
    """sqrt(E / E(0))."""
    return np.sqrt(run.series.energy / run.series.energy[0])


def _rate(time: np.ndarray, root: np.ndarray) -> float:
    """The rate at which a root falls."""
    fitted = (root <= SETTLING_FROM) & (np.cumsum(root < SETTLING_TO) == 0)
    return -slope(time[fitted], root[fitted])


def _per_area(gas: Conditions) -> float:
    return gas.count / (gas.box[0] * gas.box[1])


def _drawn_energy(gas: Conditions) -> float:
    """Per needle, where centres are drawn uniformly between the floor and the edge of the box."""
    return 1.5 * gas.t_tr + gas.t_rot + gravity_of(gas) * (gas.box[2] + LAYER / 2) / 2


def settling_theory(gas: Conditions, time: np.ndarray) -> np.ndarray:
    """sqrt(E / E(0)) of an atmosphere that stays isothermal and barometric while it cools."""
    start = _drawn_energy(gas)
    energies, losses = [], []
    for temperature in np.geomspace(start / 2.5, 1e-3 * start, 200):
        atmosphere = Atmosphere(temperature, gravity_of(gas))
        energies.append(atmosphere.energy)
        losses.append(atmosphere.loss(gas.k, gas.epsilon, _per_area(gas)))
    falling, per_loss = np.array(energies), 1 / np.array(losses)
    steps = -np.diff(falling) * (per_loss[1:] + per_loss[:-1]) / 2
    times = np.concatenate([[0], np.cumsum(steps)])
    times -= np.interp(-start, -falling, times)
    return np.sqrt(np.interp(time, times, falling) / start)


def collapse_rate(gas: Conditions) -> float:
    """The rate at which sqrt(E / E(0)) falls where the atmosphere is high above L: E = (7/2) T per
    needle, of which collisions take (nu / 4) (1 - epsilon^2) S g sqrt(T), with S needles per area
    and nu the collision rate of equilibrium at n = T = 1."""
    loss = (float(theory.collision_rate(gas.k, 1.0)) / 4 * (1 - gas.epsilon**2) * _per_area(gas)
            * gravity_of(gas))
    return loss / 7 / np.sqrt(_drawn_energy(gas) / 3.5)
