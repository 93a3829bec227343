"""Point on curve: marker j lies on a smooth curve fixed to marker i, or at a fixed distance from it.

    Phi = n . (p_j - c(u)) - D        constraint `curve`, 1 row, c(u) the curve's point nearest to p_j

The curve is a quintic spline through points in the axes of marker i. D > 0 is on its left: the centre of a roller or a
disc of radius D that slides. The reaction on body j is a force across the curve. Where the curve crosses itself or the
straight lines beyond its ends, a simulation goes on along the branch the point is on (mbsd/arrays/curve_branches.py),
and a sweep that may have left it is refused.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.model.adding.joints import join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model, number_given

if TYPE_CHECKING:
    import numpy as np


def _numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    import numpy as np

    from mbsd.model.plane_curves import curve_numbers, curve_pieces, farthest_step

    closed, distance = params["closed"], params["distance"]
    pieces = curve_pieces(np.array(params["points"], float), closed)
    return [curve_numbers(*pieces, closed, distance, 0.0, farthest_step(*pieces, closed, distance))]


POINT_ON_CURVE = register(
    JointKind(
        "point_on_curve",
        ("curve",),
        look="captive",
        example=lambda m, i, j: m.point_on_curve(
            "example",
            i,
            j,
            [(3, 0.1), (1.6, 2.1), (-0.8, 2.8), (-2.9, 1.2), (-2.5, -1.3), (-0.4, -2.6), (1.9, -2)],
            closed=True,
            distance=-0.1,
        ),
        numbers=_numbers,
        lengths=("points",),
        touching="place",
    )
)


@POINT_ON_CURVE.adds
def point_on_curve(
    m: Model,
    name: str,
    curve: Marker,
    point: Marker,
    points: Sequence[Sequence[float]],
    closed: bool = False,
    distance: float = 0.0,
) -> Joint:
    """Marker ``point`` moves on a curve through ``points`` (k, 2) in the axes of marker ``curve`` (m).

    ``distance`` (m) is how far it stays to the left of the curve; beyond its ends an open curve goes on straight.
    """
    from mbsd.model.plane_curves import checked_points

    what = f"{m.name}: joint '{name}'"
    plain = checked_points(what, points, closed)
    distance = number_given(m, f"joint '{name}': distance", distance)
    return join(m, POINT_ON_CURVE, name, curve, point, None, points=plain, closed=bool(closed), distance=distance)
