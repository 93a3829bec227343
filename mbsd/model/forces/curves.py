"""Forces and torques by characteristic curves, among them motors.

Force between two points by characteristic curves of their distance and of its rate.

    F = f(l) + g(l')        l = |p_j - p_i|, element LINE; positive F pushes the points apart

f is elastic: its integral is potential energy. Source: Haug 1989, ch. 6.2.

Torque between two bodies by curves of their angle and its rate, as of a motor or a soft stop.

    T = f(theta_j - theta_i) + g(omega_j - omega_i)        on body j, -T on body i; element TURN

f is elastic: its integral is potential energy. A motor's torque-speed curve is g.
"""

from __future__ import annotations

from mbsd.base.codes import LAW_RATE, LAW_VALUE, LINE, TURN
from mbsd.model.body import Body, Marker
from mbsd.model.entries import (
    add_force,
    curves_given,
    origins,
)
from mbsd.model.force import Element, Force, ForceKind, Term, register_force
from mbsd.model.laws.curve import Curve, curve
from mbsd.model.mechanism import Model


def _curve_of_length_elements(force):
    terms = [Term(LAW_VALUE, law="of_length")] if "of_length" in force.laws else []
    terms += [Term(LAW_RATE, law="of_rate")] if "of_rate" in force.laws else []
    return (Element(LINE, tuple(terms)),)


CURVE_OF_LENGTH = register_force(
    ForceKind(
        "curve_of_length",
        _curve_of_length_elements,
        look="coil",
        example=lambda m, i, j: m.curve_of_length(
            "example",
            i,
            j,
            curve([0.1, 0.8, 1.6, 4.0], [9.0, 2.0, -1.0, -7.0]),
            curve([-3.0, 0.0, 3.0], [4.0, 0.0, -2.0]),
        ),
    )
)


@CURVE_OF_LENGTH.adds
def curve_of_length(
    m: Model, name: str, i: Marker, j: Marker, of_length: Curve | None = None, of_rate: Curve | None = None
) -> Force:
    """Force (N, apart positive) by curves of the distance (m) of two points and of its rate (m/s)."""
    return add_force(m, CURVE_OF_LENGTH, name, i, j, {}, curves_given(m, name, of_length=of_length, of_rate=of_rate))


def _curve_of_angle_elements(force):
    terms = [Term(LAW_VALUE, law="of_angle")] if "of_angle" in force.laws else []
    terms += [Term(LAW_RATE, law="of_rate")] if "of_rate" in force.laws else []
    return (Element(TURN, tuple(terms)),)


CURVE_OF_ANGLE = register_force(
    ForceKind(
        "curve_of_angle",
        _curve_of_angle_elements,
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
