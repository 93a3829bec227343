"""Gears and belts with free centres: where these run into each other no motion goes on.

The constraint holds the direction of the line of centres. Centres that move towards each other along it meet, where
the line has no direction; on the other side it points the other way, which the wheels do not allow. Such a motion goes
step by step, in steps that take the centres at most half their way to each other, and is refused where they meet.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.reactions import marker_places, relative_velocity
from mbsd.base.errors import SimulationError
from mbsd.equations.relative.equation import AT, WRAPS
from mbsd.model.teeth import with_radii

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.joint import Joint

MET = 1e-3
"""Part of the radii together below which the centres have met."""
HALF = 0.5
"""Fraction of the way to each other: what a step may take."""


class FreeWheels:
    """The pairs of wheels of a packed mechanism that no body carries both."""

    def __init__(self, packed: Packed) -> None:
        system, specials, self.packed = packed.system, packed.specials, packed
        self.pairs = [
            (joint, place[0], place[1])
            for k, (name, joint, place) in enumerate(zip(specials.names, specials.joints, specials.places, strict=True))
            if name == "gear" and system.numbers[int(system.special[k, AT]) + WRAPS] != 0.0
        ]

    def __bool__(self) -> bool:
        return bool(self.pairs)

    def refuse_met(self, time: float, q: np.ndarray) -> None:
        """Raise SimulationError where the centres of two wheels have met at a time (s) in the pose q (3 nb,)."""
        for joint, i, j in self.pairs:
            apart, sized = math.hypot(*self._line(q, i, j)), with_radii(joint.params)
            if apart < MET * (sized["radius_i"] + sized["radius_j"]):
                raise self._met(joint, time, apart)

    def refuse_meeting(self, time: float, state: np.ndarray, h: float) -> None:
        """Raise SimulationError if centres meet within h (s) of a state (2, 3 nb), at their speed.

        It serves methods whose equations of a step have no solution there.
        """
        for joint, i, j in self.pairs:
            line = self._line(state[0], i, j)
            apart, nearer = math.hypot(*line), -float(line @ self._rate(state, i, j))
            if nearer * h > apart * apart:
                raise self._met(joint, time + apart * apart / nearer, apart)

    def _met(self, joint: Joint, time: float, apart: float) -> SimulationError:
        return SimulationError(
            f"{self.packed.name}: the centres of {joint.kind.name} '{joint.name}' meet at t = {time:.6g} s: "
            f"they are {apart:.2g} m apart, and their line is about to have no direction. Hold them apart, "
            "with pins on a common body or m.distance(...)."
        )

    def _rate(self, state: np.ndarray, i: int, j: int) -> np.ndarray:
        """Return how the line of centres changes (m/s)."""
        ends = (relative_velocity(self.packed, state[:1], state[1:], None, k)[0] for k in (j, i))
        return next(ends) - next(ends)

    def _line(self, q: np.ndarray, i: int, j: int) -> np.ndarray:
        return (marker_places(self.packed, q[None], j) - marker_places(self.packed, q[None], i))[0]
