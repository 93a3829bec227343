"""Torque on a body, constant or a law of time, against ground or against another body.

T = T(t)        on body j, -T on body i; element TURN; counter-clockwise positive
"""

from __future__ import annotations

from mbsd.base.codes import CONSTANT, LAW_TIME, TURN
from mbsd.model.forces.kind import Element, ForceKind, Term, register


def _elements(force):
    law = "torque" in force.laws
    term = Term(LAW_TIME, law="torque") if law else Term(CONSTANT, force.params["torque"])
    return (Element(TURN, (term,)),)


TORQUE = register(
    ForceKind("torque", _elements, example=lambda m, i, j: m.torque("example", j.body, 1.7, against=i.body))
)
