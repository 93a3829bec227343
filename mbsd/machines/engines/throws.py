"""Groups of cylinders that share a throw: their throws have one direction and one place along the shaft."""

from __future__ import annotations

import math

from mbsd.machines.engines.layout import Layout

SAME = 1e-6
"""Difference of two angles (rad) or places (spacings) that are the same."""


def throws(of: Layout) -> list[list[int]]:
    """Indices of the cylinders on each throw; pins that are split are throws of their own."""
    by_throw: dict[tuple[int, int], list[int]] = {}
    for k, cylinder in enumerate(of.cylinders):
        turned = round(math.remainder(cylinder.throw, 2 * math.pi) / SAME)
        by_throw.setdefault((turned, round(cylinder.z / SAME)), []).append(k)
    return list(by_throw.values())
