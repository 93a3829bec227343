"""Universal joint (Cardan, Hooke): a cross with an axis on each body, perpendicular and meeting.

    Phi = d;  z_i . z_j        4 rows

z_i is the axis of the cross on body i, z_j that on body j. The reaction on body j is a force, and a moment along the
normal of both axes. Where the axes of two shafts are at 90 degrees the joint is singular.
"""

from __future__ import annotations

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Direction, Fixing, Marker, Place, refuse_not_perpendicular
from mbsd.spatial.model.entries import enter, markers_given
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model, own_body
from mbsd.spatial.model.rotation import frame
from mbsd.spatial.model.rows import dot, point

UNIVERSAL = register_joint(
    JointKind(
        "universal",
        lambda joint: [point(joint.i, joint.j), dot(joint.i, "z", joint.j, "z")],
        example=lambda m, i, j: m.universal("example", i, j, at=(0.1, 0.2, 0.3), first=(1, 2, -1), second=(1, 0, 1)),
    )
)


@UNIVERSAL.adds
def universal(
    m: Model, name: str, i: Fixing, j: Fixing, at: Place | None = None, first: Direction | None = None,
    second: Direction | None = None,
) -> Joint:  # fmt: skip
    """A cross at ``at`` (m): its axis ``first`` is fixed to body i, ``second`` to body j.

    Between two markers, the axis of each is its z axis.
    """
    what = f"{m.name}: joint '{name}'"
    if isinstance(i, Marker) or isinstance(j, Marker):
        if first is not None or second is not None:
            raise ModelError(f"{what} has markers and axes of the cross; a marker's axis is that of its body's cross")
        return enter(m, UNIVERSAL, name, *markers_given(m, name, i, j, at, None))
    if at is None or first is None or second is None:
        raise ModelError(f"{what} needs at=, first= and second=: its place and an axis of the cross on each body")
    remedy = f"Turn one of them, such as second = {_across(first, second)}"
    refuse_not_perpendicular(what, "first", first, "second", second, remedy)
    place, a, b = (np.array(part, float) for part in (at, first, second))
    own = own_body(m, i, what).world_marker(place, frame(a, b))
    other = own_body(m, j, what).world_marker(place, frame(b, a))
    return enter(m, UNIVERSAL, name, *markers_given(m, name, own, other, None, None))


def _across(first: Direction, second: Direction) -> str:
    """Return in words the direction nearest to ``second`` that is perpendicular to ``first``."""
    a, b = np.array(first, float), np.array(second, float)
    normal = b - (b @ a) / (a @ a) * a
    if not np.linalg.norm(normal) > 1e-6:
        normal = frame(a / np.linalg.norm(a))[:, 0]
    return "(" + ", ".join(f"{x + 0.0:.9g}" for x in normal / np.linalg.norm(normal)) + ")"
