"""Relative angle driver: imposes the angle of body j against body i.

    Phi = theta_j - theta_i - f(t)        constraint `angle`, 1 row; nu = f', gamma = f''

Effort: the torque the driver gives to body j; body i gets the opposite.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register
from mbsd.model.laws import harmonic

DRIVE_RELATIVE_ANGLE = register(
    JointKind(
        "drive_relative_angle",
        ("angle",),
        example=lambda m, i, j: m.drive_relative_angle("example", i.body, j.body, harmonic(0.3, 1.7, 0.2, 0.9)),
        driven=True,
        units=("N m", "rad"),
    )
)
