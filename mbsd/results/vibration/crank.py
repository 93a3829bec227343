"""Crank of a motion: the body on a pin of ground that turns round and round, the engineers' clock.

A vector in the plane that swings harmonically: one part turns with the crank, one against it.

fx + i fy = forward e^(i k phi) + backward e^(-i k phi)        an ellipse; k its order, phi the crank's angle
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError

WHOLE = 1e-6
"""Turns: what misses a whole number by less is one."""


def crank_of(sol: Any) -> str:
    """Return the crank's name: of bodies that turn a whole turn one way, a driven one, else the first.

    ``sol`` is the Solution. Raises ModelError where none does.
    """
    m = sol.mechanism
    on_ground = [_moving(m, joint) for joint in m.joints.values() if joint.kind.pair == "pin" and _grounded(m, joint)]
    driven = [_moving(m, driver) for driver in m.drivers.values() if driver.kind.angular and _grounded(m, driver)]
    for name in (*driven, *on_ground):
        if _turns(sol.body(name).theta):
            return name
    turning = f"of {', '.join(on_ground)} none does" if on_ground else "nothing is on a pin of ground"
    raise ModelError(
        f"{m.name}: orders need a crank, a body on a pin of ground that turns one way by a whole turn; {turning}. "
        "Name a body that turns with crank=, or solve over a longer duration"
    )


def _grounded(m: Any, joint: Any) -> bool:
    return m.ground in (joint.i.body, joint.j.body) and joint.i.body is not joint.j.body


def _moving(m: Any, joint: Any) -> str:
    return (joint.j if joint.i.body is m.ground else joint.i).body.name


def _turns(angle: np.ndarray) -> bool:
    """Return True if an angle (T,) goes one way, by a turn at least."""
    steps = np.diff(angle)
    one_way = bool((steps >= 0).all() or (steps <= 0).all())
    return one_way and abs(angle[-1] - angle[0]) >= 2 * math.pi * (1 - WHOLE)


@dataclass(frozen=True, eq=False)
class Turning:
    """Both parts of harmonic vectors, (K,) complex: real part along x, imaginary part along y at phi = 0."""

    forward: np.ndarray
    """(K,) turns with the crank."""
    backward: np.ndarray
    """(K,) turns against the crank."""

    @property
    def largest(self) -> np.ndarray:
        """(K,) size where the vector is largest on the turn."""
        return np.abs(self.forward) + np.abs(self.backward)

    @property
    def smallest(self) -> np.ndarray:
        """(K,) size where the vector is smallest on the turn; 0 where it swings along a line."""
        return np.abs(np.abs(self.forward) - np.abs(self.backward))

    @property
    def along_x(self) -> np.ndarray:
        """(K,) amplitude of the component along x."""
        return np.abs(self.forward + self.backward.conj())

    @property
    def along_y(self) -> np.ndarray:
        """(K,) amplitude of the component along y."""
        return np.abs(self.forward - self.backward.conj())
