"""Revolute joint (pin): markers i and j share one point and turn freely.

    Phi = p_j - p_i        constraint `point`, 2 rows

The reaction is the pin force on body j.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Limits, join, limits_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

REVOLUTE = register(JointKind("revolute", ("point",), example=lambda m, i, j: m.revolute("example", i, j)))


@REVOLUTE.adds
def revolute(m: Model, name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint:
    """A pin: markers i and j share one point. ``limits``: of the angle of j against i (rad), None: free."""
    return join(m, REVOLUTE, name, i, j, None, **limits_given(m, name, limits))
