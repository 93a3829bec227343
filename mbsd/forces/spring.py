"""Spring and damper between two points.

    F = -k (l - l0) - c l'        l = |p_j - p_i|, element LINE

Positive F pushes the points apart; a stretched spring pulls them together. Potential energy k (l - l0)^2 / 2.
Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from mbsd.forces.kind import DAMPING, LINE, LINEAR, Element, ForceKind, Term, register


def _elements(force):
    p = force.params
    return (Element(LINE, (Term(LINEAR, p["stiffness"], p["free_length"]), Term(DAMPING, p["damping"]))),)


SPRING = register(
    ForceKind(
        "spring", _elements, example=lambda m, i, j: m.spring("example", i, j, 120.0, damping=3.0, free_length=0.4)
    )
)
