"""Rolling on a curve: a disc of radius r about marker j rolls without slip on a curve fixed to marker i, on its left.

    Phi_1 = n . (p_j - c(u)) - r            constraint `curve`, 1 row
    Phi_2 = s - r (beta - a) - c            constraint `curve_rolling`, 1 row

c(u) is the curve's point nearest to the disc's centre, s and beta the arc length and tangent angle there, a the disc's
angle. The curve is a quintic spline through points in the axes of marker i, a terrain from left to right. Where it is
bent tighter than the disc it would touch twice; the model refuses that.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mbsd.model.joints.kind import JointKind, register

if TYPE_CHECKING:
    import numpy as np


def _numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    from mbsd.model.plane_curves import disc_numbers

    return disc_numbers(params)


ROLLING_ON_CURVE = register(
    JointKind(
        "rolling_on_curve",
        ("curve", "curve_rolling"),
        example=lambda m, i, j: m.rolling_on_curve(
            "example", i, j, [(-6, -1), (-4, -0.5), (-2, 0), (0, -0.3), (2, -0.5), (4, 0.2), (6, 0.1)], radius=0.2
        ),
        numbers=_numbers,
        lengths=("radius", "points"),
    )
)
