"""Fixed joint: marker j is fixed to marker i in place and direction.

    Phi = d;  x_i . z_j;  y_i . z_j;  x_i . y_j        6 rows

The reaction on body j is a force and a moment, what a section carries.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Fixing, Place
from mbsd.spatial.model.entries import enter, markers_given
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import point, same_directions

FIXED = register_joint(
    JointKind(
        "fixed",
        lambda joint: [point(joint.i, joint.j), *same_directions(joint.i, joint.j)],
        example=lambda m, i, j: m.fixed("example", i, j, at=(0.1, 0.2, 0.3)),
    )
)


@FIXED.adds
def fixed(m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None) -> Joint:
    """Fix a body to another; ``at`` (m) is the place at which the reaction is given, in the world."""
    return enter(m, FIXED, name, *markers_given(m, name, first, second, at, None))
