"""Relative angle driver: imposes the angle of body j against body i.

    Phi = theta_j - theta_i - f(t)        constraint `angle`, 1 row; nu = f', gamma = f''

Effort: the torque the driver gives to body j; body i gets the opposite.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Law, join
from mbsd.model.body import Body
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.laws import harmonic
from mbsd.model.mechanism import Model, own_body

DRIVE_RELATIVE_ANGLE = register(
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
