"""Events of the user, and what a simulation reports about the events it met."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, shown
from mbsd.base.pickled import WithFunctions
from mbsd.model.body import Body, Marker


@dataclass(frozen=True, eq=False)
class Event(Suggesting, WithFunctions):
    """Scalar function that a simulation monitors; see :meth:`mbsd.mechanism.Mechanism.event`."""

    name: str
    value: Callable[..., float]
    direction: int = 0
    """1: where it rises through zero; -1: where it falls; 0: both."""
    terminal: bool = False
    action: Callable[..., object] | None = None
    shortest: float | None = None
    """Duration of the shortest feature of the function (s)."""
    frames: tuple[Marker, ...] = ()
    """Frames whose places and velocities the functions get as numbers; where there are none they get the moment."""
    releases: tuple[str, ...] = ()
    """Joints and drivers that it releases for good."""

    @property
    def acts(self) -> bool:
        """True if it changes the motion."""
        return self.action is not None or bool(self.releases)

    def value_at(self, moment: Any) -> Any:
        """Return the value of the function at a moment of a simulation."""
        if self.frames and not isinstance(self.value, Reaching):
            return self.value(moment.t, *moment.numbers(self.frames))
        return self.value(moment.t, moment)

    def moved(self, move: Callable[[Marker], Marker]) -> Event:
        """The same with its markers moved."""
        value = self.value
        if isinstance(value, Reaching):
            value = replace(value, frames=tuple(map(move, value.frames)))
        return replace(self, value=value, frames=tuple(map(move, self.frames)))


@dataclass(frozen=True)
class Happening(Suggesting):
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


@dataclass(frozen=True, eq=False)
class Reaching:
    """A ready-made function of an event: a number of some frames less a level."""

    measured: Callable[[float, Any, Any], float]
    """A function of the time, places and velocities of the frames, as functions of the user get them."""
    frames: tuple[Marker, ...]
    level: float

    def __call__(self, t: float, moment: Any) -> float:
        """Its value at a moment."""
        return self.measured(t, *moment.numbers(self.frames)) - self.level


def turned(t: float, q: Any, v: Any) -> float:
    """The angle of the first frame (rad)."""
    return q[2]


def distance(t: float, q: Any, v: Any) -> float:
    """From the first frame to the second (m)."""
    return math.hypot(q[3] - q[0], q[4] - q[1])


def turning(t: float, q: Any, v: Any) -> float:
    """The angular velocity of the first frame (rad/s)."""
    return v[2]


def angle_reaches(body: Body, angle: float) -> Callable[[float, Any], float]:
    """Event function: the angle of a body (rad, counted over turns) less ``angle``."""
    _check_type("angle_reaches", body, Body)
    return Reaching(turned, (body.origin,), finite_number("angle_reaches: angle", angle))


def distance_reaches(i: Marker, j: Marker, length: float) -> Callable[[float, Any], float]:
    """Event function: the distance of two points (m) less ``length``."""
    _check_type("distance_reaches", i, Marker)
    _check_type("distance_reaches", j, Marker)
    return Reaching(distance, (i, j), finite_number("distance_reaches: length", length))


def speed_reaches(body: Body, omega: float) -> Callable[[float, Any], float]:
    """Event function: the angular velocity of a body (rad/s) less ``omega``."""
    _check_type("speed_reaches", body, Body)
    return Reaching(turning, (body.origin,), finite_number("speed_reaches: omega", omega))


def _check_type(what: str, value: object, wanted: type) -> None:
    if not isinstance(value, wanted):
        raise ModelError(f"{what} needs a {wanted.__name__.lower()}, got {shown(value)}")
