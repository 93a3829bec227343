"""Points and discs on lines and curves: sliding, and rolling without slip.

Point on curve: marker j lies on a smooth curve fixed to marker i, or at a fixed distance from it.

    Phi = n . (p_j - c(u)) - D        constraint `curve`, 1 row, c(u) the curve's point nearest to p_j

The curve is a quintic spline through points in the axes of marker i. D > 0 is on its left: the centre of a roller or a
disc of radius D that slides. The reaction on body j is a force across the curve. Where the curve crosses itself or the
straight lines beyond its ends, a simulation goes on along the branch the point is on (mbsd/arrays/curve_branches.py),
and a sweep that may have left it raises an error.

Rolling disc: a disc of radius r about marker j rolls without slip on the x axis of marker i.

    Phi_1 = y - r              constraint `height` (linear.py), 1 row
    Phi_2 = x + r a - c        constraint `rack` (linear.py), 1 row

The disc is on the side of the line's y axis: it rolls clockwise to positive x. The reaction on body j is the force of
the ground, as a force at the disc's centre and the torque of its friction part. Source: Nikravesh, Planar Multibody
Dynamics, 2018, disc joint.

Rolling on a curve: a disc about marker j rolls without slip on the left of a curve.

The disc has the radius r, and the curve is fixed to marker i.

    Phi_1 = n . (p_j - c(u)) - r            constraint `curve`, 1 row
    Phi_2 = s - r (beta - a) - c            constraint `curve_rolling`, 1 row

c(u) is the curve's point nearest to the disc's centre, s and beta the arc length and tangent angle there, a the disc's
angle. The curve is a quintic spline through points in the axes of marker i, a terrain from left to right. Where it is
bent tighter than the disc it would touch twice; that raises an error.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.model.body import Marker
from mbsd.model.entries import join, phase_given, radii_given
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.mechanism import Model
from mbsd.model.plane_curves import (
    check_curvature,
    checked_points,
    curve_numbers,
    curve_pieces,
    disc_numbers,
    farthest_step,
)


def _point_on_curve_numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    closed, distance = params["closed"], params["distance"]
    pieces = curve_pieces(np.array(params["points"], float), closed)
    return [curve_numbers(*pieces, closed, distance, 0.0, farthest_step(*pieces, closed, distance))]


POINT_ON_CURVE = register_joint(
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
        numbers=_point_on_curve_numbers,
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
    plain = checked_points(f"{m.name}: joint '{name}'", points, closed)
    return join(m, POINT_ON_CURVE, name, curve, point, None, points=plain, closed=bool(closed), distance=distance)


ROLLING_DISC = register_joint(
    JointKind(
        "rolling_disc",
        ("height", "rack"),
        example=lambda m, i, j: m.rolling_disc("example", i, j, radius=0.3),
        numbers=lambda params: [(0.0, 1.0, 0.0, params["radius"]), (1.0, 0.0, params["radius"], 0.0)],
        lengths=("radius",),
        touching="line",
    )
)


@ROLLING_DISC.adds
def rolling_disc(
    m: Model, name: str, line: Marker, disc: Marker, radius: float, phase: Sequence[float] | None = None
) -> Joint:
    """Add a disc of this radius (m) about ``disc`` that rolls on the y side of ``line``'s x axis."""
    radii = radii_given(m, name, radius=radius)
    return join(m, ROLLING_DISC, name, line, disc, None, **radii, phase=phase_given(m, name, phase))


ROLLING_ON_CURVE = register_joint(
    JointKind(
        "rolling_on_curve",
        ("curve", "curve_rolling"),
        example=lambda m, i, j: m.rolling_on_curve(
            "example", i, j, [(-6, -1), (-4, -0.5), (-2, 0), (0, -0.3), (2, -0.5), (4, 0.2), (6, 0.1)], radius=0.2
        ),
        numbers=lambda params: disc_numbers(params, follows=True),
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
    what = f"{m.name}: joint '{name}'"
    radii, plain = radii_given(m, name, radius=radius), checked_points(what, points, closed)
    check_curvature(what, plain, closed, radii["radius"])
    return join(m, ROLLING_ON_CURVE, name, curve, disc, None, points=plain, closed=bool(closed), **radii)
