"""What is exact of needles between walls and above a floor, for L = m = 1.

Needles have no volume: in elastic equilibrium each is where its weight alone lets it be, with any
director at which both tips are inside. From that follow the rates of collisions between needles and
with walls, at every density.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .. import theory

LAYER = 0.5
"""Distance from a wall within which not all directors have room, L/2."""


def points(low: float, high: float, count: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of an integral from low to high, by Gauss and Legendre."""
    x, weights = np.polynomial.legendre.leggauss(count)
    return low + (high - low) * (x + 1) / 2, weights * (high - low) / 2


class Contacts(NamedTuple):
    """Contacts of two needles by their rate in an isotropic gas, arrays that broadcast."""

    share: np.ndarray
    """Of the rate; the sum is 1."""
    room: np.ndarray
    """How far from a wall the contact is at least: there a tip touches the wall."""
    lift: np.ndarray
    """How much higher than two contacts both centres are together."""


@lru_cache
def contacts(k: float) -> Contacts:
    """Of needles of one k."""
    arms, arm_weights = points(-0.5, 0.5, 6)
    heights, height_weights = points(0, 1, 20)
    angles, angle_weights = points(0, np.pi, 40)
    x, y, a, b, angle = np.meshgrid(arms, arms, heights, heights, angles, indexing="ij",
                                    sparse=True)
    # Directors of both signs of u_z have cosines of both signs, which the angle goes through.
    cosine = a * b + np.sqrt((1 - a**2) * (1 - b**2)) * np.cos(angle)
    rate = np.einsum("i,j,k,l,m->ijklm", arm_weights, arm_weights, height_weights, height_weights,
                     angle_weights)
    rate *= np.sqrt(1 - cosine**2) * np.sqrt(1 + k * (x**2 + y**2))
    rate = np.sum(rate, axis=4)[..., None]
    return Contacts(rate / rate.sum(), np.maximum((0.5 + x) * a, (0.5 + y) * b), -(x * a + y * b))


class WallRates(NamedTuple):
    """Of elastic needles at T = 1 between two walls."""

    hits: float
    """Of each needle on one wall per time."""
    force: float
    """On one wall."""
    collisions: float
    """Of each needle with others per time."""


def between_walls(k: float, count: int, area: float, distance: float) -> WallRates:
    """For edges of at least 2 L."""
    u, weights = points(0, 1)
    room = distance - LAYER
    hits = weights @ np.sqrt(1 + k / 2 * (1 - u**2)) / np.sqrt(2 * np.pi) / room
    density = (count - 1) / (area * room)
    lost = 2 * np.sum(contacts(k).share * contacts(k).room)
    return WallRates(float(hits), count / room,
                     float(theory.collision_rate(k, density) * (distance - lost) / room))


class Atmosphere:
    """Needles above a floor without a ceiling, at one temperature."""

    def __init__(self, temperature: float, gravity: float = 1.0) -> None:
        self.temperature = temperature
        self.scale = gravity / temperature
        """Inverse height of the atmosphere, m g / T."""
        self._norm = 2 * (1 - np.exp(-self.scale / 2)) / self.scale**2

    def density(self, z: np.ndarray) -> np.ndarray:
        """The probability density of a centre."""
        return np.exp(-self.scale * z) * np.minimum(1, z / LAYER) / self._norm

    @staticmethod
    def order(z: np.ndarray) -> np.ndarray:
        """Mean of (3 u_z^2 - 1) / 2."""
        return np.where(z < LAYER, ((z / LAYER) ** 2 - 1) / 2, 0)

    @property
    def share_at_floor(self) -> float:
        """The share of the centres nearer to the floor than L/2."""
        half = np.exp(-self.scale / 2)
        return float((1 - half * (1 + self.scale / 2)) / (1 - half))

    @property
    def mean_height(self) -> float:
        """Of a centre."""
        return float(2 / self.scale - 0.5 / np.expm1(self.scale / 2))

    @property
    def energy(self) -> float:
        """Of a needle, with that of its weight."""
        return self.temperature * (2.5 + self.scale * self.mean_height)

    def loss(self, k: float, epsilon: float, per_area: float) -> float:
        """What collisions take of each needle per time, with so many needles per area: each takes
        (1 - epsilon^2) T in the mean, whatever its contact."""
        shares, room, lift = contacts(k)
        squared = float(np.sum(shares * np.exp(-self.scale * (lift + 2 * room)))
                        / (2 * self.scale) / self._norm**2)
        rate = float(theory.collision_rate(k, 1.0, self.temperature, self.temperature))
        return rate / 2 * per_area * squared * (1 - epsilon**2) * self.temperature

    def gain(self, k: float, velocity: float) -> float:
        """What an elastic floor gives each needle per time that vibrates by little, with a velocity
        of this amplitude, which is small beside that of needles: 2 M <U^2> |v| for each hit, M the
        mass that the tip has and v its velocity."""
        u, weights = points(0, 1)
        mass = 1 / (1 + k / 2 * (1 - u**2))
        flux = weights @ (np.sqrt(mass) * np.exp(-self.scale * u / 2)) / self._norm
        return float(2 * velocity**2 * np.sqrt(self.temperature / (2 * np.pi)) * flux)
