"""Events of the user, and what a simulation reports about the events it met."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.pickled import WithFunctions
from mbsd.base.shown import shown
from mbsd.model.body import Body, Marker


@dataclass(frozen=True, eq=False)
class Event(WithFunctions):
    """A scalar function of time and motion that a simulation monitors; see :meth:`mbsd.mechanism.Mechanism.event`."""

    name: str
    value: Callable[[float, Any], float]
    direction: int = 0
    """1: where it rises through zero; -1: where it falls; 0: both."""
    terminal: bool = False
    action: Callable[[Any], object] | None = None
    shortest: float | None = None
    """How long the shortest thing in the function lasts (s)."""


@dataclass(frozen=True)
class Happening:
    """One event of a simulation; of a sweep, a law that makes forces jump."""

    time: float
    """s"""
    name: str
    """Name of the event, contact, stop, clutch, force or driver."""
    what: str
    """event, end, impact, closes, opens, sticks, slides; jumps, of a force or driver whose law does."""
    impulse: float = 0.0
    """Impulse of an impact, normal (N s; N m s of stops of angles)."""
    energy: float = 0.0
    """Kinetic energy after less before (J), of all that happens at this time; given once."""


def angle_reaches(body: Body, angle: float) -> Callable[[float, Any], float]:
    """Event function: the angle of a body (rad, counted over turns) less ``angle``."""
    _refuse_other("angle_reaches", body, Body)
    angle = finite_number("angle_reaches: angle", angle)
    return lambda t, moment: moment.body(body.name).theta - angle


def distance_reaches(i: Marker, j: Marker, length: float) -> Callable[[float, Any], float]:
    """Event function: the distance of two points (m) less ``length``."""
    _refuse_other("distance_reaches", i, Marker)
    _refuse_other("distance_reaches", j, Marker)
    length = finite_number("distance_reaches: length", length)

    def value(t: float, moment: Any) -> float:
        first, second = moment.point(i), moment.point(j)
        return math.hypot(second.x - first.x, second.y - first.y) - length

    return value


def speed_reaches(body: Body, omega: float) -> Callable[[float, Any], float]:
    """Event function: the angular velocity of a body (rad/s) less ``omega``."""
    _refuse_other("speed_reaches", body, Body)
    omega = finite_number("speed_reaches: omega", omega)
    return lambda t, moment: moment.body(body.name).omega - omega


def _refuse_other(what: str, value: object, wanted: type) -> None:
    if not isinstance(value, wanted):
        raise ModelError(f"{what} needs a {wanted.__name__.lower()}, got {shown(value)}")
