"""Point on line: the place of marker j moves along the z axis of marker i and turns freely.

    Phi = x_i . d;  y_i . d        2 rows

The reaction on body j is a force across the line.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along

POINT_ON_LINE = register_joint(
    JointKind(
        "point_on_line",
        lambda joint: [along(joint.i, "x", joint.j), along(joint.i, "y", joint.j)],
        example=lambda m, i, j: m.point_on_line("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
        slides=True,
    )
)


@POINT_ON_LINE.adds
def point_on_line(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """A ball in a straight groove: the place ``at`` of the second body moves along ``axis`` of the first."""
    return join_about(m, POINT_ON_LINE, name, first, second, at, axis, across)
