"""Actuator between two points: a constant force or a law of time, as of a cylinder or linear motor.

    F = F(t)        along the line of the points, element LINE; or along the x axis of marker i, element AXIS

Positive F pushes the points apart, or marker j along the axis; body i feels the opposite.
"""

from __future__ import annotations

from mbsd.base.codes import AXIS, CONSTANT, LAW_TIME, LINE
from mbsd.model.adding.forces import (
    Amount,
    add_force,
    amount_given,
)
from mbsd.model.body import Marker
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model


def _elements(force):
    term = Term(LAW_TIME, law="force") if "force" in force.laws else Term(CONSTANT, force.params["force"])
    return (Element(AXIS if force.params["along_axis"] else LINE, (term,)),)


ACTUATOR = register(
    ForceKind(
        "actuator",
        _elements,
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
