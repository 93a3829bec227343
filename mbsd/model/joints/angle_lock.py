"""Angle lock (parallel joint): marker j keeps the direction of marker i and is free to move.

    Phi = (theta_j + a_j) - (theta_i + a_i)        constraint `angle`, 1 row (a: angle of the marker in its body)

The reaction on body j is a torque.
"""

from __future__ import annotations

from mbsd.model.adding.joints import join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

ANGLE_LOCK = register(JointKind("angle_lock", ("angle",), example=lambda m, i, j: m.angle_lock("example", i, j)))


@ANGLE_LOCK.adds
def angle_lock(m: Model, name: str, i: Marker, j: Marker) -> Joint:
    """Marker j keeps the direction of marker i and is free to move."""
    return join(m, ANGLE_LOCK, name, i, j)
