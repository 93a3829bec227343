"""Angle driver: imposes the absolute angle of a body, the same as its angle against ground.

    Phi = theta_j - f(t)        constraint `angle`, 1 row; nu = f', gamma = f''

Effort: the torque the driver gives to the body.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Law, join
from mbsd.model.body import Body
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.laws import harmonic
from mbsd.model.mechanism import Model, own_body

DRIVE_ANGLE = register(
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
