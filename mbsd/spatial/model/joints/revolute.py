"""Revolute joint (hinge): marker j turns about the z axis of marker i.

    Phi = d;  x_i . z_j;  y_i . z_j        5 rows

The reaction on body j is a force, and a moment across the axis.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import parallel_axes, point

REVOLUTE = register_joint(
    JointKind(
        "revolute",
        lambda joint: [point(joint.i, joint.j), *parallel_axes(joint.i, joint.j)],
        example=lambda m, i, j: m.revolute("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
        turns=True,
        has_friction=True,
    )
)


@REVOLUTE.adds
def revolute(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """A hinge: the bodies share the place ``at`` (m) and turn about ``axis``, of the world."""
    return join_about(m, REVOLUTE, name, first, second, at, axis, across)
