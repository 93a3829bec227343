"""A mechanism that is ready to be solved over and over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.kinematics.elimination import Elimination, Factors
from mbsd.kinematics.groups.blocks import Blocks
from mbsd.kinematics.groups.groups import Groups
from mbsd.kinematics.groups.plan import describe
from mbsd.results.views import Mobility


@dataclass
class Prepared:
    """A mechanism ready to be solved over and over: arrays, closed start pose, elimination sequence."""

    packed: Packed
    q0: np.ndarray
    """(3 nb,) closed start pose."""
    start_time: float
    sequence: Elimination
    factors: Factors
    mobility: Mobility
    groups: Groups | None
    """Where the mechanism falls apart into groups and blocks; else Newton-Raphson solves it as a whole."""
    blocks: Blocks
    """What of it no closed form covers."""
    proved: bool = False
    """Whether joints that repeat others are sure to hold where these do not."""

    @property
    def route(self) -> str:
        """How positions are found, as long as no two assemblies meet on the way."""
        if self.groups is None:
            return "Newton-Raphson"
        how = "by parts" if len(self.blocks.head) else "closed form"
        return f"{how}: {describe(self.groups, self.blocks, self.packed.body_names)}"
