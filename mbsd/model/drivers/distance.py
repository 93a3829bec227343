"""Distance driver (linear actuator between two points): imposes the distance of markers i and j.

    Phi = |p_j - p_i| - f(t)        constraint `distance`, 1 row; nu = f', gamma = f'' + convective part

Effort: the force the actuator pushes with, positive when it pushes the markers apart.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Law, join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.laws import harmonic
from mbsd.model.mechanism import Model

DRIVE_DISTANCE = register(
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
