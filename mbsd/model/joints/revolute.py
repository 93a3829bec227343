"""Revolute joint (pin): markers i and j share one point and turn freely.

    Phi = p_j - p_i        constraint `point`, 2 rows

The reaction is the pin force on body j.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register

REVOLUTE = register(JointKind("revolute", ("point",), example=lambda m, i, j: m.revolute("example", i, j)))
