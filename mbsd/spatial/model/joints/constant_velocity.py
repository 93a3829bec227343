"""Constant velocity joint: two shafts meet in a place and turn alike at any angle between them.

    Phi = d;  x_i . y_j - y_i . x_j        4 rows, the last a sum of two dot products

z_i and z_j lie along the shafts. The reaction on body j is a force and a moment about the line that halves the angle of
the shafts. Where the shafts fold back onto each other the joint is singular.
"""

from __future__ import annotations

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Direction, Fixing, Marker, Place
from mbsd.spatial.model.entries import enter, markers_given
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model, own_body
from mbsd.spatial.model.rotation import carried, frame
from mbsd.spatial.model.rows import Row, Term, point


def _rows(joint: Joint) -> list[Row]:
    i, j = joint.i, joint.j
    return [point(i, j), Row((Term("dot", i, j, "x", "y"), Term("dot", i, j, "y", "x", -1.0)), "rad")]


CONSTANT_VELOCITY = register_joint(
    JointKind(
        "constant_velocity",
        _rows,
        example=lambda m, i, j: m.constant_velocity(
            "example", i, j, at=(0.1, 0.2, 0.3), first=(1, 2, -1), second=(1, 1, 0)
        ),
    )
)


@CONSTANT_VELOCITY.adds
def constant_velocity(
    m: Model, name: str, i: Fixing, j: Fixing, at: Place | None = None, first: Direction | None = None,
    second: Direction | None = None,
) -> Joint:  # fmt: skip
    """Join two shafts at ``at`` (m), along ``first`` and ``second``, which point the same way."""
    what = f"{m.name}: joint '{name}'"
    if isinstance(i, Marker) or isinstance(j, Marker):
        return enter(m, CONSTANT_VELOCITY, name, *markers_given(m, name, i, j, at, None))
    if at is None or first is None or second is None:
        raise ModelError(f"{what} needs at=, first= and second=: its place, and the direction of each shaft")
    a, b = np.array(first, float), np.array(second, float)
    if a @ b < 0.0:
        raise ModelError(f"{what}: first and second point against each other; let both run from the first shaft on")
    axes = frame(a)
    place = np.array(at, float)
    own = own_body(m, i, what).world_marker(place, axes)
    other = own_body(m, j, what).world_marker(place, carried(a, b) @ axes)
    return enter(m, CONSTANT_VELOCITY, name, *markers_given(m, name, own, other, None, None))
