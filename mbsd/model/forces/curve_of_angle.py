"""Torque between two bodies by characteristic curves of their angle and of its rate, as of a motor or a soft stop.

    T = f(theta_j - theta_i) + g(omega_j - omega_i)        on body j, -T on body i; element TURN

f is elastic: its integral is potential energy. A motor's torque-speed curve is g.
"""

from __future__ import annotations

from mbsd.base.codes import LAW_RATE, LAW_VALUE, TURN
from mbsd.model.forces.kind import Element, ForceKind, Term, register
from mbsd.model.laws.curve import curve


def _elements(force):
    terms = [Term(LAW_VALUE, law="of_angle")] if "of_angle" in force.laws else []
    terms += [Term(LAW_RATE, law="of_rate")] if "of_rate" in force.laws else []
    return (Element(TURN, tuple(terms)),)


CURVE_OF_ANGLE = register(
    ForceKind(
        "curve_of_angle",
        _elements,
        example=lambda m, i, j: m.curve_of_angle(
            "example",
            i.body,
            j.body,
            curve([-3.0, 0.0, 3.0], [5.0, 1.0, -4.0]),
            curve([-3.0, 0.0, 3.0], [4.0, 0.0, -2.0]),
        ),
    )
)
