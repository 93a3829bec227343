"""Torque between two bodies by curves of their angle and its rate, as of a motor or a soft stop.

    T = f(theta_j - theta_i) + g(omega_j - omega_i)        on body j, -T on body i; element TURN

f is elastic: its integral is potential energy. A motor's torque-speed curve is g.
"""

from __future__ import annotations

from mbsd.base.codes import LAW_RATE, LAW_VALUE, TURN
from mbsd.model.adding.forces import (
    add_force,
    curves_given,
    origins,
)
from mbsd.model.body import Body
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.laws.curve import Curve, curve
from mbsd.model.mechanism import Model


def _elements(force):
    terms = [Term(LAW_VALUE, law="of_angle")] if "of_angle" in force.laws else []
    terms += [Term(LAW_RATE, law="of_rate")] if "of_rate" in force.laws else []
    return (Element(TURN, tuple(terms)),)


CURVE_OF_ANGLE = register(
    ForceKind(
        "curve_of_angle",
        _elements,
        look="spiral",
        motor="of_rate",
        example=lambda m, i, j: m.curve_of_angle(
            "example",
            i.body,
            j.body,
            curve([-3.0, 0.0, 3.0], [5.0, 1.0, -4.0]),
            curve([-3.0, 0.0, 3.0], [4.0, 0.0, -2.0]),
        ),
        also={"torque_speed": "of_rate"},
    )
)


@CURVE_OF_ANGLE.adds
def curve_of_angle(
    m: Model,
    name: str,
    first: Body | str,
    second: Body | str,
    of_angle: Curve | None = None,
    of_rate: Curve | None = None,
) -> Force:
    """Add a torque (N m) on ``second`` by curves of its angle against ``first`` (rad) and of the rate."""
    laws = curves_given(m, name, of_angle=of_angle, of_rate=of_rate)
    return add_force(m, CURVE_OF_ANGLE, name, *origins(m, name, first, second), {}, laws)


def motor(m: Model, name: str, first: Body | str, second: Body | str, torque_speed: Curve) -> Force:
    """A motor on body ``first`` that turns ``second``: its torque (N m) over their relative speed (rad/s)."""
    return curve_of_angle(m, name, first, second, of_rate=torque_speed)
