"""Potential energy of the forces that have one: springs, elastic curves, gas, attraction, contacts, a turning frame.

    LINEAR      a (x - b)^2 / 2
    POWER       -a (x + b)^(c + 1) / (c + 1);   for c = -1  -a log(x + b)
    LAW_VALUE   -a int law dx

x: what the element measures (see forces/kind.py). Constants and laws of time and of rates do work instead.
Interactions bring their own.
"""

from __future__ import annotations

import numpy as np

from mbsd.curves import Curve
from mbsd.force import Force
from mbsd.forces.kind import AXIS, LAW_VALUE, LINE, LINEAR, POTENTIAL_TERMS, POWER, TURN, Element, Term
from mbsd.packing import Packed
from mbsd.reactions import marker_axes, marker_places


def potential_of(packed: Packed, force: Force, q: np.ndarray) -> np.ndarray:
    """(T,) potential energy (J) of one force along poses q (T, 3 nb)."""
    i, j = packed.force_markers[packed.forces.index(force)]
    out = np.zeros(len(q))
    for element in force.kind.elements(force):
        terms = [term for term in element.terms if term.kind in POTENTIAL_TERMS]
        if terms:
            x = measured(packed, element, i, j, q)
            out += sum(_term(force, term, x) for term in terms)
    if force.kind.potential is not None:
        out += force.kind.potential(force, packed, q)
    return out


def measured(packed: Packed, element: Element, i: int, j: int, q: np.ndarray) -> np.ndarray:
    """(T,) the scalar x (m or rad) of an element between markers i and j along poses q (T, 3 nb)."""
    bi, bj = packed.system.marker_body[i], packed.system.marker_body[j]
    if element.kind == TURN:
        return q[:, 3 * bj + 2] - q[:, 3 * bi + 2]
    gap = marker_places(packed, q, j) - marker_places(packed, q, i)
    if element.kind == LINE:
        return np.hypot(gap[:, 0], gap[:, 1])
    assert element.kind == AXIS, "a push measures nothing"
    return (marker_axes(packed, q, i, element.turned) * gap).sum(axis=1)


def relative_place(packed: Packed, force: Force, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """x and y (T,) of marker j in the axes of marker i (m) along poses q (T, 3 nb)."""
    i, j = packed.force_markers[packed.forces.index(force)]
    x, y = (measured(packed, Element(AXIS, (), turned), i, j, q) for turned in (False, True))
    return x, y


def _term(force: Force, term: Term, x: np.ndarray) -> np.ndarray:
    if term.kind == LINEAR:
        return 0.5 * term.a * (x - term.b) ** 2
    if term.kind == POWER:
        if term.c == -1.0:
            return -term.a * np.log(x + term.b)
        return -term.a * (x + term.b) ** (term.c + 1.0) / (term.c + 1.0)
    assert term.kind == LAW_VALUE
    assert term.law is not None
    law = force.laws[term.law]
    assert isinstance(law, Curve), "laws of a length or an angle are curves"
    return -term.a * law.integral(x)
