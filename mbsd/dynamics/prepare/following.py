"""What a simulation looks at step by step: points on curves that cross themselves, and wheels that may meet.

It takes one step at a time, moves the parameters of the points' feet on, and divides a step in which a foot goes too
far (mbsd/arrays/curve_branches.py). Wheels: mbsd/kinematics/limits/free_wheels.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.dynamics.state import ACCEPTED, PAUSED, REACHED, TIME, State, copied
from mbsd.kinematics.limits.free_wheels import FreeWheels

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

SHORTEST = 1e-9
"""A step may be divided down to this part of itself."""
AHEAD = 2.0
"""Last steps within which wheels that meet are why another one fails."""


class Following(CurveBranches):
    """The rows of a packed mechanism whose curves cross themselves, and the wheels that no body carries."""

    def __init__(self, packed: Packed) -> None:
        super().__init__(packed)
        self.wheels = FreeWheels(packed)

    def __bool__(self) -> bool:
        return bool(self.rows or self.wheels)

    def through(self, advance: Callable[..., int], arrays: Any, scratch: Any, state: State, *rest: Any) -> int:
        """``advance`` of an Integrator, a step at a time, with the branches followed."""
        out, settings, end, steps = rest
        last = 0.0
        while True:
            before, target = copied(state), end
            while True:
                status = advance(arrays, scratch, state, out, settings, target, 1)
                if status not in (REACHED, PAUSED):
                    self.wheels.refuse_meeting(float(before.clock[TIME]), before.y, AHEAD * last)
                    return status
                feet, farthest = self.moved(state.y[0])
                taken = float(state.clock[TIME] - before.clock[TIME])
                farthest = max(farthest, self.wheels.approach(before.y, state.y, taken))
                if farthest <= 1.0 or taken <= SHORTEST * settings.longest:
                    last = taken
                    break
                for part, source in zip(state, before, strict=True):
                    part[...] = source
                target = float(before.clock[TIME]) + taken / (2.0 * farthest)
            self.accept(feet)
            self.wheels.refuse_met(float(state.clock[TIME]), state.y[0])
            steps -= int(state.count[ACCEPTED] - before.count[ACCEPTED])
            if state.clock[TIME] >= end:
                return REACHED
            if steps <= 0:
                return PAUSED
