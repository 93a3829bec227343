"""Runs with events of users: compiled and Python functions, actions and releases."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numba

from mbsd import Mechanism, angle_reaches, distance_reaches, speed_reaches
from tools.models import contact_models, releases, sticking, stops, user_events
from tools.models.contact_models import G
from tools.numbers.events.record import Case

CHAOS = "impacts and actions multiply small differences"
KINKS = "friction has kinks where joints stick and slide"
SHORT = "an event that lasts a moment is found by the bottom of its value"


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield from _compiled()
    yield from _of_moments()
    yield from _short()
    yield from _releases()


@numba.njit
def low(t, q, v):
    """Height of the first frame over 0.3 m."""
    return q[1] - 0.3


@numba.njit
def turned_back(t, q, v):
    """Velocities of a frame that bounces off something heavy."""
    return -0.8 * v[0], v[1], v[2] + 1.0


@numba.njit
def right(t, q, v):
    """Way of the first frame beyond 0.4 m."""
    return q[0] - 0.4


def _compiled() -> Iterator[Case]:
    yield Case("swing", user_events.swing, 1.53, kink=CHAOS, quick=True)
    yield Case("swing with rows", user_events.swing, 0.93, {"event_rows": True}, kink=CHAOS)
    yield Case("bat and ball", user_events.ball, 1.03, kink=CHAOS, quick=True)
    yield Case("bearing and waves", user_events.rubbing, 1.03, kink=KINKS)
    yield Case("crank with pulses", user_events.crank, 1.53, kink=SHORT)
    for direction in (0, 1, -1):
        yield Case(f"tilted arm, direction {direction}", partial(tilted, direction), 1.53, quick=direction == 1)
    yield Case("two events at one instant", at_one_instant, 1.03)
    yield Case("wall by an action", wall, 1.43)
    yield Case("wall by an action, rows", wall, 1.43, {"event_rows": True})
    yield Case("action beside stops", action_beside_stops, 0.53, kink=CHAOS)
    yield Case("action that frees a joint that sticks", kicked_bell, 2.03, kink=KINKS)


def _of_moments() -> Iterator[Case]:
    yield Case("stone and five events", stone, 2.03, quick=True)
    yield Case("arm that is pushed", pushed, 1.03)
    yield Case("velocity that is set", velocity_set, 1.03)
    yield Case("plain functions of frames", plain_functions, 1.03)
    yield Case("sling by a moment", sling_by_a_moment, 1.03, quick=True)
    yield Case("ball and an event at its top", tops, 1.43, kink=CHAOS)
    yield Case("wave of a moment", wave, 1.03)
    yield Case("event that stays zero", stays_zero, 1.53)
    yield Case("event that a contact brings to zero", brought_to_zero, 1.03, kink=CHAOS)


def _short() -> Iterator[Case]:
    for near in (0.05, 1e-4, 1e-6):
        yield Case(f"tip that passes a point at {near:g}", partial(passing, near), 0.93, kink=SHORT)
    yield Case("thin wire", thin_wire, 0.73)
    yield Case("pulse with its shortest", pulse, 1.03, kink=SHORT)


def _releases() -> Iterator[Case]:
    built = {
        "sling": (releases.sling, 0.93),
        "chain that breaks": (releases.chain, 1.03),
        "dry chain that breaks": (releases.dry_chain, 1.03),
        "shelf": (releases.held_up, 0.93),
        "twin hinges": (releases.twin_hinges, 0.93),
        "three cranks that break": (lambda: releases.broken_cranks(releases.cranks()), 0.93),
        "three cranks that break, stops": (lambda: releases.broken_cranks(releases.cranks(stops=True)), 0.73),
        "three cranks that break, dry": (lambda: releases.broken_cranks(releases.dry(False)), 0.73),
        "three cranks that break, stick": (lambda: releases.broken_cranks(releases.dry(True)), 0.73),
        "motor that lets go": (releases.motor_and_cranks, 0.93),
        "bar that keeps its speed": (loose_bar, 1.53),
    }
    for name, (build, duration) in built.items():
        yield Case(name, build, duration, kink=CHAOS, quick=name in ("sling", "twin hinges"))


def tilted(direction: int) -> Mechanism:
    """A pendulum in a turned world that ends where it is fast."""
    angle = 1.0
    m = Mechanism("tilted", gravity=(G * math.sin(angle), -G * math.cos(angle)))
    arm = m.bar("arm", 0.5, mass=0.3)
    m.revolute("hinge", m.ground.at(0, 0), arm.start)
    m.event("low", angle_reaches(arm, angle - math.pi / 2), direction=direction)
    m.event("fast", speed_reaches(arm, 4.0), direction=direction, terminal=direction != 0)
    m.start_near(arm=math.degrees(angle) - 10)
    return m


def at_one_instant() -> Mechanism:
    """Two bodies whose events come at one instant, in the order in which they were added."""
    m = Mechanism("pair", gravity=(0, -G))
    for name, x in (("b", 0.0), ("a", 1.0)):
        ball = m.body(name, 1.0, inertia=0.1)
        m.event(f"low {name}", low, direction=-1, frames=ball)
        m.start_near(**{name: (x, 1.0, 0.0)})
    return m


def wall() -> Mechanism:
    """A sledge that an action sends back at a wall, and a spring at it again."""
    m = Mechanism("wall", gravity=None)
    sledge = m.body("sledge", 1.0, inertia=1.0)
    m.event("wall", right, direction=1, action=turned_back, frames=sledge)
    m.spring("spring", m.ground.at(1.0, 0.2), sledge.origin, 20.0, free_length=0.2)
    m.start_moving(sledge=(1.0, 0.0, 0.0))
    return m


def action_beside_stops() -> Mechanism:
    """The four-bar between stops, which an action slows each time its rocker passes the middle."""
    m = stops.barrier(True)
    m.event("middle", angle_reaches(m.bodies["rocker"], 1.8), action=user_events.halved, frames=m.bodies["rocker"])
    return m


def kicked_bell() -> Mechanism:
    """A bell whose dry bearing rests until an action kicks it off."""
    m = sticking.bell()
    clock = m.body("clock", 1.0, inertia=1.0)
    m.revolute("axle", m.ground.at(2, 0), clock.origin)
    m.event("kick", angle_reaches(clock, 1.2), action=_kick, frames=m.bodies["bar"])
    m.start_near(clock=(2, 0, 0))
    m.start_moving(clock=1.0)
    return m


@numba.njit
def _kick(t, q, v):
    return v[0], v[1], v[2] + 3.0


def stone() -> Mechanism:
    """A stone that falls past five events, the last of which ends it."""
    m = Mechanism("fall", gravity=(0.0, -G))
    body = m.body("stone", 1.0, inertia=1.0)
    m.event("half way", lambda t, moment: moment.body("stone").y - 5.0)
    m.event("upwards", lambda t, moment: moment.body("stone").y - 7.0, direction=1)
    m.event("near", distance_reaches(m.ground.origin, body.origin, 4.0))
    m.event("fast", speed_reaches(body, 1.0))
    m.event("down", lambda t, moment: moment.point(body.origin).y, direction=-1, terminal=True)
    m.start_near(stone=(0, 10, 0))
    return m


def pushed() -> Mechanism:
    """A hinged arm that gets an impulse at its end at a time."""
    m = Mechanism("hit", gravity=(0, -G))
    arm = m.bar("arm", 1.0, mass=3.0)
    m.revolute("A", m.ground.origin, arm.start)
    m.event("now", lambda t, moment: t - 0.5, action=lambda moment: moment.push(arm.end, 0.3, 2.0, 0.1))
    return m


def velocity_set() -> Mechanism:
    """A double pendulum whose lower bar an action stops; its joints take away what they forbid."""
    m = Mechanism("set", gravity=(0, -G))
    a, b = m.bar("a", 0.6, mass=1.0), m.bar("b", 0.4, mass=0.5)
    m.revolute("A", m.ground.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.event(
        "low",
        lambda t, moment: moment.point(b.end).y + 0.7,
        direction=-1,
        action=lambda moment: moment.set_velocity("b", 0.2, 0.0, -1.0),
    )
    m.start_near(a=-10, b=20)
    return m


def plain_functions() -> Mechanism:
    """A ball that a Python function of its numbers throws up again; another ends it."""
    m = Mechanism("juggled", gravity=(0, -G))
    ball = m.body("ball", mass=0.2, inertia=1e-4)
    m.event("hit", lambda t, q, v: q[1] - 0.6, -1, action=lambda t, q, v: (v[0] + 0.1, 2.0, v[2] - 3.0), frames=ball)
    m.event("far", lambda t, q, v: q[0] - 0.15, frames=ball, terminal=True)
    m.start_near(ball=(0, 1, 0))
    return m


def sling_by_a_moment() -> Mechanism:
    """An arm that an action of a moment releases."""
    m = Mechanism("sling", gravity=(0, -G))
    arm = m.bar("arm", 0.5, mass=0.3)
    m.revolute("hinge", m.ground.at(0, 1), arm.start)
    m.torque("spring", arm, 4.0)
    m.event("release", angle_reaches(arm, math.pi / 4), action=lambda moment: moment.release("hinge"))
    m.event("lands", lambda t, moment: moment.body("arm").y, direction=-1, terminal=True)
    m.start_near(arm=-90)
    return m


def tops() -> Mechanism:
    """A bouncing ball whose tops are events."""
    m = contact_models.ball(0.7, 0.5)
    m.event("top", lambda t, moment: moment.body("ball").vy, direction=-1)
    return m


def wave() -> Mechanism:
    """A wave of 30 Hz."""
    m = Mechanism("sledge", gravity=None)
    m.body("sledge", 1.0, inertia=1.0)
    m.event("wave", lambda t, moment: math.sin(2 * math.pi * 30 * t + moment.body("sledge").x) - 0.3)
    m.start_moving(sledge=(1.0, 0.0, 0.0))
    return m


def stays_zero() -> Mechanism:
    """An arm that lets go at a speed, which it keeps: that is one event."""
    m = Mechanism("loose", gravity=(0, -G))
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("hinge", m.ground.at(0, 0), arm.start)
    m.event("gone", lambda t, moment: moment.body("arm").omega + 3.0, action=lambda moment: moment.release("hinge"))
    m.start_near(arm=0)
    return m


def brought_to_zero() -> Mechanism:
    """A ball's speed, which its plastic contact brings to zero, where it stays."""
    m = contact_models.ball(0.0, 0.5)
    m.event("still", lambda t, moment: moment.body("ball").vy + 1e-9)
    return m


