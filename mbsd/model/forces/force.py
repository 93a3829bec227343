"""Force at a point of a body, constant or a law of time, in a direction fixed in the world or in a body.

    F = F(t) u        at marker j; u: x axis of marker i, on ground or on the body itself; element PUSH

Nothing feels the opposite: it is a load from outside.
"""

from __future__ import annotations

from mbsd.base.codes import CONSTANT, LAW_TIME, PUSH
from mbsd.model.forces.kind import Element, ForceKind, Term, register


def _elements(force):
    law = "force" in force.laws
    term = Term(LAW_TIME, law="force") if law else Term(CONSTANT, force.params["force"])
    return (Element(PUSH, (term,)),)


FORCE = register(
    ForceKind(
        "force",
        _elements,
        example=lambda m, i, j: m.force("example", j, 3.0, direction=(0.6, 0.8), frame=i.body),
        outside=True,
    )
)
