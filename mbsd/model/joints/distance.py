"""Distance joint (massless rod): markers i and j stay a fixed distance apart.

    Phi = |p_j - p_i| - length        constraint `distance`, 1 row

The reaction on body j is the rod's push along it.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register

DISTANCE = register(
    JointKind("distance", ("distance",), example=lambda m, i, j: m.distance("example", i, j, length=0.7))
)
