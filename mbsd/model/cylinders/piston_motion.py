"""How far a crank lets a piston down from its top dead centre.

    s(b) = r cos b - sqrt(l^2 - (r sin b - e)^2)      from the crank's axis, x from the head towards the crank
    below = s(b_t + phi) - s(b_t)                     b_t = atan2(e, s_t),  s_t = -sqrt((l + r)^2 - e^2)

b is the angle of the throw against the cylinder's axis, phi that of the crank since the top dead centre, r the throw, l
the rod, e how far the cylinder's line lies beside the crank's axis (to the left of x). Without a rod the crank pin runs
in a slot across the piston (Scotch yoke): below = r (1 - cos phi).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

LOOKS, HALVINGS = 361, 50
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
    grid = np.linspace(0.0, 2.0 * math.pi, LOOKS)
    k = int(motion.below(grid).argmax())
    low, high = float(grid[k - 1]), float(grid[k + 1])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if motion.slope(np.array([middle]))[0] > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
