"""Torsion spring and damper between two bodies.

    T = -k (theta_j - theta_i - free) - c (omega_j - omega_i)        on body j, -T on body i; element TURN

Potential energy k (theta_j - theta_i - free)^2 / 2. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from mbsd.forces.kind import DAMPING, LINEAR, TURN, Element, ForceKind, Term, register


def _elements(force):
    p = force.params
    return (Element(TURN, (Term(LINEAR, p["stiffness"], p["free_angle"]), Term(DAMPING, p["damping"]))),)


TORSION_SPRING = register(
    ForceKind(
        "torsion_spring",
        _elements,
        example=lambda m, i, j: m.torsion_spring("example", i.body, j.body, 14.0, damping=0.3, free_angle=0.2),
    )
)