def passing(near: float) -> Mechanism:
    """A tip that is so near to a point for a moment."""
    m, angle = Mechanism("pendulum"), 0.2 - math.pi / 2
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("hinge", m.ground.origin, arm.start)
    m.event("near", distance_reaches(m.ground.at(math.cos(angle), math.sin(angle)), arm.end, near))
    m.start_near(arm=-30)
    return m


def thin_wire() -> Mechanism:
    """A sledge that meets a wire of a micrometre."""
    m = Mechanism("sledge", gravity=None)
    sledge = m.body("sledge", 1.0, inertia=1.0)
    m.rigid_discs("wire", m.ground.at(0.123, 0), sledge.origin, radius_i=1e-6, radius_j=1e-6, restitution=0.5)
    m.start_moving(sledge=(1.0, 0.0, 0.0))
    return m


def pulse() -> Mechanism:
    """A value that is below zero for a tenth of a millisecond, as its shortest says."""
    m = Mechanism("sledge", gravity=None)
    sledge = m.body("sledge", 1.0, inertia=1.0)
    m.event(
        "pulse", lambda t, moment: 1 - 2 * math.exp(-(((moment.body("sledge").x - 0.3333) / 1e-4) ** 2)), shortest=1e-4
    )
    m.event("there", lambda t, moment: moment.point(sledge.at(0.1, 0.0)).x - 0.7, action=_slowed)
    m.start_moving(sledge=(1.0, 0.0, 0.0))
    return m


def _slowed(moment) -> None:  # type: ignore[no-untyped-def]
    moment.set_velocity("sledge", 0.5 * moment.body("sledge").vx, 0.0, 0.2)


def loose_bar() -> Mechanism:
    """A bar that lets go at a speed, by name."""
    m = Mechanism("loose", gravity=(0, -G))
    arm = m.bar("arm", 1.0, mass=1.0)
    hinge = m.revolute("hinge", m.ground.at(0, 0), arm.start)
    m.event("gone", speed_reaches(arm, -3.0), releases=[hinge])
    m.event("seen", distance_reaches(m.ground.at(0, -2), arm.end, 1.5))
    m.start_near(arm=0)
    return m
