"""Beyond the paper: steady states of gases that are kicked, or that a floor shakes."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .course import mean_of, measure, slope
from .exact import Atmosphere
from .figure import Result, parts
from .runs import Conditions, FinishedRun, PaperRuns

STEADY = 1 / 3
"""Share of the time of a run after which it is taken to be steady."""


def steady_mean(run: FinishedRun, values: np.ndarray) -> float:
    """The mean over the samples of the steady state."""
    return float(np.mean(values[run.series.time >= STEADY * run.series.time[-1]]))


def measure_kicked(runs: PaperRuns) -> Result:
    """Temperatures and cumulants of a kicked gas against restitution, beside kinetic theory."""
    result = Result(("k", "epsilon", "t_tr", "t_tr_error", "t_tr_theory", "ratio", "ratio_error",
                     "ratio_theory", "cumulant_v", "cumulant_v_error", "cumulant_w",
                     "cumulant_w_error"))
    for point in runs.points("kicked"):
        gas = point.conditions
        variant = f"epsilon = {gas.epsilon:g}, k = {gas.k:g}"
        t_tr_theory, t_rot_theory = kicked_theory(gas)
        t_tr = measure(point, lambda run: steady_mean(run, run.series.t_tr))
        ratio = measure(point, lambda run: steady_mean(run, run.series.t_tr)
                        / steady_mean(run, run.series.t_rot))
        v, w = (measure(point, lambda run: steady_mean(
            run, run.observable("velocity_moments", name))) for name in ("cumulant_v", "cumulant_w"))
        result.rows.append((gas.k, gas.epsilon, *t_tr[:2], t_tr_theory, *ratio[:2],
                            t_tr_theory / t_rot_theory, *v[:2], *w[:2]))
        result.add("kicked-temperature", t_tr.over(t_tr_theory), variant)
        result.add("kicked-ratio", ratio.over(t_tr_theory / t_rot_theory), variant)
        result.add("kicked-cumulant-v", v, variant)
        result.add("kicked-cumulant-w", w, variant)
    return result


def draw_kicked(table: Table) -> Figure:
    """Ratio of temperatures, temperature over theory, and cumulants."""
    figure, (ratios, temperatures, cumulants) = style.panels("A kicked gas in its steady state", 3)
    for number, ((k,), part) in enumerate(parts(table, "k")):
        look = {"color": style.COLOURS[number], "label": f"$k = {k:g}$"}
        ratios.plot(part.epsilon, part.ratio_theory, color=look["color"])
        style.points(ratios, part.epsilon, part.ratio, part.ratio_error, **look)
        style.points(temperatures, part.epsilon, part.t_tr / part.t_tr_theory,
                     part.t_tr_error / part.t_tr_theory, **look)
        style.points(cumulants, part.epsilon, part.cumulant_v, part.cumulant_v_error,
                     color=look["color"], label=f"of $v$, $k = {k:g}$")
        style.points(cumulants, part.epsilon, part.cumulant_w, part.cumulant_w_error,
                     color=look["color"], mfc="white", label=rf"of $\omega$, $k = {k:g}$")
    temperatures.axhline(1, color=style.COLOURS[5], linewidth=0.8)
    epsilon = np.linspace(table.epsilon.min(), 1, 50)
    cumulants.plot(epsilon, cumulant_of_spheres(epsilon), color=style.COLOURS[5],
                   label="of smooth spheres, theory")
    style.label(ratios, r"$\epsilon$", r"$T_{\rm tr} / T_{\rm rot}$", "Theory as lines")
    style.label(temperatures, r"$\epsilon$", r"$T_{\rm tr}$ / theory")
    style.label(cumulants, r"$\epsilon$", "fourth cumulant")
    return figure


def kicked_theory(gas: Conditions) -> tuple[float, float]:
    """T_tr and T_rot at which what kicks give is what collisions take, of Gaussian velocities."""
    kicks, inertia = gas.scene["driving"]["kicks"], 1 / (2 * gas.k)
    into_tr = kicks.get("translational", 0.0) ** 2 * (1 - 1 / gas.count)
    into_rot = kicks.get("rotational", 0.0) ** 2 * inertia
    needles = {"counts": gas.count, "box": gas.box, "k": gas.k, "epsilon": gas.epsilon,
               "beta": gas.beta}

    def loss(q: float) -> tuple[float, float]:
        """Of T_tr and T_rot per time, at T_tr = 1 and T_rot = q."""
        rates = theory.mixture_rates(needles, 1.0, q)
        return -float(rates.t_tr[0]), -float(rates.t_rot[0])

    # Where the losses are to each other as the gains: that of rotation grows with q.
    low, high = 1e-6, 1e6
    while high / low > 1 + 1e-12:
        q = np.sqrt(low * high)
        of_tr, of_rot = loss(q)
        low, high = (low, q) if of_rot * into_tr > of_tr * into_rot else (q, high)
    # Losses grow as T^(3/2).
    t_tr = ((into_tr + into_rot) / sum(loss(q))) ** (2 / 3)
    return t_tr, q * t_tr


def cumulant_of_spheres(epsilon: np.ndarray) -> np.ndarray:
    """The fourth cumulant of the velocities of smooth spheres with white noise, by van Noije and
    Ernst, Granular Matter 1, 57 (1998)."""
    return (16 * (1 - epsilon) * (1 - 2 * epsilon**2)
            / (241 - 177 * epsilon + 30 * epsilon**2 * (1 - epsilon)))


def measure_vibrated(runs: PaperRuns) -> Result:
    """The temperature of a layer on a vibrated floor against the velocity of the floor, and at a
    smaller amplitude."""
    result = Result(("amplitude", "epsilon", "velocity", "temperature", "error", "theory", "ratio",
                     "ratio_error", "vertical", "vertical_error"))
    points = runs.points("vibrated")
    for point in points + runs.points("vibrated-small"):
        gas, velocity = point.conditions, floor_velocity(point.conditions)
        amplitude, expected = _motion_of(gas)["amplitude"], vibrated_theory(gas)
        temperature = measure(point, _temperature)
        ratio = measure(point, lambda run: steady_mean(run, run.series.t_tr)
                        / steady_mean(run, run.series.t_rot))
        vertical = measure(point, lambda run: steady_mean(
            run, run.observable("temperature_by_axis", "t_tr")[:, 2])
            / steady_mean(run, run.series.t_tr))
        result.rows.append((amplitude, gas.epsilon, velocity, *temperature[:2], expected,
                            *ratio[:2], *vertical[:2]))
        result.add("vibrated-temperature", temperature.over(expected),
                   f"A = {amplitude:g}, epsilon = {gas.epsilon:g}, V = {velocity:.3g}")
    for epsilon in dict.fromkeys(point.conditions.epsilon for point in points):
        of_one = [point for point in points if point.conditions.epsilon == epsilon]
        velocities = np.log([floor_velocity(point.conditions) for point in of_one])
        by_seed = zip(*(np.log(point.values(_temperature)) for point in of_one))
        result.add("vibrated-exponent", mean_of([slope(velocities, np.array(of_seed))
                                                 for of_seed in by_seed]),
                   f"epsilon = {epsilon:g}")
    return result


def draw_vibrated(table: Table) -> Figure:
    """The temperature with its theory, and the ratio of the two."""
    figure, (temperatures, over) = style.panels("A vibrated layer in its steady state", 2,
                                                width=4.2, height=3.4)
    usual = table.amplitude.max()
    colours = dict(zip(dict.fromkeys(table.epsilon), style.COLOURS))
    for (amplitude, epsilon), part in parts(table, "amplitude", "epsilon"):
        look = {"color": colours[epsilon], "label": rf"$\epsilon = {epsilon:g}$"}
        if amplitude == usual:
            temperatures.plot(part.velocity, part.theory, color=look["color"])
            style.points(temperatures, part.velocity, part.temperature, part.error, **look)
        else:
            look |= {"mfc": "white", "label": rf"{look['label']}, $A = {amplitude:g}$"}
        style.points(over, part.velocity, part.temperature / part.theory,
                     part.error / part.theory, **look)
    over.axhline(1, color=style.COLOURS[5], linewidth=0.8)
    x = r"velocity of the floor, $V / (g L)^{1/2}$"
    style.label(temperatures, x, "$T / m g L$", f"$A = {usual:g}$, theory as lines", log="xy")
    style.label(over, x, "$T$ / theory", log="x")
    return figure


def _temperature(run: FinishedRun) -> float:
    """The mean energy of motion over that of a needle at T = 1, 5/2."""
    return steady_mean(run, (3 * run.series.t_tr + 2 * run.series.t_rot) / 5)


def floor_velocity(gas: Conditions) -> float:
    """The greatest velocity of the surface, 2 pi f A."""
    motion = _motion_of(gas)
    return 2 * np.pi * motion["frequency"] * motion["amplitude"]


def _motion_of(gas: Conditions) -> dict[str, float]:
    return gas.scene["walls"][0]["motion"]


def vibrated_theory(gas: Conditions) -> float:
    """The temperature at which collisions take what the floor gives, of an isothermal atmosphere of
    nearly elastic needles that are fast beside the floor, whose hits know nothing of each other."""
    gravity = -gas.scene["forces"]["gravity"][2]
    per_area = gas.count / (gas.box[0] * gas.box[1])
    low, high = 1e-3 * gravity, 1e6 * gravity
    while high / low > 1 + 1e-9:
        temperature = np.sqrt(low * high)
        atmosphere = Atmosphere(temperature, gravity)
        gains = (atmosphere.gain(gas.k, floor_velocity(gas))
                 > atmosphere.loss(gas.k, gas.epsilon, per_area))
        low, high = (temperature, high) if gains else (low, temperature)
    return temperature
