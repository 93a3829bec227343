"""What a simulation looks at step by step: points on curves that cross themselves, and wheels that may meet.

It takes one step at a time, moves the parameters of the points' feet on, and divides a step in which a foot goes too
far (mbsd/arrays/curve_branches.py). Wheels: mbsd/kinematics/limits/free_wheels.py. The steps are those of
mbsd/dynamics/events/following.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.kinematics.limits.free_wheels import FreeWheels

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

SHORTEST = 1e-9
"""A step may be divided down to this part of itself."""


class Following(CurveBranches):
    """The rows of a packed mechanism whose curves cross themselves, and the wheels that no body carries."""

    def __init__(self, packed: Packed) -> None:
        super().__init__(packed)
        self.wheels = FreeWheels(packed)

    def __bool__(self) -> bool:
        return bool(self.rows or self.wheels)
