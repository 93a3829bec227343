"""Gears, belts and cables with free centres: where these run into each other no motion goes on.

The constraint holds the direction of the line of centres. Centres that move towards each other along it meet, where
the line has no direction; on the other side it points the other way, which the wheels do not allow. Such a motion goes
step by step, in steps that take the centres at most half their way to each other, and is refused where they meet.

A span of a cable ends where its wheels touch, and there its curvature grows without bound: while the cable is taut the
step size shrinks before that. A slack span is followed step by step, as the wheels of free gears are.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.arrays.reactions import marker_places, relative_velocity
from mbsd.base.errors import SimulationError
from mbsd.equations.relative.equation import AT, WRAPS
from mbsd.model.cables import signed_radii
from mbsd.model.joint import ContactKind
from mbsd.model.teeth import with_radii

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.joint import Joint

MET = 1e-3
"""Part of the radii together below which the centres have met."""
TOUCH = 1e-2
"""Wheels of a cable meet where their centres are nearer than this beyond the least distance, as a part of it."""
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
        self.near = [MET * (sized["radius_i"] + sized["radius_j"]) for sized in map(_sized, self.pairs)]
        """Distances of the centres of each pair below which they have met (m)."""
        self.spans = [
            (joint, place[0], place[1])
            for name, joint, place in zip(specials.names, specials.joints, specials.places, strict=True)
            if name == "span"
        ]
        slack = [span for span in self.spans if isinstance(span[0].kind, ContactKind)]
        self.pairs += slack
        self.near += [_straight_from(joint) for joint, _, _ in slack]

    def __bool__(self) -> bool:
        return bool(self.pairs)

    def refuse_met(self, time: float, q: np.ndarray) -> None:
        """Raise SimulationError where the centres of two wheels have met at a time (s) in the pose q (3 nb,)."""
        for joint, i, j in self.spans:
            apart, least = math.hypot(*self._line(q, i, j)), _straight_from(joint)
            if apart < least * (1.0 + TOUCH):
                raise SimulationError(
                    f"{self.packed.name}: the wheels of cable '{joint.name}' meet at t = {time:.6g} s: their centres "
                    f"are {apart:.4g} m apart, and a straight piece needs {least:.4g} m. Stop the bodies before, with "
                    "m.stop(...) or a shorter cable."
                )
        for (joint, i, j), near in zip(self.pairs, self.near, strict=True):
            apart = math.hypot(*self._line(q, i, j))
            if apart < near:
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


def _sized(pair: tuple[Joint, int, int]) -> Mapping[str, Any]:
    return with_radii(pair[0].params)


def _straight_from(joint: Joint) -> float:
    """Return the distance of the centres (m) from which on a span has a straight piece."""
    first, second = signed_radii(joint.params)
    return abs(second - first)
