"""Prismatic joint (slider): marker j slides along the x axis of marker i and does not turn against it.

    Phi_1 = n_i . (p_j - p_i)                   constraint `slot`, 1 row
    Phi_2 = (theta_j + a_j) - (theta_i + a_i)   constraint `angle`, 1 row (a: angle of the marker in its body)

The reaction on body j is a force across the slide and a torque.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Limits, join, limits_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

PRISMATIC = register(JointKind("prismatic", ("slot", "angle"), example=lambda m, i, j: m.prismatic("example", i, j)))


@PRISMATIC.adds
def prismatic(m: Model, name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint:
    """A slider: marker j moves along the x axis of marker i and does not turn against it.

    ``limits``: lower and upper place of j along that axis (m), None on a free side.
    """
    return join(m, PRISMATIC, name, i, j, None, **limits_given(m, name, limits))
