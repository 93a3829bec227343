"""Prismatic joint (slider): marker j slides along the x axis of marker i and does not turn against it.

    Phi_1 = n_i . (p_j - p_i)                   constraint `slot`, 1 row
    Phi_2 = (theta_j + a_j) - (theta_i + a_i)   constraint `angle`, 1 row (a: angle of the marker in its body)

The reaction on body j is a force across the slide and a torque.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register

PRISMATIC = register(JointKind("prismatic", ("slot", "angle"), example=lambda m, i, j: m.prismatic("example", i, j)))
