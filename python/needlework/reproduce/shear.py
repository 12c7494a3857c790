"""Beyond the paper: steady states of uniform shear, against density and restitution."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..values import Table
from . import style
from .course import Measured, measure
from .figure import Result, parts
from .nematic import packing_of
from .runs import FinishedRun, PaperRuns, Point

NEEDLES, RODS, SPHERES = range(3)
"""The column kind of the data."""

SETS = {"shear-thin": NEEDLES, "shear": NEEDLES, "shear-dense": NEEDLES, "shear-large": NEEDLES,
        "shear-rods": RODS, "shear-spheres": SPHERES}
"""Sets of runs, and of what they are."""

LARGE = "shear-large"
"""The set in boxes that long waves fit into."""

STEADY = 1 / 4
"""Share of a run after which it is taken to be steady."""


class State(NamedTuple):
    """What describes a steady state: temperature over m gamma^2 / (n^2 L^4), T_rot / T_tr,
    -P_yx / (n T_tr), and the greatest eigenvalue of the tensor of the nematic order with the angle
    of its axis to the flow in degrees. The length of spheres is their diameter."""

    temperature: Any = np.nan
    ratio: Any = np.nan
    stress: Any = np.nan
    order: Any = np.nan
    angle: Any = np.nan


LABELS = State(r"$T_{\rm tr}\, n^2 L^4 / (m \dot\gamma^2)$", r"$T_{\rm rot} / T_{\rm tr}$",
               r"$-P_{yx} / (n\, T_{\rm tr})$", "nematic order",
               "angle of directors to the flow [°]")

OF_ENCOUNTERS = {0.9: State(13.52, 0.8873, 0.3995, 0.0117, -32.8),
                 0.7: State(4.714, 0.7161, 0.5598, 0.0204, -24.8)}
"""Thin needles with k = 6 in the limit of low density, by epsilon: direct simulation Monte Carlo of
the Boltzmann equation in which two needles that meet are followed until they part. Standard errors
are 0.4 and 0.2 % of the temperature, 0.2 % of ratio and stress, 2 % of the order, 0.4 degrees."""

OF_ENSKOG = {0.9: State(0.2187, stress=0.3706), 0.7: State(0.0622, stress=0.5647)}
"""Spheres at n d^3 = 0.1, by epsilon: direct simulation Monte Carlo of the Enskog equation, with
standard errors of 0.2 % of the temperature and 0.1 % of the stress."""


def measure_shear(runs: PaperRuns) -> Result:
    """The steady state, and the energy of the longest wave along z of the velocity along the flow,
    over that of independent bodies."""
    result = Result(("kind", "large", "epsilon", "density", "packing", "edge",
                     *(name + part for name in State._fields for part in ("", "_error", "_limit")),
                     "collisional", "collisional_error", "wave", "wave_error", "wave_predicted",
                     "seeds"))
    for name, kind in SETS.items():
        for point in runs.points(name):
            gas = point.conditions
            state, limit = _state(point, kind), _limit(kind, gas.epsilon)
            collisional = measure(point, lambda run: _stress(run, "collisional"))
            wave = measure(point, longest_wave)
            result.rows.append((
                kind, name == LARGE, gas.epsilon, gas.density,
                packing_of(gas) if kind == RODS else np.nan, gas.box[2],
                *(number for measured, known in zip(state, limit)
                  for number in (*measured[:2], known)),
                *collisional[:2], *wave[:2], np.mean(point.values(predicted_wave)), point.seeds))
            _compare(result, point, name, state, limit)
    return result


def draw_shear(table: Table) -> Figure:
    """The steady state against density, beside the limits of low density, and the longest wave."""
    figure, axes = style.panels("Uniform shear", 6, columns=3, width=3.7)
    colours = dict(zip(sorted(set(table.epsilon), reverse=True), style.COLOURS))
    for (kind, large, epsilon), part in parts(table, "kind", "large", "epsilon"):
        if kind == SPHERES:
            continue
        colour = colours[epsilon]
        look = {"marker": "s" if kind == RODS else "o", "color": colour,
                "mfc": "white" if large else colour}
        for panel, name in zip(axes, (*State._fields, "wave")):
            style.points(panel, part.density, part[name], part[f"{name}_error"], **look)
            if name == "wave":
                panel.plot(part.density, part.wave_predicted, "_", color=colour, markersize=9)
            elif not large:
                panel.plot([0.07, 0.25], np.repeat(part[f"{name}_limit"][0], 2), color=colour)
    for panel, name in zip(axes, (*LABELS, "longest wave / equipartition")):
        style.label(panel, "$n L^3$", name, legend=False,
                    log="xy" if panel in (axes[0], axes[3], axes[5]) else "x")
    _explain(axes[5], colours)
    return figure


def _explain(panel: Axes, colours: dict[float, str]) -> None:
    """A legend of colours and marks."""
    marks = [Line2D([], [], color=colour, label=rf"$\epsilon = {epsilon:g}$")
             for epsilon, colour in colours.items()]
    grey = style.COLOURS[5]
    marks += [Line2D([], [], color=grey, linestyle="", marker=marker, mfc=fill, label=label)
              for marker, fill, label in (("o", grey, "needles"), ("o", "white", "larger box"),
                                          ("s", grey, "rods, $L/D = 5$"), ("_", grey, "predicted"))]
    panel.legend(handles=marks, fontsize=7.5, loc="upper left")


def _limit(kind: int, epsilon: float) -> State:
    return {NEEDLES: OF_ENCOUNTERS, SPHERES: OF_ENSKOG}.get(kind, {}).get(epsilon, State())


def _state(point: Point, kind: int) -> State:
    gas = point.conditions
    scale = gas.density**2 / gas.scene["shear"]["rate"]**2
    state = State(
        temperature=measure(point, lambda run: scale * _late(run, run.series.t_tr)),
        ratio=measure(point, lambda run: _late(run, run.series.t_rot)
                      / _late(run, run.series.t_tr)),
        stress=measure(point, lambda run: _stress(run, "kinetic") + _stress(run, "collisional")),
        order=Measured(np.nan, np.nan), angle=Measured(np.nan, np.nan))
    if kind == SPHERES:
        return state._replace(ratio=Measured(np.nan, np.nan))
    tensors = point.values(lambda run: _late(run, run.observable("alignment", "order_tensor")))
    return state._replace(order=jackknife(tensors, greatest_order),
                          angle=jackknife(tensors, angle_to_flow, 180))


def _late(run: FinishedRun, values: np.ndarray) -> Any:
    """The mean over the samples of the steady state."""
    return np.mean(values[run.series.time >= STEADY * run.series.time[-1]], axis=0)


def _stress(run: FinishedRun, part: str) -> float:
    """What flights ("kinetic") or collisions give to -P_yx / (n T_tr)."""
    pressure = run.conditions.density * _late(run, run.series.t_tr)
    return float(-_late(run, run.observable("pressure_tensor", f"{part}_yx")) / pressure)


def greatest_order(tensor: np.ndarray) -> float:
    """The greatest eigenvalue of the tensor of the nematic order."""
    return float(np.linalg.eigvalsh(tensor.reshape(3, 3))[-1])


def angle_to_flow(tensor: np.ndarray) -> float:
    """The angle of the axis of greatest order in the plane of shear to the flow, from -90 to 90
    degrees, positive where directors lean towards the gradient."""
    xx, xy, yy = tensor.reshape(3, 3)[[0, 0, 1], [0, 1, 1]]
    return float(np.degrees(np.arctan2(2 * xy, xx - yy) / 2))


def jackknife(samples: Any, number: Callable[[np.ndarray], float],
              period: float = np.inf) -> Measured:
    """A function of the mean over seeds, as weak order has noise that the mean of the functions of
    all would keep, with its standard error by leaving out one seed after the other. Values that
    differ by the period are the same."""
    samples = np.asarray(samples)
    n, value = len(samples), number(samples.mean(axis=0))
    if n < 2:
        return Measured(value, np.nan, n)
    others = np.array([number(np.delete(samples, one, axis=0).mean(axis=0)) for one in range(n)])
    if np.isfinite(period):
        others = value + (others - value + period / 2) % period - period / 2
    return Measured(value, float(np.sqrt((n - 1) * np.var(others))), n)


def longest_wave(run: FinishedRun) -> float:
    """The mean square amplitude of the longest wave along z of c_x over that of independent bodies
    with the same mean square of c_x. Of slabs in place of bodies: these keep what is independent,
    and the square of a sinc of the rest."""
    gas, along_z = run.conditions, 2
    density = run.observable("profiles", "density")[:, along_z]
    momentum = density * run.observable("profiles", "flow")[:, along_z, :, 0]
    slabs = density.shape[1]
    amplitude = momentum @ np.exp(2j * np.pi * np.arange(slabs) / slabs) * np.prod(gas.box) / slabs
    square = _late(run, run.observable("pressure_tensor", "kinetic_xx")) / gas.density
    over = _late(run, np.abs(amplitude) ** 2) / (gas.count * square)
    return float(1 + (over - 1) / np.sinc(1 / slabs) ** 2)


def predicted_wave(run: FinishedRun) -> float:
    """1 + (gamma / (nu k^2))^2 / 2 with the viscosity nu = -P_yx / (gamma n m) of the run: shear
    feeds the wave, and only viscosity damps it."""
    gas = run.conditions
    rate, k = gas.scene["shear"]["rate"], 2 * np.pi / gas.box[2]
    nu = ((_stress(run, "kinetic") + _stress(run, "collisional"))
          * _late(run, run.series.t_tr) / rate)
    return float(1 + (rate / (nu * k**2)) ** 2 / 2)


def _compare(result: Result, point: Point, name: str, state: State, limit: State) -> None:
    """Adds measurements of a point; those that a limit is for over it."""
    gas, kind = point.conditions, SETS[name]
    body = ("needles", "rods", "spheres")[kind]
    variant = f"{body}, n = {gas.density:.3g}, epsilon = {gas.epsilon:g}"
    if name == LARGE:
        variant += ", large box"
    if kind == SPHERES:
        result.add("shear-enskog-temperature", state.temperature.over(limit.temperature), variant)
        result.add("shear-enskog-stress", state.stress.over(limit.stress), variant)
        return
    if name == "shear-thin" and gas.density < 0.2 and not np.isnan(limit.temperature):
        for quantity in ("temperature", "ratio", "stress"):
            result.add(f"shear-limit-{quantity}",
                       getattr(state, quantity).over(getattr(limit, quantity)), variant)
    for quantity, measured in zip(State._fields, state):
        result.add(f"shear-{quantity}", measured, variant)
