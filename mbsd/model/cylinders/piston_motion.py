"""Travel of a piston from its top dead centre, by a crank and a rod or by a rod on a master rod.

By a crank and a rod of its own:

    s(b) = r cos b - sqrt(l^2 - (r sin b - e)^2)      from the crank's axis, x from the head towards the crank
    below = s(b_t + phi) - s(b_t)                     b_t = atan2(e, s_t),  s_t = -sqrt((l + r)^2 - e^2)

b is the angle of the throw against the cylinder's axis, phi that of the crank since the top dead centre, r the throw, l
the rod, e how far the cylinder's line lies beside the crank's axis (to the left of x). Without a rod the crank pin runs
in a slot across the piston (Scotch yoke): below = r (1 - cos phi).

By a rod that hangs on the master rod of another piston, as in radial engines:

    W = (s, e),  s = r cos b - sqrt(l^2 - (r sin b - e)^2)         the master's wrist pin;  P = r (cos b, sin b)
    K = P + k_1 d + k_2 d_perp,   d = (W - P) / l                  the knuckle pin on the master rod
    s_2 = K_1 - sqrt(l_2^2 - (K_2 - e_2)^2)                        K in the axes of the own cylinder, turned by bank
    below = s_2(b_t + phi) - s_2(b_t)                              b_t: where s_2 is the least

Axes have their origin on the crank's axis, x from the head of the master's cylinder towards the crank.
Source: Biezeno, Grammel, Technische Dynamik, ch. XII (articulated rods).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np

PISTON_MOTION_LOOKS, PISTON_MOTION_HALVINGS = 361, 50
"""Angles at which the lowest place is looked for, and halvings between two of them."""


@dataclass(frozen=True)
class PistonMotion:
    """A crank, a rod and a piston; m, ``sense`` -1 for a crank that turns clockwise."""

    throw: float
    rod: float = math.inf
    """Infinite: a Scotch yoke."""
    offset: float = 0.0
    sense: float = 1.0

    @property
    def stroke(self) -> float:
        """Between the dead centres (m)."""
        if math.isinf(self.rod):
            return 2.0 * self.throw
        return self._reach(self.rod + self.throw) - self._reach(self.rod - self.throw)

    @property
    def top(self) -> float:
        """Angle of the throw against the cylinder's axis at the top dead centre (rad)."""
        return math.pi if math.isinf(self.rod) else math.atan2(self.offset, -self._reach(self.rod + self.throw))

    @property
    def reach(self) -> float:
        """How far the wrist pin is from the crank's axis along the cylinder at the top dead centre (m)."""
        return self.throw if math.isinf(self.rod) else self._reach(self.rod + self.throw)

    @property
    def turns(self) -> bool:
        """True if the rod lets the crank go round."""
        return self.rod - self.throw > abs(self.offset)

    def below(self, phi: np.ndarray) -> np.ndarray:
        """(T,) way from the top dead centre (m) at angles phi (rad) of the crank since then."""
        if math.isinf(self.rod):
            return self.throw * (1.0 - np.cos(phi))
        angle = self.top + self.sense * phi
        side = self.throw * np.sin(angle) - self.offset
        return self.throw * np.cos(angle) - np.sqrt(self.rod**2 - side**2) + self._reach(self.rod + self.throw)

    def slope(self, phi: np.ndarray) -> np.ndarray:
        """(T,) derivative of ``below`` by phi (m/rad)."""
        if math.isinf(self.rod):
            return self.throw * np.sin(phi)
        angle = self.top + self.sense * phi
        side = self.throw * np.sin(angle) - self.offset
        turned = -np.sin(angle) + side * np.cos(angle) / np.sqrt(self.rod**2 - side**2)
        return self.sense * self.throw * turned

    def _reach(self, length: float) -> float:
        return math.sqrt(length**2 - self.offset**2)


class Moves(Protocol):
    """How a piston moves with its crank, whatever is between them."""

    def below(self, phi: np.ndarray) -> np.ndarray:
        """(T,) distance from the top dead centre (m) at angles phi (T,) (rad) of the crank since then."""
        ...

    def slope(self, phi: np.ndarray) -> np.ndarray:
        """(T,) derivative of ``below`` by phi (m/rad)."""
        ...


def lowest(motion: Moves) -> float:
    """Return the crank angle after top dead centre at which the piston is farthest (rad), 0 .. 2 pi."""
    grid = np.linspace(0.0, 2.0 * math.pi, PISTON_MOTION_LOOKS)
    k = int(motion.below(grid).argmax())
    low, high = float(grid[k - 1]), float(grid[k + 1])
    for _ in range(PISTON_MOTION_HALVINGS):
        middle = 0.5 * (low + high)
        if motion.slope(np.array([middle]))[0] > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


