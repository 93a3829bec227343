"""Attraction of two points by a power of their distance; of masses with -2 and a = -G m_i m_j.

    F = a l^n        l = |p_j - p_i|, element LINE; negative F pulls the points together

Potential energy -a l^(n + 1) / (n + 1). Source: Newton; Goldstein, Classical Mechanics, ch. 3.
"""

from __future__ import annotations

from mbsd.base.codes import LINE, POWER
from mbsd.model.adding.forces import (
    add_force,
)
from mbsd.model.body import Marker
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model, number_given


def _elements(force):
    return (Element(LINE, (Term(POWER, force.params["factor"], 0.0, force.params["exponent"]),)),)


GRAVITATION = register(
    ForceKind("gravitation", _elements, sign="attraction", example=lambda m, i, j: m.gravitation("example", i, j, -2.3))
)


@GRAVITATION.adds
def gravitation(m: Model, name: str, i: Marker, j: Marker, factor: float, exponent: float = -2.0) -> Force:
    """Add a force factor * distance^exponent (N) between two points; positive pushes them apart.

    Masses attract each other with the factor -G m1 m2 and the exponent -2.
    """
    params = {
        "factor": number_given(m, f"force '{name}': factor", factor),
        "exponent": number_given(m, f"force '{name}': exponent", exponent),
    }
    return add_force(m, GRAVITATION, name, i, j, params)
