"""Rolling on a curve: a disc about marker j rolls without slip on the left of a curve.

The disc has the radius r, and the curve is fixed to marker i.

    Phi_1 = n . (p_j - c(u)) - r            constraint `curve`, 1 row
    Phi_2 = s - r (beta - a) - c            constraint `curve_rolling`, 1 row

c(u) is the curve's point nearest to the disc's centre, s and beta the arc length and tangent angle there, a the disc's
angle. The curve is a quintic spline through points in the axes of marker i, a terrain from left to right. Where it is
bent tighter than the disc it would touch twice; the model refuses that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.model.adding.joints import join, radii_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

if TYPE_CHECKING:
    import numpy as np


def _numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    from mbsd.model.plane_curves import disc_numbers

    return disc_numbers(params, follows=True)


ROLLING_ON_CURVE = register(
    JointKind(
        "rolling_on_curve",
        ("curve", "curve_rolling"),
        example=lambda m, i, j: m.rolling_on_curve(
            "example", i, j, [(-6, -1), (-4, -0.5), (-2, 0), (0, -0.3), (2, -0.5), (4, 0.2), (6, 0.1)], radius=0.2
        ),
        numbers=_numbers,
        lengths=("radius", "points"),
        touching="curve",
    )
)


@ROLLING_ON_CURVE.adds
def rolling_on_curve(
    m: Model,
    name: str,
    curve: Marker,
    disc: Marker,
    points: Sequence[Sequence[float]],
    radius: float,
    closed: bool = False,
) -> Joint:
    """Add a disc of this radius (m) about ``disc`` that rolls on the left of a curve through ``points``.

    ``points`` is (k, 2).

    The points are in the axes of marker ``curve`` (m); beyond its ends an open curve goes on straight.
    """
    from mbsd.model.plane_curves import checked_points, refuse_tight

    what = f"{m.name}: joint '{name}'"
    radii, plain = radii_given(m, name, radius=radius), checked_points(what, points, closed)
    refuse_tight(what, plain, closed, radii["radius"])
    return join(m, ROLLING_ON_CURVE, name, curve, disc, None, points=plain, closed=bool(closed), **radii)
