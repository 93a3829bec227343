"""Force between two points by characteristic curves of their distance and of its rate.

    F = f(l) + g(l')        l = |p_j - p_i|, element LINE; positive F pushes the points apart

f is elastic: its integral is potential energy. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from mbsd.base.codes import LAW_RATE, LAW_VALUE, LINE
from mbsd.model.adding.forces import (
    add_force,
    curves_given,
)
from mbsd.model.body import Marker
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.laws.curve import Curve, curve
from mbsd.model.mechanism import Model


def _elements(force):
    terms = [Term(LAW_VALUE, law="of_length")] if "of_length" in force.laws else []
    terms += [Term(LAW_RATE, law="of_rate")] if "of_rate" in force.laws else []
    return (Element(LINE, tuple(terms)),)


CURVE_OF_LENGTH = register(
    ForceKind(
        "curve_of_length",
        _elements,
        look="coil",
        example=lambda m, i, j: m.curve_of_length(
            "example",
            i,
            j,
            curve([0.1, 0.8, 1.6, 4.0], [9.0, 2.0, -1.0, -7.0]),
            curve([-3.0, 0.0, 3.0], [4.0, 0.0, -2.0]),
        ),
    )
)


@CURVE_OF_LENGTH.adds
def curve_of_length(
    m: Model, name: str, i: Marker, j: Marker, of_length: Curve | None = None, of_rate: Curve | None = None
) -> Force:
    """Force (N, apart positive) by curves of the distance (m) of two points and of its rate (m/s)."""
    return add_force(m, CURVE_OF_LENGTH, name, i, j, {}, curves_given(m, name, of_length=of_length, of_rate=of_rate))
