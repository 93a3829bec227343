"""Given forces and torques, constants or laws of time: at a point, on a body, between two points.

Force at a point of a body, constant or a law of time, in a direction fixed in world or body.

    F = F(t) u        at marker j; u: x axis of marker i, on ground or on the body itself; element PUSH

Nothing feels the opposite: it is a load from outside.

Torque on a body, constant or a law of time, against ground or against another body.

T = T(t)        on body j, -T on body i; element TURN; counter-clockwise positive

Actuator between two points: a constant force or a law of time, as of a cylinder or linear motor.

    F = F(t)        along the line of the points, element LINE; or along the x axis of marker i, element AXIS

Positive F pushes the points apart, or marker j along the axis; body i feels the opposite.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd.base.arguments import several_numbers
from mbsd.base.codes import AXIS, CONSTANT, LAW_TIME, LINE, PUSH, TURN
from mbsd.base.errors import ModelError
from mbsd.model.body import Body, Marker
from mbsd.model.entries import (
    Amount,
    add_force,
    amount_given,
    origins,
)
from mbsd.model.force import Element, Force, ForceKind, Term, register_force
from mbsd.model.mechanism import Model, number_given, own_body


def _force_elements(force):
    law = "force" in force.laws
    term = Term(LAW_TIME, law="force") if law else Term(CONSTANT, force.params["force"])
    return (Element(PUSH, (term,)),)


FORCE = register_force(
    ForceKind(
        "force",
        _force_elements,
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


def _turning_elements(force):
    law = "torque" in force.laws
    term = Term(LAW_TIME, law="torque") if law else Term(CONSTANT, force.params["torque"])
    return (Element(TURN, (term,)),)


TORQUE = register_force(
    ForceKind(
        "torque",
        _turning_elements,
        effort="torque",
        example=lambda m, i, j: m.torque("example", j.body, 1.7, against=i.body),
    )
)


@TORQUE.adds
def torque(m: Model, name: str, body: Body | str, torque: Amount, against: Body | str | None = None) -> Force:
    """Add a torque (N m) on a body, a constant or a law; ``against`` (default ground) takes the opposite."""
    params, laws = amount_given(m, name, "torque", torque)
    return add_force(m, TORQUE, name, *origins(m, name, m.ground if against is None else against, body), params, laws)


def _actuator_elements(force):
    term = Term(LAW_TIME, law="force") if "force" in force.laws else Term(CONSTANT, force.params["force"])
    return (Element(AXIS if force.params["along_axis"] else LINE, (term,)),)


ACTUATOR = register_force(
    ForceKind(
        "actuator",
        _actuator_elements,
        effort="force",
        look="cylinder",
        example=lambda m, i, j: m.actuator("example", i, j, 12.0, along_axis=True),
    )
)


@ACTUATOR.adds
def actuator(m: Model, name: str, i: Marker, j: Marker, force: Amount, along_axis: bool = False) -> Force:
    """Add a force (N) between two points, or on j along the x axis of marker i; positive pushes apart.

    It is a constant or a law of time.
    """
    params, laws = amount_given(m, name, "force", force)
    return add_force(m, ACTUATOR, name, i, j, {**params, "along_axis": bool(along_axis)}, laws)
