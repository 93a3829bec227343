"""Contact of a point, or a disc around it, with a terrain: a smooth curve through points, with matter on its right.

    g = n . (p_j - c(u)) - r        constraint `curve`; c(u): the curve's point nearest to p_j
    s = arc + r (a - beta)          constraint `curve_rolling`; arc length and tangent angle beta at c(u)

N pushes marker j to the left of the curve. Beyond its ends an open curve goes on straight. A disc touches where the
curve is nearest to its centre, at one point; the model refuses discs that bends of the curve are too tight for.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mbsd.model.contacts.kind import ContactKind, register

if TYPE_CHECKING:
    import numpy as np


def _numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    from mbsd.model.plane_curves import disc_numbers

    return disc_numbers(params)


TERRAIN = register(
    ContactKind(
        "rigid_terrain",
        ("curve", "curve_rolling"),
        example=lambda m, i, j: m.rigid_terrain(
            "example", i, j, [(-6, -3), (-4, -2.5), (-2, -2), (0, -2.3), (2, -2.5), (4, -1.8), (6, -1.9)], radius=0.2
        ),
        numbers=_numbers,
        lengths=("radius", "points"),
    )
)
