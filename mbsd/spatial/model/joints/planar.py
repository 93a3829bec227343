"""Planar joint: marker j stays in the plane of marker i and turns about its normal z.

    Phi = x_i . z_j;  y_i . z_j;  z_i . d        3 rows

The reaction on body j is a force along the normal, and a moment across it.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along, parallel_axes

PLANAR = register_joint(
    JointKind(
        "planar",
        lambda joint: [*parallel_axes(joint.i, joint.j), along(joint.i, "z", joint.j)],
        example=lambda m, i, j: m.planar("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
        turns=True,
    )
)


@PLANAR.adds
def planar(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """A flat guide: the second body moves in the plane normal to ``axis``, and turns about it."""
    return join_about(m, PLANAR, name, first, second, at, axis, across)
