"""Weld: marker j is fixed to marker i in place and direction.

    Phi_12 = p_j - p_i                          constraint `point`, 2 rows
    Phi_3  = (theta_j + a_j) - (theta_i + a_i)  constraint `angle`, 1 row

The reaction on body j is a force and a torque, what a section through the body would carry.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register

WELD = register(JointKind("weld", ("point", "angle"), example=lambda m, i, j: m.weld("example", i, j)))
