"""Parallel joint: the z axes of both markers stay parallel; nothing else is held.

    Phi = x_i . z_j;  y_i . z_j        2 rows

The reaction on body j is a moment across the axis.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import parallel_axes

PARALLEL = register_joint(
    JointKind(
        "parallel",
        lambda joint: parallel_axes(joint.i, joint.j),
        example=lambda m, i, j: m.parallel("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
        turns=True,
    )
)


@PARALLEL.adds
def parallel(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """Keep the direction ``axis`` of both bodies parallel."""
    return join_about(m, PARALLEL, name, first, second, at, axis, across)
