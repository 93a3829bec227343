"""Rod: a massless link with a ball at each end keeps two places a fixed distance apart.

    Phi = |d| - length        1 row

The reaction on body j is the rod's push along it.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import SHORTEST, Fixing, Place
from mbsd.spatial.model.entries import design_distance, ends_given, enter
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import distance

DISTANCE = register_joint(
    JointKind(
        "distance",
        lambda joint: [distance(joint.i, joint.j, joint.params["length"])],
        example=lambda m, i, j: m.distance("example", i, j, start=(0.1, 0.2, 0.3), end=(-0.2, 0.5, 0.8)),
    )
)


@DISTANCE.adds
def distance_joint(
    m: Model, name: str, first: Fixing, second: Fixing, start: Place | None = None, end: Place | None = None,
    length: float | None = None,
) -> Joint:  # fmt: skip
    """A rod from ``start`` on the first body to ``end`` on the second, places of the world (m).

    ``length`` (m) is that of the design pose if it is not given.
    """
    i, j = ends_given(m, f"{m.name}: joint '{name}'", first, second, start, end)
    length = design_distance(i, j) if length is None else length
    if length < SHORTEST:
        raise ModelError(
            f"{m.name}: joint '{name}' has length {length:g} m; it must be positive (use a spherical joint for places "
            "that coincide)"
        )
    return enter(m, DISTANCE, name, i, j, length=length)
