"""Prismatic joint (slider): marker j moves along the z axis of marker i and does not turn.

    Phi = x_i . z_j;  y_i . z_j;  x_i . y_j;  x_i . d;  y_i . d        5 rows

The reaction on body j is a force across the axis, and a moment.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along, same_directions

PRISMATIC = register_joint(
    JointKind(
        "prismatic",
        lambda joint: [
            *same_directions(joint.i, joint.j),
            along(joint.i, "x", joint.j),
            along(joint.i, "y", joint.j),
        ],
        example=lambda m, i, j: m.prismatic("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1)),
        slides=True,
        has_friction=True,
    )
)


@PRISMATIC.adds
def prismatic(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Joint:  # fmt: skip
    """A slider: the second body moves along ``axis``, a direction of the world in the design pose."""
    return join_about(m, PRISMATIC, name, first, second, at, axis, across)
