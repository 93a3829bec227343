"""Weld: marker j is fixed to marker i in place and direction.

    Phi_12 = p_j - p_i                          constraint `point`, 2 rows
    Phi_3  = (theta_j + a_j) - (theta_i + a_i)  constraint `angle`, 1 row

The reaction on body j is a force and a torque, what a section through the body would carry.
"""

from __future__ import annotations

from mbsd.model.adding.joints import join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

WELD = register(JointKind("weld", ("point", "angle"), example=lambda m, i, j: m.weld("example", i, j)))


@WELD.adds
def weld(m: Model, name: str, i: Marker, j: Marker) -> Joint:
    """Marker j is fixed to marker i in place and direction."""
    return join(m, WELD, name, i, j)
