"""Density and flow of a run in the cells of its grid at one sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .runs import FinishedRun

DENSE_EXCESS = 0.5
"""A cell is dense above 1.5 times the mean density."""


@dataclass
class CellFields:
    """What the cells hold, indexed by their places along x, y and z."""

    excess: np.ndarray
    """Density over its mean, less 1, [X, Y, Z]."""
    flow: np.ndarray
    """Mean velocities, [X, Y, Z, 3] [L / time]."""
    box: np.ndarray
    """Edges of the box, [3] [L]."""
    collisions: float = 0.0
    """Per needle, at the sample."""
    t_tr: float = 1.0
    """Translational temperature of the whole gas."""

    @property
    def dense(self) -> np.ndarray:
        """Which cells are dense, [X, Y, Z]."""
        return self.excess > DENSE_EXCESS

    def middles(self, axis: int) -> np.ndarray:
        """The middles of the cells along an axis [L]."""
        cells = self.excess.shape[axis]
        return (np.arange(cells) + 0.5) * self.box[axis] / cells


def fields_near(run: FinishedRun, *collisions: float) -> list[CellFields]:
    """The fields at the samples nearest to so many collisions per needle."""
    density, flow = run.observable("fields", "density"), run.observable("fields", "flow")
    return [CellFields(density[sample] / density[sample].mean() - 1, flow[sample],
                       run.conditions.box, float(run.collisions[sample]),
                       float(run.series.t_tr[sample]))
            for sample in map(run.sample_near, collisions)]


@dataclass
class ShearWave:
    """A wave of the mean flow of slabs across an axis, normal to that axis."""

    gradient: int
    """The axis along which the flow changes."""
    along: int
    """The component of the flow that changes."""
    number: int
    """Waves in the box; each is two bands."""
    share: float
    """Of the energy of the flow."""


def strongest_shear_wave(fields: CellFields) -> ShearWave:
    """The shear wave with the most energy."""
    total = np.mean(np.sum(fields.flow**2, axis=-1))
    waves = []
    for gradient in range(3):
        others = tuple(axis for axis in range(3) if axis != gradient)
        slabs = fields.flow.mean(axis=others)
        amplitudes = np.fft.rfft(slabs, axis=0) / len(slabs)
        for along in others:
            energies = 2 * np.abs(amplitudes[:, along])**2  # of two waves, n and -n
            if len(slabs) % 2 == 0:
                energies[-1] /= 2  # but for the shortest one
            number = 1 + int(np.argmax(energies[1:]))
            waves.append(ShearWave(gradient, along, number, float(energies[number] / total)))
    return max(waves, key=lambda wave: wave.share)


def density_flow_correlation(fields: CellFields) -> float:
    """Correlation coefficient over the cells of the density and the energy of the flow, U^2."""
    energy = np.sum(fields.flow**2, axis=-1)
    return float(np.corrcoef(fields.excess.ravel(), energy.ravel())[0, 1])


def places_in_cells(position: np.ndarray, box: np.ndarray,
                    cells: tuple[int, int, int]) -> np.ndarray:
    """The number of the cell of each needle, [N], the last axis fastest. Positions may lie on
    the upper edge of the box."""
    place = np.clip((position / box * cells).astype(int), 0, np.array(cells) - 1)
    return np.ravel_multi_index(tuple(place.T), cells)


def flow_in_cells(place: np.ndarray, velocity: np.ndarray,
                  size: int) -> tuple[np.ndarray, np.ndarray]:
    """The mean velocities of the needles of each of so many cells, [3, C], 0 in empty ones, and
    the numbers of these needles, [C]."""
    count = np.bincount(place, minlength=size)
    sums = np.stack([np.bincount(place, velocity[:, axis], size) for axis in range(3)])
    return np.divide(sums, count, out=np.zeros_like(sums), where=count > 0), count


def flow_order(position: np.ndarray, velocity: np.ndarray, box: np.ndarray,
               cells: tuple[int, int, int]) -> float:
    """The order of the flow S: the energy of the mean velocities of cells over that of the
    velocities relative to them."""
    place = places_in_cells(position, box, cells)
    flow, count = flow_in_cells(place, velocity, int(np.prod(cells)))
    thermal = velocity - flow[:, place].T
    return float(np.sum(count * flow**2) / np.sum(thermal**2))