ARTICULATED_MOTION_LOOKS = 720
"""Angles of a turn that are looked at for the dead centres."""
ARTICULATED_MOTION_HALVINGS = 60


@dataclass(frozen=True)
class ArticulatedMotion:
    """Crank, master rod, a rod on it and a piston; m and rad, ``sense`` -1 for a clockwise crank."""

    throw: float
    master: float
    master_offset: float
    knuckle: tuple[float, float]
    """Coordinates from the crank pin, along the master rod and to its left."""
    bank: float
    """Angle of the own cylinder's axis against the master's."""
    rod: float
    offset: float
    sense: float = 1.0

    @property
    def turns(self) -> bool:
        """True if both rods let the crank go round."""
        if not self.master - self.throw > abs(self.master_offset):
            return False
        side = self._knuckles(_turn())[1][:, 1] - self.offset
        return bool(np.abs(side).max() < self.rod)

    @property
    def top(self) -> float:
        """Angle of the throw against the master's axis at the top dead centre (rad)."""
        return _dead_centres(self)[0]

    @property
    def reach(self) -> float:
        """How far the wrist pin is from the crank's axis along the cylinder at the top dead centre (m)."""
        return -float(self._way(np.array([self.top]))[0])

    @property
    def stroke(self) -> float:
        """Between the dead centres (m)."""
        top, bottom = self._way(np.array(_dead_centres(self)))
        return float(bottom - top)

    def below(self, phi: np.ndarray) -> np.ndarray:
        """(T,) way from the top dead centre (m) at angles phi (rad) of the crank since then."""
        phi = np.asarray(phi, float)
        return (self._way((self.top + self.sense * phi).ravel()) + self.reach).reshape(phi.shape)

    def slope(self, phi: np.ndarray) -> np.ndarray:
        """(T,) derivative of ``below`` by phi (m/rad)."""
        phi = np.asarray(phi, float)
        return self.sense * self._rate((self.top + self.sense * phi).ravel()).reshape(phi.shape)

    def _knuckles(self, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(T, 2) derivatives by b, and places, in the axes of the own cylinder."""
        sine, cosine = np.sin(b), np.cos(b)
        side = self.throw * sine - self.master_offset
        long = np.sqrt(self.master**2 - side**2)
        pin, pin_rate = self.throw * np.stack([cosine, sine], axis=1), self.throw * np.stack([-sine, cosine], axis=1)
        along = np.stack([-long, -side], axis=1) / self.master
        along_rate = np.stack([side * self.throw * cosine / long, -self.throw * cosine], axis=1) / self.master
        place = pin + self.knuckle[0] * along + self.knuckle[1] * _left(along)
        rate = pin_rate + self.knuckle[0] * along_rate + self.knuckle[1] * _left(along_rate)
        c, s = math.cos(self.bank), math.sin(self.bank)
        turned = np.array([[c, -s], [s, c]])
        return rate @ turned, place @ turned

    def _way(self, b: np.ndarray) -> np.ndarray:
        place = self._knuckles(b)[1]
        return place[:, 0] - np.sqrt(self.rod**2 - (place[:, 1] - self.offset) ** 2)

    def _rate(self, b: np.ndarray) -> np.ndarray:
        rate, place = self._knuckles(b)
        side = place[:, 1] - self.offset
        return rate[:, 0] + side * rate[:, 1] / np.sqrt(self.rod**2 - side**2)


def _left(vectors: np.ndarray) -> np.ndarray:
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def _turn() -> np.ndarray:
    return 2.0 * math.pi / ARTICULATED_MOTION_LOOKS * np.arange(ARTICULATED_MOTION_LOOKS)


@lru_cache(maxsize=128)
def _dead_centres(motion: ArticulatedMotion) -> tuple[float, float]:
    """Angles of the throw at the top and at the bottom, where the rate of the way is zero."""
    way = motion._way(_turn())
    turning_points = []
    for k, sign in ((int(way.argmin()), 1.0), (int(way.argmax()), -1.0)):
        low, high = (2.0 * math.pi / ARTICULATED_MOTION_LOOKS * (k + side) for side in (-1, 1))
        for _ in range(ARTICULATED_MOTION_HALVINGS):
            middle = 0.5 * (low + high)
            rising = sign * float(motion._rate(np.array([middle]))[0]) > 0.0
            low, high = (low, middle) if rising else (middle, high)
        turning_points.append(0.5 * (low + high))
    return turning_points[0], turning_points[1]
