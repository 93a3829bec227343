"""Cables over wheels: ropes, chains and belts, of constant length, that do not slip on their wheels.

A cable is a row of spans, each the straight piece from one wheel to the next:

    Phi_k = L_k - h_k phi_k + s_k+1 a_k - c_k        constraint `span`, 1 row; see mbsd/equations/relative/span.py

L_k is the length of the piece and the other terms say how much cable the wheels at its ends have wound on and off, so
the sum of all spans is the length of the whole cable. The ends of a cable are points, or drums on which it winds. A
wheel without mass, and without friction at its axle, passes the tension on; a wheel with mass, a brake or a motor makes
a difference between the tensions at its sides. The reaction on the body of a span's second end is the pull of the
cable, along the piece: its tension.

    taut     Phi_k = 0                      tensions may become negative: a cable that would push
    slack    g = -Phi_k >= 0, T >= 0        of one span, a contact: in simulations alone; it stops with an impact

One span is enough to let the whole cable hang slack, since the wheels then pass on no tension.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Marker
from mbsd.model.entries import add_contact, join
from mbsd.model.joint import ContactKind, Joint, JointKind, register_contact, register_joint
from mbsd.model.joints.pairs import revolute
from mbsd.model.mechanism import Model, connections, length_given, new_name, not_negative, number_given, own_body


@dataclass(frozen=True)
class Wheel:
    """A wheel on a cable's way, as :func:`over` returns it."""

    marker: Marker
    """Its centre, on the body that turns with the cable."""
    radius: float
    """m, to the middle of the cable; 0 at a point that carries an end."""
    clockwise: bool
    """True if the cable, followed from its first end, turns clockwise about the centre."""
    slides: bool = False
    """True if the cable slides round the body without friction."""

    @property
    def signed(self) -> float:
        """The radius (m), negative where the cable turns clockwise."""
        return -self.radius if self.clockwise else self.radius


def over(m: Model, centre: Marker, radius: float, clockwise: bool = True, slides: bool = False) -> Wheel:
    """Return a wheel of ``radius`` (m) about ``centre``, for the way of :func:`cable`.

    The cable does not slip on the body of ``centre``, which turns with it: a pulley on its pin, a drum, the arc of a
    beam. ``clockwise``: followed from its first end the cable turns clockwise about the centre, as over the top from
    left to right; False, counter-clockwise, as below a loose pulley from left to right. ``slides``: it slides round
    the body without friction, which then need not turn.
    """
    what = f"{m.name}: over(...)"
    if not isinstance(centre, Marker):
        raise ModelError(f"{what} needs the marker of a centre, got {shown(centre)}; write pulley.at(0, 0)")
    own_body(m, centre.body, "over(...)")
    size = length_given(m, "over(...) has a radius of", radius)
    return Wheel(centre, size, bool(clockwise), bool(slides))


def _problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    """Return why no straight piece joins two wheels with their centres (x, y) apart (m); None if one does."""
    first, second = params["radius_i"], params["radius_j"]
    crosses = params["clockwise_i"] != params["clockwise_j"]
    distance, least = math.hypot(x, y), first + second if crosses else abs(first - second)
    if distance > least:
        return None
    why = "it crosses between the wheels, which must be apart" if crosses else "neither wheel may be in the other"
    return (
        f"its centres are {distance:.6g} m apart, but {why}: with radii of {first:g} m and {second:g} m they need more "
        f"than {least:.6g} m. Move a centre, give smaller radii, or change clockwise= of a wheel"
    )


def signed_radii(params: Mapping[str, Any]) -> tuple[float, float]:
    """Return the radii (m) of both wheels of a span, negative where the cable turns clockwise."""
    first, second = params["radius_i"], params["radius_j"]
    return -first if params["clockwise_i"] else first, -second if params["clockwise_j"] else second


def span_direction(gap: np.ndarray, radii: tuple[float, float]) -> np.ndarray:
    """Return the direction (...,) (rad) of a span whose centres are ``gap`` (..., 2) (m) apart.

    ``radii`` are those of :func:`signed_radii`. Where there is no straight piece, it is across the gap.
    """
    distance = np.hypot(gap[..., 0], gap[..., 1])
    lean = np.arcsin(np.clip((radii[1] - radii[0]) / distance, -1.0, 1.0))
    return np.arctan2(gap[..., 1], gap[..., 0]) - lean


CABLE_SPAN = register_joint(
    JointKind(
        "cable_span",
        ("span",),
        look="cord",
        example=lambda m, i, j: m.cable_span("example", i, j, radius_i=0.1, radius_j=0.05, clockwise_j=True),
        numbers=lambda params: [(*signed_radii(params), 1.0)],
        problem=_problem,
        lengths=("radius_i", "radius_j"),
        touching="place",
    )
)
SLACK_SPAN = register_contact(
    ContactKind(
        "slack_span",
        ("span",),
        look="cord",
        example=lambda m, i, j: m.slack_span("example", i, j, radius_i=0.1, radius_j=0.05, clockwise_j=True),
        numbers=lambda params: [(*signed_radii(params), -1.0)],
        problem=_problem,
        lengths=("radius_i", "radius_j"),
        touching="place",
    )
)


def _wheels_given(
    m: Model, what: str, radius_i: float, radius_j: float, clockwise_i: bool, clockwise_j: bool
) -> dict[str, Any]:
    radii = not_negative(m, what, radius_i=radius_i, radius_j=radius_j)
    return {**radii, "clockwise_i": bool(clockwise_i), "clockwise_j": bool(clockwise_j)}


