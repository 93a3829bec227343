"""Torsion spring and damper between two bodies.

    T = -k (theta_j - theta_i - free) - c (omega_j - omega_i)        on body j, -T on body i; element TURN

Potential energy k (theta_j - theta_i - free)^2 / 2. Each of k, c and free may be a law of time, which does work as in
a spring between points. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from mbsd.base.codes import TURN
from mbsd.model.forces.kind import Element, ForceKind, register
from mbsd.model.forces.spring import constant_terms, terms_in_time

TORSION_SPRING = register(
    ForceKind(
        "torsion_spring",
        lambda force: (Element(TURN, constant_terms(force, "free_angle")),),
        interactions=lambda force, masses: terms_in_time(force, "free_angle", turning=True),
        example=lambda m, i, j: m.torsion_spring("example", i.body, j.body, 14.0, damping=0.3, free_angle=0.2),
    )
)
