"""Point on plane: the place of marker j stays in the plane of marker i and turns freely.

    Phi = z_i . d        1 row

The reaction on body j is a force along the normal.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along

POINT_ON_PLANE = register_joint(
    JointKind(
        "point_on_plane",
        lambda joint: [along(joint.i, "z", joint.j)],
        example=lambda m, i, j: m.point_on_plane("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
    )
)


@POINT_ON_PLANE.adds
def point_on_plane(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """A ball on a plate: the place ``at`` of the second body stays in a plane of the first."""
    return join_about(m, POINT_ON_PLANE, name, first, second, at, axis, across)
