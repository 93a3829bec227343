"""Force at a point of a body, constant or a law of time, in a direction fixed in world or body.

    F = F(t) u        at marker j; u: x axis of marker i, on ground or on the body itself; element PUSH

Nothing feels the opposite: it is a load from outside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd.base.arguments import several_numbers
from mbsd.base.codes import CONSTANT, LAW_TIME, PUSH
from mbsd.base.errors import ModelError
from mbsd.model.adding.forces import (
    Amount,
    add_force,
    amount_given,
)
from mbsd.model.body import Body, Marker
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model, number_given, own_body


def _elements(force):
    law = "force" in force.laws
    term = Term(LAW_TIME, law="force") if law else Term(CONSTANT, force.params["force"])
    return (Element(PUSH, (term,)),)


FORCE = register(
    ForceKind(
        "force",
        _elements,
        effort="force",
        example=lambda m, i, j: m.force("example", j, 3.0, direction=(0.6, 0.8), frame=i.body),
        outside=True,
    )
)


@FORCE.adds
def force(
    m: Model,
    name: str,
    at: Marker,
    force: Amount,
    direction: Sequence[float] | float = (1.0, 0.0),
    frame: Body | str | None = None,
) -> Force:
    """Force (N) at a marker, a constant or a law of time.

    ``direction``: a vector, or an angle (rad), in the axes of body ``frame``: ground by default, so that it is
    fixed in the world; the body itself makes it turn with the body.
    """
    if isinstance(direction, int | float | np.number):
        angle = number_given(m, f"force '{name}': direction", direction)
    else:
        what = f"{m.name}: force '{name}': direction"
        x, y = several_numbers(what, direction, 2, "give an angle (rad) or a vector (x, y)")
        if x == 0.0 and y == 0.0:
            raise ModelError(f"{m.name}: force '{name}' has no direction; give a vector that is not zero")
        angle = math.atan2(y, x)
    params, laws = amount_given(m, name, "force", force)
    params["direction"] = angle
    base = own_body(m, m.ground if frame is None else frame, f"force '{name}'")
    return add_force(m, FORCE, name, base.at(0.0, 0.0, angle), at, params, laws, same_body=True)
