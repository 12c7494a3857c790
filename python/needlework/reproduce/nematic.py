"""Beyond the paper: the nematic order and the pressure of elastic rods."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .course import measure
from .driving import steady_mean
from .figure import Result
from .rods import diameter_of
from .runs import FinishedRun, PaperRuns


def measure_nematic(runs: PaperRuns) -> Result:
    """The nematic order and the pressure of elastic rods of L/D = 5 against their packing fraction,
    from a start in full order."""
    result = Result(("packing", "order", "order_error", "order_random", "pressure",
                     "pressure_error", "seeds"))
    for point in runs.points("nematic"):
        gas, diameter = point.conditions, diameter_of(point.conditions)
        volume = np.pi * diameter**2 / 4 + np.pi * diameter**3 / 6
        packing = gas.density * volume
        order = measure(point, _order)
        pressure = measure(point, lambda run: _excess(run) + 1).over(1 / packing)
        # Of N random directors the largest eigenvalue is not 0; this is its mean to a few percent.
        random = 1.1 / np.sqrt(gas.count)
        result.rows.append((packing, *order[:2], random, *pressure[:2], point.seeds))
        variant = f"packing fraction {packing:.3g}"
        result.add("nematic-order", order, variant)
        if abs(packing - 0.31) < 2e-3:
            result.add("rods-pressure-isotropic", pressure, variant)
        if abs(packing - 0.352) < 2e-3:
            result.add("rods-pressure-denser", pressure, variant)
    return result


def draw_nematic(table: Table) -> Figure:
    """The order parameter and the pressure against the packing fraction."""
    figure, (order, pressure) = style.panels("Elastic rods of $L/D = 5$", 2, width=4.0)
    style.points(order, table.packing, table.order, table.order_error,
                 label="from a start in order")
    order.plot(table.packing, table.order_random, color=style.COLOURS[5], linestyle="--",
               label="random directors")
    order.axvline(0.40, color=style.COLOURS[3], linewidth=1.0,
                  label="isotropic up to here, McGrother et al.")
    style.label(order, r"packing fraction $\eta$", "nematic order $S$")
    style.points(pressure, table.packing, table.pressure, table.pressure_error, label="collisions")
    pressure.plot([0.310, 0.352], [2.53, 3.63], "x", color=style.COLOURS[1],
                  label="McGrother et al.")
    style.label(pressure, r"packing fraction $\eta$", "$p v / T$")
    return figure


def _order(run: FinishedRun) -> float:
    """The largest eigenvalue of the order tensor, its mean in the steady state."""
    tensors = run.observable("alignment", "order_tensor")
    return steady_mean(run, np.linalg.eigvalsh(tensors)[:, -1])


def _excess(run: FinishedRun) -> float:
    """Z - 1 = sum of r12 . dp / (3 N T t) over the steady state, T = 2 E / (5 N - 3)."""
    series, count = run.series, run.conditions.count
    temperature = 2 * series.energy[0] * count / (5 * count - 3)
    virial = run.observable("rods", "virial")
    first = int(np.argmax(series.time >= series.time[-1] / 3))
    time = series.time[-1] - series.time[first]
    return float((virial[-1] - virial[first]) / (3 * count * temperature * time))
