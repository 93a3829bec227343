"""Lock: body j does not turn against body i and is free to move.

    Phi = x_i . z_j;  y_i . z_j;  x_i . y_j        3 rows

The reaction on body j is a moment.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Fixing, Marker, Place
from mbsd.spatial.model.entries import enter, markers_given
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import same_directions

LOCK = register_joint(
    JointKind(
        "lock",
        lambda joint: same_directions(joint.i, joint.j),
        example=lambda m, i, j: m.lock("example", i, j),
    )
)


@LOCK.adds
def lock(m: Model, name: str, first: Fixing, second: Fixing, at: Place = (0.0, 0.0, 0.0)) -> Joint:
    """Keep a body from turning against another; ``at`` (m) is where it is drawn, in the world."""
    place = None if isinstance(first, Marker) else at
    return enter(m, LOCK, name, *markers_given(m, name, first, second, place, None))
