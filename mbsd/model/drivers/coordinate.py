"""Coordinate driver: imposes how far marker j lies along the x axis of marker i.

    Phi = u_i . (p_j - p_i) - f(t)        constraint `along`, 1 row; nu = f', gamma = f'' + convective part

Effort: the force the driver gives to body j along the axis.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Law, join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.laws import harmonic
from mbsd.model.mechanism import Model

DRIVE_COORDINATE = register(
    JointKind(
        "drive_coordinate",
        ("along",),
        example=lambda m, i, j: m.drive_coordinate("example", i, j, harmonic(0.3, 1.7, 0.2, 0.9)),
        driven=True,
        units=("N", "m"),
    )
)


@DRIVE_COORDINATE.adds
def drive_coordinate(m: Model, name: str, i: Marker, j: Marker, law: Law) -> Joint:
    """Impose how far marker j lies along the x axis of marker i (m)."""
    return join(m, DRIVE_COORDINATE, name, i, j, law=law)
