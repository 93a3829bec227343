"""Cylindrical joint: marker j turns about the z axis of marker i and moves along it.

    Phi = x_i . z_j;  y_i . z_j;  x_i . d;  y_i . d        4 rows

The reaction on body j is a force and a moment across the axis.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along, parallel_axes

CYLINDRICAL = register_joint(
    JointKind(
        "cylindrical",
        lambda joint: [*parallel_axes(joint.i, joint.j), along(joint.i, "x", joint.j), along(joint.i, "y", joint.j)],
        example=lambda m, i, j: m.cylindrical("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
        turns=True,
        slides=True,
    )
)


@CYLINDRICAL.adds
def cylindrical(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """A bush: the second body turns about ``axis`` and slides along it, of the world in the design pose."""
    return join_about(m, CYLINDRICAL, name, first, second, at, axis, across)
