"""Sweeps in which a point may have left the branch of a curve that crosses itself.

A sweep predicts so well that the nearest foot is on the right branch; it is refused where a foot jumps nevertheless.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.base.errors import BranchError
from mbsd.equations.relative.curve_pieces import CLOSED, FARTHEST, SPAN
from mbsd.equations.system import LAST

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


def refuse_jumps(packed: Packed, times: np.ndarray, q: np.ndarray) -> None:
    """Raise BranchError where a point leaves the branch of its curve between poses q (T, 3 nb) of a sweep."""
    following = CurveBranches(packed)
    if not following.rows:
        return
    for k, pose in enumerate(q):
        before = [float(row.own[LAST]) for row in following.rows]
        following.accept([math.nan] * len(before))
        feet, _ = following.moved(pose)
        following.accept(before)
        if k:
            for (i, j, numbers, own), u in zip(following.rows, feet, strict=True):
                way = abs(u - own[LAST])
                way = min(way, abs(numbers[SPAN] - way)) if numbers[CLOSED] else way
                if way > numbers[FARTHEST]:
                    name = next(
                        joint.name
                        for joint, place in zip(packed.specials.joints, packed.specials.places, strict=True)
                        if place[:2] == (i, j)
                    )
                    raise BranchError(
                        f"{packed.name}: joint '{name}': its curve crosses itself. Between t = {times[k - 1]:.6g} and "
                        f"{times[k]:.6g} s the point goes {way:.3g} m along it, more than {numbers[FARTHEST]:.3g} m: "
                        "it may be on the other branch. Take more steps; if that does not help, simulate the motion."
                    )
        following.accept(feet)
    following.accept([math.nan] * len(following.rows))
