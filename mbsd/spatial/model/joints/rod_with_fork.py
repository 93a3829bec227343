"""Rod with a fork: a massless link with a ball on body j and a fork on body i.

    Phi = |d| - length;  z_i . d        2 rows

The reaction on body j is a force in the plane of the rod and the fork's axis.
"""

from __future__ import annotations

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import SHORTEST, Direction, Fixing, Marker, Place, refuse_not_perpendicular
from mbsd.spatial.model.entries import design_distance, ends_given, enter
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model, own_body
from mbsd.spatial.model.rotation import frame
from mbsd.spatial.model.rows import along, distance

ROD_WITH_FORK = register_joint(
    JointKind(
        "rod_with_fork",
        lambda joint: [distance(joint.i, joint.j, joint.params["length"]), along(joint.i, "z", joint.j)],
        example=lambda m, i, j: m.rod_with_fork(
            "example", i, j, start=(0.1, 0.2, 0.3), end=(0.1, 0.5, 0.8), axis=(1, 0, 0)
        ),
    )
)


@ROD_WITH_FORK.adds
def rod_with_fork(
    m: Model, name: str, first: Fixing, second: Fixing, start: Place | None = None, end: Place | None = None,
    axis: Direction | None = None, length: float | None = None,
) -> Joint:  # fmt: skip
    """A rod from a fork at ``start`` on the first body to a ball at ``end`` on the second.

    The fork turns about ``axis``, across the rod; places and axis of the world in the design pose (m).
    """
    what = f"{m.name}: joint '{name}'"
    i, j = ends_given(m, what, first, second, start, end)
    length = design_distance(i, j) if length is None else length
    if length < SHORTEST:
        raise ModelError(f"{what} has length {length:g} m; it must be positive")
    if not isinstance(first, Marker):
        if axis is None:
            raise ModelError(f"{what} needs an axis: axis=(x, y, z), about which its fork turns")
        rod = j.world_place - i.world_place
        refuse_not_perpendicular(what, "axis", axis, "the rod", rod.tolist(), "A fork turns about an axis across it.")
        i = own_body(m, first, what).world_marker(i.world_place, frame(np.array(axis, float)))
    elif axis is not None:
        raise ModelError(f"{what} has markers and an axis; the fork's axis is that of its marker")
    return enter(m, ROD_WITH_FORK, name, i, j, length=length)
