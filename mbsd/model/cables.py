"""Cables over wheels: ropes, chains and belts, of constant length or elastic, that do not slip on their wheels.

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

An elastic cable has the same spans. Its stretch x lies between a wheel and another one without mass about the same
centre, on which the cable goes on: one in each stretch between ends and wheels that hold it.

    T = T_0 + k x + d x',   x = R (turn of one wheel against the other since the start),   never below 0 if it slackens

Round a rough wheel a cable sticks or slips, a capstan:

    T_2 = T_1 e^(+-mu wrap) while it slips,   |T_2 - T_1| <= (T_1 + T_2) tanh(mu wrap / 2)      Euler, Eytelwein

It is the friction, by events, of a wheel without mass against the body, whose normal force is the right-hand side. Its
wrap is the angle between both spans, from 0 to a turn, and whole turns. Source: Johnson, Contact Mechanics, ch. 8.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.base.codes import TURN
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import HIDDEN, Marker
from mbsd.model.entries import above_zero, add_contact, add_force, amounts_given, join
from mbsd.model.force import Element, Force, ForceKind, Interaction, Masses, register_force
from mbsd.model.joint import ContactKind, Joint, JointKind, register_contact, register_joint
from mbsd.model.joints.pairs import revolute
from mbsd.model.mechanism import (
    Model,
    connections,
    length_given,
    new_name,
    not_negative,
    number_given,
    own_body,
    own_joint,
)


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
    """True if the cable slides round the body."""
    friction: float = 0.0
    """Coefficient of friction between the cable and a body that it slides round."""
    turns: int = 0
    """Whole turns of the cable about it, beyond the angle between its spans."""

    @property
    def signed(self) -> float:
        """The radius (m), negative where the cable turns clockwise."""
        return -self.radius if self.clockwise else self.radius


def over(
    m: Model,
    centre: Marker,
    radius: float,
    clockwise: bool = True,
    slides: bool = False,
    friction: float = 0.0,
    turns: int = 0,
) -> Wheel:
    """Return a wheel of ``radius`` (m) about ``centre``, for the way of :func:`cable`.

    The cable does not slip on the body of ``centre``, which turns with it: a pulley on its pin, a drum, the arc of a
    beam. ``clockwise``: followed from its first end the cable turns clockwise about the centre, as over the top from
    left to right; False, counter-clockwise, as below a loose pulley from left to right. ``slides``: it slides round
    the body without friction, which then need not turn. With ``friction``, a coefficient, it slides where the pulls at
    both sides have the ratio e^(friction wrap), and sticks below; ``turns``: whole turns beyond the angle between both.
    """
    what = f"{m.name}: over(...)"
    if not isinstance(centre, Marker):
        raise ModelError(f"{what} needs the marker of a centre, got {shown(centre)}; write pulley.at(0, 0)")
    own_body(m, centre.body, "over(...)")
    size = length_given(m, "over(...) has a radius of", radius)
    coefficient = not_negative(m, "over(...)", friction=friction)["friction"]
    if isinstance(turns, bool) or not isinstance(turns, int) or turns < 0 or (turns and not coefficient):
        raise ModelError(f"{what} has turns = {shown(turns)}; give a whole number from 0 on, and friction= with it")
    return Wheel(centre, size, bool(clockwise), bool(slides) or coefficient > 0.0, coefficient, turns)


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


def _turned_potential(force: Force, turned: np.ndarray) -> np.ndarray:
    """Return (T,) energy (J) of a stretch at turns of its wheels against each other since the start (rad)."""
    p = force.params
    pull = p["preload"] + p["stiffness"] * _signed(p) * turned
    return 0.5 * (np.maximum(pull, 0.0) if p["slackens"] else pull) ** 2 / p["stiffness"]


def _signed(params: Mapping[str, Any]) -> float:
    return -params["radius"] if params["clockwise"] else params["radius"]


def _stretch(force: Force, masses: Masses) -> tuple[Interaction, ...]:
    p = force.params
    numbers = [0.0, _signed(p), p["stiffness"], p["damping"], p["preload"], float(p["slackens"])]
    return (Interaction("cable_spring", force.i, force.j, numbers, phased=True),)


CABLE_SPRING = register_force(
    ForceKind(
        "cable_spring",
        interactions=_stretch,
        counts_turn=True,
        restarted=lambda force, turned: {
            "preload": force.params["preload"] + force.params["stiffness"] * _signed(force.params) * turned
        },
        depth_potential=_turned_potential,
        along=lambda force: Element(TURN, ()),
        example=lambda m, i, j: m.cable_spring("example", i, j, 0.3, 90.0, damping=0.4, preload=2.0),
    )
)


@CABLE_SPRING.adds
def cable_spring(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius: float,
    stiffness: float,
    damping: float = 0.0,
    preload: float = 0.0,
    clockwise: bool = False,
    slackens: bool = False,
) -> Force:
    """Add the stretch of a cable between wheels of one ``radius`` (m) about the same centre.

    It pulls with ``preload`` (N) at the start, and with ``stiffness`` (N/m) and ``damping`` (N s/m) more as wheel j
    turns on counter-clockwise, or ``clockwise``; one that ``slackens`` never pushes.
    """
    params = above_zero(m, name, radius=radius, stiffness=stiffness) | amounts_given(m, name, damping=damping)
    params |= {"preload": number_given(m, f"force '{name}': preload", preload)}
    params |= {"clockwise": bool(clockwise), "slackens": bool(slackens)}
    return add_force(m, CABLE_SPRING, name, i, j, params)


def _rough_example(m: Any, i: Marker, j: Marker) -> None:
    anchor = m.body("anchor of example", mass=1.0, inertia=0.1)
    m.revolute("wheel of example", i, j)
    m.cable_span("before example", anchor.at(-3, -2), j, radius_j=0.1, clockwise_j=True)
    m.cable_span("after example", j, i.body.at(i.x + 2, i.y - 1), radius_i=0.1, clockwise_i=True)
    spans = "before example", "after example"
    m.capstan("example", "wheel of example", *spans, 0.3, radius=0.1, clockwise=True, sticks=False)


CAPSTAN = register_force(ForceKind("capstan", example=_rough_example, of_reactions=True, of_spans=True))


@CAPSTAN.adds
def capstan(
    m: Model,
    name: str,
    joint: Joint | str,
    before: str,
    after: str,
    coefficient: float,
    radius: float,
    clockwise: bool = False,
    turns: int = 0,
    sticks: bool = True,
    slip_speed: float = 1e-3,
) -> Force:
    """Add friction about a pin from the pulls of the spans ``before`` and ``after`` a wheel.

    ``coefficient`` of the cable on the wheel of this ``radius`` (m); ``turns``: whole turns beyond the angle between
    both spans. One that does not stick creeps below some ``slip_speed`` (m/s).
    """
    pin, spans = own_joint(m, joint, f"force '{name}'"), {"before": before, "after": after}
    for what, span in spans.items():
        if own_joint(m, span, f"force '{name}': {what}").kind is not CABLE_SPAN:
            raise ModelError(f"{m.name}: force '{name}': {what} is '{span}', which is not a cable_span")
    params = {**amounts_given(m, name, coefficient=coefficient, turns=turns), "turns": int(turns)}
    params |= above_zero(m, name, radius=radius, slip_speed=slip_speed)
    params |= {"joint": pin.name, **spans, "clockwise": bool(clockwise), "sticks": bool(sticks)}
    return add_force(m, CAPSTAN, name, pin.i, pin.j, params)


def cable(
    m: Model,
    name: str,
    way: Sequence[Marker | Wheel],
    taut: bool = True,
    slack: float = 0.0,
    restitution: float = 0.0,
    closed: bool = False,
    stiffness: float | None = None,
    damping: float = 0.0,
    preload: float = 0.0,
) -> tuple[Joint, ...]:
    """Add a cable over wheels, and return its spans, named ``name 1``, ``name 2`` and so on.

    ``way``: from end to end, markers where the ends are tied and wheels from :func:`over` between them, or at an end
    a drum that winds the cable. ``closed``: it comes back to the first wheel, as a belt with a tensioner does. It is
    as long as its way is at the start.

    ``taut``: it holds its length in sweeps and simulations, also where it would have to push. False: in simulations it
    goes slack instead, starting with ``slack`` (m) more than its way, and stops what it catches with ``restitution``.
    Round a wheel that ``slides`` the cable runs over a wheel without mass, ``name wheel 1`` and so on, on an axle.

    ``stiffness`` (N/m), ``damping`` (N s/m) and ``preload`` (N, at the start) make it elastic: each is that of every
    stretch between ends and wheels that do not slide, of which one wheel at least must be a part. It is constant, also
    where a drum winds the cable. With ``taut=False`` an elastic cable goes slack without a jerk.

        m.cable("hoist", [load.at(0, 0), m.over(pulley.at(0, 0), 0.1), drum_end], taut=False)
    """
    what = f"cable '{name}'"
    wheels = _way_given(m, what, way, closed)
    if taut and (slack or restitution):
        raise ModelError(f"{m.name}: {what} is taut, so slack= and restitution= do nothing; say taut=False with them")
    if closed and not taut:
        raise ModelError(f"{m.name}: {what} is closed, and goes round its wheels without an end; leave out taut=False")
    number_given(m, f"{what}: slack", slack)
    elastic = _elastic_given(m, what, wheels, closed, stiffness, damping, preload, restitution)
    if not taut and stiffness is None and any(wheel.friction for wheel in wheels):
        raise ModelError(
            f"{m.name}: {what} has friction on a wheel and goes slack with a jerk, which mbsd does not solve; "
            "give stiffness= as well"
        )
    pairs = list(zip(wheels, wheels[1:] + wheels[:1] if closed else wheels[1:], strict=False))
    names = [name] if len(pairs) == 1 else [f"{name} {k}" for k in range(1, len(pairs) + 1)]
    for each in names:
        new_name(m, each, "joint", *connections(m))
    turning = {id(wheel): _turning(m, name, k, wheel) for k, wheel in enumerate(wheels, start=1)}
    starts = [turning[id(first)] for first, _ in pairs]
    ends = [turning[id(second)] for _, second in pairs]
    if elastic:
        elastic["preload"] -= slack * elastic["stiffness"]
        _add_stretches(m, name, pairs, starts, ends, elastic | {"slackens": not taut})
    spans = []
    for each, i, j, (first, second) in zip(names, starts, ends, pairs, strict=True):
        sizes = (i, j, first.radius, second.radius, first.clockwise, second.clockwise)
        last = not taut and not elastic and each == names[-1]
        spans.append(slack_span(m, each, *sizes, slack, restitution) if last else cable_span(m, each, *sizes))
    for k, wheel in enumerate(wheels):
        if wheel.friction:
            sides = {"before": names[k - 1], "after": names[k]}
            more = {"radius": wheel.radius, "clockwise": wheel.clockwise, "turns": wheel.turns}
            capstan(m, f"{name} friction {k}", f"{name} axle {k}", **sides, coefficient=wheel.friction, **more)
    return tuple(spans)


def _elastic_given(
    m: Model,
    what: str,
    wheels: Sequence[Wheel],
    closed: bool,
    stiffness: float | None,
    damping: float,
    preload: float,
    restitution: float,
) -> dict[str, Any]:
    """Return the numbers of an elastic cable, none of one that is not. Raises ModelError."""
    if stiffness is None:
        if damping or preload:
            raise ModelError(
                f"{m.name}: {what} has damping or preload, which only an elastic cable has; give stiffness="
            )
        return {}
    if restitution:
        raise ModelError(f"{m.name}: {what} is elastic and tightens without an impact; leave out restitution=")
    if closed and wheels[0].slides and not all(wheel.slides for wheel in wheels):
        raise ModelError(f"{m.name}: {what} is elastic and closed; begin its way at a wheel that does not slide")
    numbers = not_negative(m, what, stiffness=stiffness, damping=damping, preload=preload)
    if numbers["stiffness"] == 0.0:
        raise ModelError(f"{m.name}: {what} has the stiffness 0; leave it out for a cable of constant length")
    return numbers


def _add_stretches(
    m: Model,
    name: str,
    pairs: Sequence[tuple[Wheel, Wheel]],
    starts: list[Marker],
    ends: list[Marker],
    numbers: dict[str, Any],
) -> None:
    """Put a second wheel into each stretch of a cable, with the spring; change the markers of its spans."""
    holds = [k for k, (first, _) in enumerate(pairs) if k == 0 or not first.slides]
    for number, (begin, after) in enumerate(zip(holds, [*holds[1:], len(pairs)], strict=True), start=1):
        leaving = next((k for k in range(begin, after) if pairs[k][0].radius > 0.0), None)
        wheel = pairs[after - 1][1] if leaving is None else pairs[leaving][0]
        if wheel.radius == 0.0:
            raise ModelError(
                f"{m.name}: cable '{name}' is elastic, but passes over no wheel between two ends; write m.spring(...)"
            )
        side, k = (ends, after - 1) if leaving is None else (starts, leaving)
        centre = side[k]
        body = m.body(f"{name} stretch {number}", mass=0.0, looks=HIDDEN)
        revolute(m, f"{name} stretch axle {number}", centre, body.origin)
        clockwise = wheel.clockwise != (leaving is None)
        cable_spring(m, f"{name} spring {number}", centre, body.origin, wheel.radius, clockwise=clockwise, **numbers)
        side[k] = body.origin


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


def seen_span(m: Model, span: Joint) -> Joint:
    """Return a span between the wheels that are seen, where the second wheel of a stretch is the first one."""
    hosts = {force.j.body.name: force.i for force in m.forces.values() if force.kind is CABLE_SPRING}
    ends = {key: hosts.get(marker.body.name, marker) for key, marker in (("i", span.i), ("j", span.j))}
    return replace(span, **ends)
