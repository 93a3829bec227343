"""Torque on a body, constant or a law of time, against ground or against another body.

T = T(t)        on body j, -T on body i; element TURN; counter-clockwise positive
"""

from __future__ import annotations

from mbsd.base.codes import CONSTANT, LAW_TIME, TURN
from mbsd.model.adding.forces import (
    Amount,
    add_force,
    amount_given,
    origins,
)
from mbsd.model.body import Body
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model


def _elements(force):
    law = "torque" in force.laws
    term = Term(LAW_TIME, law="torque") if law else Term(CONSTANT, force.params["torque"])
    return (Element(TURN, (term,)),)


TORQUE = register(
    ForceKind(
        "torque", _elements, effort="torque", example=lambda m, i, j: m.torque("example", j.body, 1.7, against=i.body)
    )
)


@TORQUE.adds
def torque(m: Model, name: str, body: Body | str, torque: Amount, against: Body | str | None = None) -> Force:
    """Add a torque (N m) on a body, a constant or a law; ``against`` (default ground) takes the opposite."""
    params, laws = amount_given(m, name, "torque", torque)
    return add_force(m, TORQUE, name, *origins(m, name, m.ground if against is None else against, body), params, laws)
