"""Actuator between two points: a force that is constant or a law of time, as a cylinder or a linear motor gives it.

    F = F(t)        along the line of the points, element LINE; or along the x axis of marker i, element AXIS

Positive F pushes the points apart, or marker j along the axis; body i feels the opposite.
"""

from __future__ import annotations

from mbsd.base.codes import AXIS, CONSTANT, LAW_TIME, LINE
from mbsd.model.forces.kind import Element, ForceKind, Term, register


def _elements(force):
    term = Term(LAW_TIME, law="force") if "force" in force.laws else Term(CONSTANT, force.params["force"])
    return (Element(AXIS if force.params["along_axis"] else LINE, (term,)),)


ACTUATOR = register(
    ForceKind("actuator", _elements, example=lambda m, i, j: m.actuator("example", i, j, 12.0, along_axis=True))
)