@CABLE_SPAN.adds
def cable_span(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius_i: float = 0.0,
    radius_j: float = 0.0,
    clockwise_i: bool = False,
    clockwise_j: bool = False,
) -> Joint:
    """Add the straight piece of a cable between two wheels, as long as it is at the start, less what they wind on.

    The wheels have radii (m) about markers i and j; radius 0 is a point that carries the cable's end. ``clockwise_i``
    and ``clockwise_j``: followed from i to j the cable turns clockwise about that centre. See :func:`cable`.
    """
    given = _wheels_given(m, f"joint '{name}'", radius_i, radius_j, clockwise_i, clockwise_j)
    return join(m, CABLE_SPAN, name, i, j, None, **given)


@SLACK_SPAN.adds
def slack_span(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius_i: float = 0.0,
    radius_j: float = 0.0,
    clockwise_i: bool = False,
    clockwise_j: bool = False,
    slack: float = 0.0,
    restitution: float = 0.0,
) -> Joint:
    """Add the piece of :func:`cable_span` as a contact: it pulls while it is taut and carries nothing while slack.

    ``slack``: how much longer than its way it is at the start (m). ``restitution``: of the jerk as it goes taut.
    """
    given = _wheels_given(m, f"contact '{name}'", radius_i, radius_j, clockwise_i, clockwise_j)
    given |= not_negative(m, f"contact '{name}'", slack=slack)
    return add_contact(m, SLACK_SPAN, name, i, j, restitution, given)


def cable(
    m: Model,
    name: str,
    way: Sequence[Marker | Wheel],
    taut: bool = True,
    slack: float = 0.0,
    restitution: float = 0.0,
    closed: bool = False,
) -> tuple[Joint, ...]:
    """Add a cable of constant length over wheels, and return its spans, named ``name 1``, ``name 2`` and so on.

    ``way``: from end to end, markers where the ends are tied and wheels from :func:`over` between them, or at an end
    a drum that winds the cable. ``closed``: it comes back to the first wheel, as a belt with a tensioner does. It is
    as long as its way is at the start.

    ``taut``: it holds its length in sweeps and simulations, also where it would have to push. False: in simulations it
    goes slack instead, starting with ``slack`` (m) more than its way, and stops what it catches with ``restitution``.
    Round a wheel that ``slides`` the cable runs over a wheel without mass, ``name wheel 1`` and so on, on an axle.

        m.cable("hoist", [load.at(0, 0), m.over(pulley.at(0, 0), 0.1), drum_end], taut=False)
    """
    what = f"cable '{name}'"
    wheels = _way_given(m, what, way, closed)
    if taut and (slack or restitution):
        raise ModelError(f"{m.name}: {what} is taut, so slack= and restitution= do nothing; say taut=False with them")
    if closed and not taut:
        raise ModelError(f"{m.name}: {what} is closed, and goes round its wheels without an end; leave out taut=False")
    number_given(m, f"{what}: slack", slack)
    pairs = list(zip(wheels, wheels[1:] + wheels[:1] if closed else wheels[1:], strict=False))
    names = [name] if len(pairs) == 1 else [f"{name} {k}" for k in range(1, len(pairs) + 1)]
    for each in names:
        new_name(m, each, "joint", *connections(m))
    turning = {id(wheel): _turning(m, name, k, wheel) for k, wheel in enumerate(wheels, start=1)}
    spans = []
    for each, (first, second) in zip(names, pairs, strict=True):
        i, j = turning[id(first)], turning[id(second)]
        ends = (i, j, first.radius, second.radius, first.clockwise, second.clockwise)
        last = not taut and each == names[-1]
        spans.append(slack_span(m, each, *ends, slack, restitution) if last else cable_span(m, each, *ends))
    return tuple(spans)


def _way_given(m: Model, what: str, way: Sequence[Marker | Wheel], closed: bool) -> list[Wheel]:
    """Return the stations of a cable as wheels. Raises ModelError for a way that is none."""
    if isinstance(way, str) or not isinstance(way, Sequence):
        raise ModelError(f"{m.name}: {what} needs its way as a list of markers and m.over(...), got {shown(way)}")
    if len(way) < 2:
        raise ModelError(f"{m.name}: {what} has {len(way)} stations; it needs two ends, or two wheels, or more")
    out = []
    for k, station in enumerate(way):
        inside = closed or 0 < k < len(way) - 1
        if isinstance(station, Wheel):
            wheel = station
        elif isinstance(station, Marker):
            wheel = Wheel(station, 0.0, False)
        else:
            raise ModelError(f"{m.name}: {what}: station {k + 1} is {shown(station)}; give a marker or m.over(...)")
        own_body(m, wheel.marker.body, what)
        if inside and wheel.radius == 0.0:
            raise ModelError(
                f"{m.name}: {what}: station {k + 1} is a point of '{wheel.marker.body.name}' between its ends; a cable "
                "passes over m.over(centre, radius), or ends there: tie two cables to the point"
            )
        if not inside and wheel.slides:
            raise ModelError(f"{m.name}: {what} ends on a wheel that slides and would slip off; leave out slides=True")
        if inside and wheel.marker.body is m.ground and not wheel.slides:
            raise ModelError(
                f"{m.name}: {what}: station {k + 1} is a wheel of ground, which cannot turn with the cable. Give a "
                "body that a revolute joint holds there, or say slides=True"
            )
        out.append(wheel)
    return out


def _turning(m: Model, name: str, k: int, wheel: Wheel) -> Marker:
    """Return the centre of a wheel on a body that turns with the cable; adds one without mass where it slides."""
    if not wheel.slides:
        return wheel.marker
    body = m.body(f"{name} wheel {k - 1}", mass=0.0)
    revolute(m, f"{name} axle {k - 1}", wheel.marker, body.at(0.0, 0.0))
    return body.at(0.0, 0.0)
