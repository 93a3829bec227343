"""Drivers: motion laws imposed on an angle, a coordinate or a distance.

Angle driver: imposes the absolute angle of a body, the same as its angle against ground.

    Phi = theta_j - f(t)        constraint `angle`, 1 row; nu = f', gamma = f''

Effort: the torque the driver gives to the body.

Relative angle driver: imposes the angle of body j against body i.

    Phi = theta_j - theta_i - f(t)        constraint `angle`, 1 row; nu = f', gamma = f''

Effort: the torque the driver gives to body j; body i gets the opposite.

Coordinate driver: imposes how far marker j lies along the x axis of marker i.

    Phi = u_i . (p_j - p_i) - f(t)        constraint `along`, 1 row; nu = f', gamma = f'' + convective part

Effort: the force the driver gives to body j along the axis.

Distance driver (linear actuator between two points): imposes the distance of markers i and j.

    Phi = |p_j - p_i| - f(t)        constraint `distance`, 1 row; nu = f', gamma = f'' + convective part

Effort: the force the actuator pushes with, positive when it pushes the markers apart.
"""

from __future__ import annotations

from mbsd.model.body import Body, Marker
from mbsd.model.entries import Law, join
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.laws import harmonic
from mbsd.model.mechanism import Model, own_body

DRIVE_ANGLE = register_joint(
    JointKind(
        "drive_angle",
        ("angle",),
        example=lambda m, i, j: m.drive_angle("example", j.body, harmonic(0.3, 1.7, 0.2, 0.9)),
        driven=True,
        units=("N m", "rad"),
    )
)


@DRIVE_ANGLE.adds
def drive_angle(m: Model, name: str, body: Body | str, law: Law) -> Joint:
    """Impose the absolute angle of a body (rad)."""
    return join(m, DRIVE_ANGLE, name, m.ground.origin, own_body(m, body, f"driver '{name}'").origin, law=law)


DRIVE_RELATIVE_ANGLE = register_joint(
    JointKind(
        "drive_relative_angle",
        ("angle",),
        example=lambda m, i, j: m.drive_relative_angle("example", i.body, j.body, harmonic(0.3, 1.7, 0.2, 0.9)),
        driven=True,
        units=("N m", "rad"),
    )
)


@DRIVE_RELATIVE_ANGLE.adds
def drive_relative_angle(m: Model, name: str, first: Body | str, second: Body | str, law: Law) -> Joint:
    """Impose the angle of body ``second`` against body ``first`` (rad)."""
    i, j = (own_body(m, body, f"driver '{name}'").origin for body in (first, second))
    return join(m, DRIVE_RELATIVE_ANGLE, name, i, j, law=law)


DRIVE_COORDINATE = register_joint(
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


DRIVE_DISTANCE = register_joint(
    JointKind(
        "drive_distance",
        ("distance",),
        look="cylinder",
        example=lambda m, i, j: m.drive_distance("example", i, j, harmonic(0.3, 1.7, 0.2, 0.9)),
        driven=True,
        units=("N", "m"),
    )
)


@DRIVE_DISTANCE.adds
def drive_distance(m: Model, name: str, i: Marker, j: Marker, law: Law) -> Joint:
    """Impose the distance of the points of markers i and j (m), as a linear actuator does."""
    return join(m, DRIVE_DISTANCE, name, i, j, law=law)
