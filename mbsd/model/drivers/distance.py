"""Distance driver (linear actuator between two points): imposes the distance of markers i and j.

    Phi = |p_j - p_i| - f(t)        constraint `distance`, 1 row; nu = f', gamma = f'' + convective part

Effort: the force the actuator pushes with, positive when it pushes the markers apart.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register
from mbsd.model.laws import harmonic

DRIVE_DISTANCE = register(
    JointKind(
        "drive_distance",
        ("distance",),
        example=lambda m, i, j: m.drive_distance("example", i, j, harmonic(0.3, 1.7, 0.2, 0.9)),
        driven=True,
        units=("N", "m"),
    )
)
