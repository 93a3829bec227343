"""Dimensions as columns of deviations: a size by one number, a pin by its position in the bore.

A pin may also have one number, half of its play.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from mbsd.tolerancing.dimensions.clearance import Clearance
from mbsd.tolerancing.dimensions.spreads import Spread

Kind = Literal["length", "place", "argument", "part", "number", "reaction", "bore"]


class Column(NamedTuple):
    """A number of the machine, whose deviation (m or its own unit) is a column of what is evaluated."""

    kind: Kind
    """Length of a bar or rod, coordinate of a place, argument of change(), a number of a law or whatever else
    numbers/names.py names, argument of a function, half of a play along a reaction, coordinate of a pin in its bore."""
    name: str
    key: str = ""
    """Name of the argument, or "x" or "y"."""
    nominal: float = 0.0


@dataclass(frozen=True)
class Dimension:
    """One of them."""

    label: str
    columns: tuple[Column, ...]
    nominal: float
    """Its size, or a pin's play."""

    draws: int = 1
    """Numbers between 0 and 1 that it is drawn from."""

    @property
    def limits(self) -> tuple[float, float]:
        """Lower and upper deviation from the nominal size, or least and largest play."""
        raise NotImplementedError

    @property
    def middle(self) -> np.ndarray:
        """(columns,) about which derivatives are taken."""
        raise NotImplementedError

    @property
    def step(self) -> float:
        """By how much each column is changed for a difference."""
        raise NotImplementedError

    @property
    def per_unit(self) -> float:
        """Columns of a unit of its limits: half of a play is one of its columns."""
        return 1.0

    def draw(self, u: np.ndarray) -> np.ndarray:
        """(n, columns) deviations from (n, draws) numbers between 0 and 1."""
        raise NotImplementedError

    def variance(self, slopes: np.ndarray) -> float:
        """Return what it adds to the variance of a linear result with slopes (columns,)."""
        raise NotImplementedError

    def swing(self, slopes: np.ndarray) -> float:
        """How far it moves a linear result to either side of that in the middle."""
        raise NotImplementedError

    def farthest(self, slopes: np.ndarray, sign: float) -> np.ndarray:
        """(columns,) where a linear result is largest (``sign`` 1) or least (-1)."""
        raise NotImplementedError

    def halved(self, x: np.ndarray) -> np.ndarray:
        """(n, columns) with half the tolerance, or half the play."""
        return self.middle + 0.5 * (x - self.middle)


@dataclass(frozen=True)
class Size(Dimension):
    """A length, a coordinate, a mass, a stiffness."""

    spread: Spread = Spread(1.0)
    least_step: float = 0.0
    """Step below which a difference of results is rounding."""

    @property
    def limits(self) -> tuple[float, float]:
        """Lower and upper deviation."""
        return self.spread.limits

    @property
    def middle(self) -> np.ndarray:
        """(1,) of the tolerance."""
        return np.array([self.spread.middle])

    @property
    def step(self) -> float:
        """A standard deviation, or what makes a difference of results where that is less."""
        return max(self.spread.sigma, self.least_step)

    def draw(self, u: np.ndarray) -> np.ndarray:
        """(n, 1) deviations."""
        return self.spread.deviations(u)

    def variance(self, slopes: np.ndarray) -> float:
        """Squares of standard deviations add up."""
        return float((slopes[0] * self.spread.sigma) ** 2)

    def swing(self, slopes: np.ndarray) -> float:
        """Half of the tolerance."""
        return abs(float(slopes[0])) * self.spread.half

    def farthest(self, slopes: np.ndarray, sign: float) -> np.ndarray:
        """(1,) one of the limits."""
        return self.middle + math.copysign(self.spread.half, sign * slopes[0])


@dataclass(frozen=True)
class Play(Dimension):
    """A pin with play.

    Columns are halves of the play: one along the reaction, or two coordinates in the bore.
    """

    clearance: Clearance = Clearance(1.0)

    @property
    def limits(self) -> tuple[float, float]:
        """Least and largest play."""
        return self.clearance.limits

    @property
    def per_unit(self) -> float:
        """Half of the play is the column."""
        return 0.5

    @property
    def _sigma(self) -> float:
        sizes = self.clearance.sizes
        return 0.5 * sizes.sigma if sizes else 0.0

    def _sizes(self, u: np.ndarray) -> np.ndarray:
        """Halves of the play."""
        sizes = self.clearance.sizes
        play = self.clearance.play + (sizes.deviations(u) if sizes else 0.0 * u)
        return 0.5 * np.maximum(play, 0.0)

    def halved(self, x: np.ndarray) -> np.ndarray:
        """(n, columns) with half the play."""
        return 0.5 * x


@dataclass(frozen=True)
class PushedPlay(Play):
    """Its pin lies where the reaction pushes it."""

    @property
    def middle(self) -> np.ndarray:
        """(1,) half of the nominal play."""
        return np.array([0.5 * self.clearance.play])

    @property
    def step(self) -> float:
        """A part of the play."""
        return 0.25 * self.clearance.play

    def draw(self, u: np.ndarray) -> np.ndarray:
        """(n, 1) halves of the play."""
        return self._sizes(u)

    def variance(self, slopes: np.ndarray) -> float:
        """Return what the size of the play alone adds."""
        return float((slopes[0] * self._sigma) ** 2)

    def swing(self, slopes: np.ndarray) -> float:
        """By the tolerance of the play."""
        return abs(float(slopes[0])) * 0.5 * self.clearance.tolerance

    def farthest(self, slopes: np.ndarray, sign: float) -> np.ndarray:
        """(1,) half of the least or the largest play."""
        return self.middle + math.copysign(0.5 * self.clearance.tolerance, sign * slopes[0])


@dataclass(frozen=True)
class LoosePlay(Play):
    """Its pin lies anywhere at the bore."""

    draws: int = 2

    @property
    def middle(self) -> np.ndarray:
        """(2,) the bore's centre."""
        return np.zeros(2)

    @property
    def step(self) -> float:
        """Half of the play."""
        return 0.5 * self.clearance.play

    def draw(self, u: np.ndarray) -> np.ndarray:
        """(n, 2) places about the bore's centre: half the play away, in any direction."""
        angle = 2.0 * np.pi * u[:, 1]
        return self._sizes(u[:, :1]) * np.column_stack([np.cos(angle), np.sin(angle)])

    def variance(self, slopes: np.ndarray) -> float:
        """The mean of (c g cos a)^2 over all directions a is c^2 g^2 / 2."""
        return float(0.5 * (slopes @ slopes) * (0.25 * self.clearance.play**2 + self._sigma**2))

    def swing(self, slopes: np.ndarray) -> float:
        """The largest play along the gradient."""
        return float(np.hypot(*slopes)) * 0.5 * self.limits[1]

    def farthest(self, slopes: np.ndarray, sign: float) -> np.ndarray:
        """(2,) on the circle of the largest play, along the gradient."""
        size = float(np.hypot(*slopes))
        along = slopes / size if size > 0.0 else np.array([1.0, 0.0])
        return sign * 0.5 * self.limits[1] * along
