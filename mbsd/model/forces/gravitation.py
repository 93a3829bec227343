"""Attraction of two points by a power of their distance; with exponent -2 and a = -G m_i m_j that of masses.

    F = a l^n        l = |p_j - p_i|, element LINE; negative F pulls the points together

Potential energy -a l^(n + 1) / (n + 1). Source: Newton; Goldstein, Classical Mechanics, ch. 3.
"""

from __future__ import annotations

from mbsd.base.codes import LINE, POWER
from mbsd.model.forces.kind import Element, ForceKind, Term, register


def _elements(force):
    return (Element(LINE, (Term(POWER, force.params["factor"], 0.0, force.params["exponent"]),)),)


GRAVITATION = register(
    ForceKind("gravitation", _elements, example=lambda m, i, j: m.gravitation("example", i, j, -2.3))
)
