"""Potential energy of the forces that have one: springs, elastic curves, gas, attraction, contacts, a turning frame.

    LINEAR      a (x - b)^2 / 2
    POWER       -a (x + b)^(c + 1) / (c + 1);   for c = -1  -a log(x + b)
    LAW_VALUE   -a int law dx

x: what the element measures (see forces/kind.py). Constants and laws of time and of rates do work instead.
Interactions bring their own.
"""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.codes import LAW_VALUE, LINEAR, POTENTIAL_TERMS, POWER
from mbsd.model.force import Force, Term
from mbsd.model.laws.curve import Curve
from mbsd.results.measured import measured
from mbsd.results.surface import depths


def potential_of(packed: Packed, force: Force, q: np.ndarray) -> np.ndarray:
    """(T,) potential energy (J) of one force along poses q (T, 3 nb)."""
    i, j = packed.markers_of(force)
    out = np.zeros(len(q))
    for element in force.kind.elements(force):
        terms = [term for term in element.terms if term.kind in POTENTIAL_TERMS]
        if terms:
            x = measured(packed, element, i, j, q)
            out += sum(_term(force, term, x) for term in terms)
    if force.kind.potential is not None:
        out += force.kind.potential(force, packed.masses, q)
    if force.kind.depth_potential is not None:
        out += force.kind.depth_potential(force, depths(packed, force, q)).sum(axis=0)
    return out


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
