"""Distance joint (massless rod): markers i and j stay a fixed distance apart.

    Phi = |p_j - p_i| - length        constraint `distance`, 1 row

The reaction on body j is the rod's push along it.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.model.adding.joints import join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import SHORTEST, Model, number_given

DISTANCE = register(
    JointKind("distance", ("distance",), example=lambda m, i, j: m.distance("example", i, j, length=0.7))
)


@DISTANCE.adds
def distance(m: Model, name: str, i: Marker, j: Marker, length: float) -> Joint:
    """A massless rod of the given length (m) between the points of markers i and j."""
    length = number_given(m, f"joint '{name}': length", length)
    if length < SHORTEST:
        raise ModelError(
            f"{m.name}: distance joint '{name}' has length {length:g} m; it must be positive, {SHORTEST:g} m or "
            "more (use a revolute joint for two points that coincide)"
        )
    return join(m, DISTANCE, name, i, j, length=length)
