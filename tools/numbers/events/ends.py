"""Runs with ends of a way: stops and limits of joints, ropes, freewheels, and stops at jumps of laws."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

from mbsd import Mechanism, function, harmonic
from tools.models import sticking, stops
from tools.models.contact_models import G
from tools.numbers.events.record import Case

REBOUNDS = "many rebounds: each divides the speed, and so multiplies errors of its time"
CHAOS = "rebounds between two ends multiply small differences"
JUMP = "a stop is reached between jumps of its load"
TAUT = "a rope that has gone taut comes loose with almost no speed"


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield from _stops()
    yield from _jumps()
    yield from _ropes()
    yield from _freewheels()


def _stops() -> Iterator[Case]:
    for restitution in (0.0, 0.5, 1.0):
        build = partial(stopped_pendulum, restitution)
        yield Case(f"pendulum at a stop {restitution:g}", build, 1.03, kink=REBOUNDS, quick=restitution == 0.5)
    yield Case("shuttle between its ends", lambda: shuttle(1.0), 4.03)
    yield Case("shuttle that loses speed", lambda: shuttle(0.6), 4.03)
    yield Case("four-bar between stops", lambda: stops.barrier(True), 0.63, kink=CHAOS, quick=True)
    yield Case("four-bar between stops, plastic", lambda: restituted(0.0), 0.53, kink=CHAOS)
    yield Case("four-bar between stops, elastic", lambda: restituted(1.0), 0.213, kink=CHAOS)
    yield Case("bumpers", stops.bumpers, 1.33, kink=CHAOS)
    yield Case("joints with limits", stops.limited, 1.23, kink=CHAOS, quick=True)
    yield Case("stop beside a link without mass", stops.massless, 1.03, kink=REBOUNDS)
    yield Case("double pendulum with two stops", double_pendulum, 0.93, kink=CHAOS)
    yield Case("two stops at one instant", two_stops, 1.03, even=True, kink=REBOUNDS)
    yield Case("arm that starts at its stop", lambda: pressed_arm(-30.0), 0.93)


def _jumps() -> Iterator[Case]:
    yield Case("stop that holds at a jump", held_at_a_jump, 1.53, kink=JUMP, quick=True)
    yield Case("stop that holds at a jump, with rows", held_at_a_jump, 1.53, {"event_rows": True}, kink=JUMP)
    yield Case("stop beside pulses", pulses, 1.03, kink=REBOUNDS)


def _ropes() -> Iterator[Case]:
    for restitution in (0.0, 0.5, 1.0):
        yield Case(f"rope {restitution:g}", partial(rope, restitution), 0.93, kink=TAUT, quick=restitution == 0.0)
    yield Case("mass off the end of a rope", off_the_end, 0.43, kink=TAUT)
    yield Case("two ropes", two_ropes, 0.73, kink=TAUT)
    yield Case("bar on ropes", bar_on_ropes, 0.83, kink=TAUT)


def _freewheels() -> Iterator[Case]:
    yield Case("clutch that holds and overruns", clutch, 6.03, quick=True)
    yield Case("clutch that starts the wrong way", wrong_way, 0.53)
    yield Case("clutch between two wheels", two_wheels, 2.03)
    yield Case("ratchet", sticking.ratchet, 2.03)
    yield Case("rubbed ratchet", sticking.rubbed_ratchet, 2.03, kink="joints stick and slide")


def stopped_pendulum(restitution: float) -> Mechanism:
    """A bar that falls on its stop."""
    m = Mechanism("pendulum", gravity=(0.0, -G))
    rod = m.bar("rod", 1.0, mass=3.0)
    hinge = m.revolute("A", m.ground.at(0, 0), rod.start)
    m.stop("post", hinge, lower=math.radians(-80), restitution=restitution)
    m.start_near(rod=0)
    return m


def shuttle(restitution: float) -> Mechanism:
    """A slider that goes to and fro between its ends."""
    m = Mechanism("shuttle", gravity=None)
    block = m.body("block", 1.0, inertia=1.0)
    guide = m.prismatic("guide", m.ground.origin, block.origin)
    m.stop("end", guide, lower=-0.25, upper=0.75, restitution=restitution)
    m.start_moving(block=(1.0, 0.0, 0.0))
    return m


def restituted(restitution: float) -> Mechanism:
    """The four-bar between stops with another restitution of both."""
    m = stops.barrier(True)
    for end in ("end lower", "end upper"):
        m.change(end, restitution=restitution)
    return m


def double_pendulum() -> Mechanism:
    """Two bars with a stop in each hinge."""
    m = Mechanism("double", gravity=(0, -G))
    a, b = m.bar("a", 0.6, mass=1.0), m.bar("b", 0.4, mass=0.5)
    m.angle_stop("first", m.ground.origin, a.start, -1.8, restitution=0.4)
    m.revolute("A", m.ground.origin, a.start)
    elbow = m.revolute("B", a.end, b.start)
    m.stop("second", elbow, lower=-0.5, upper=0.5, restitution=0.6)
    m.start_near(a=-10, b=5)
    return m


def two_stops() -> Mechanism:
    """Two equal pendulums that meet their stops at one instant."""
    m = Mechanism("twins", gravity=(0, -G))
    for name, x, restitution in (("left", -1.0, 0.3), ("right", 1.0, 0.6)):
        rod = m.bar(name, 0.5, mass=1.0)
        hinge = m.revolute(f"pin {name}", m.ground.at(x, 0), rod.start)
        m.stop(f"post {name}", hinge, lower=-2.0, restitution=restitution)
        m.start_near(**{name: -20.0})
    return m


def pressed_arm(degrees: float) -> Mechanism:
    """An arm that a spring presses against the stop at which it starts, until a torque lifts it off."""
    m = Mechanism("pressed", gravity=None)
    arm = m.bar("arm", 0.5, mass=1.0)
    m.revolute("pivot", m.ground.origin, arm.start)
    m.angle_stop("stop", m.ground.origin, arm.start, math.radians(degrees), restitution=0.5)
    m.torsion_spring("spring", m.ground, arm, 2.0, 0.1, free_angle=-1.0)
    m.torque("lift", arm, harmonic(3.0, 5.0))
    m.start_near(arm=degrees)
    return m


def held_at_a_jump() -> Mechanism:
    """A slider at its stop whose load jumps: more pressure, off, and back."""
    m = Mechanism("jump", gravity=None)
    block = m.body("block", 2.0, inertia=1.0)
    guide = m.prismatic("guide", m.ground.origin, block.origin)
    m.stop("end", guide, upper=0.1, restitution=0.3)
    m.force("push", block.origin, function(lambda t: 3.0 if t < 0.6137 else 9.0 if t < 0.9241 else -4.0))
    m.spring("spring", m.ground.at(-1, 0), block.origin, 5.0, 0.4, free_length=1.0)
    return m


def pulses() -> Mechanism:
    """A pendulum at its stop that short pulses push off."""
    m = stopped_pendulum(0.2)
    m.torque("pulse", m.bodies["rod"], function(lambda t: 300.0 if 0.7137 <= t < 0.7157 else 0.0))
    m.torque("step", m.bodies["rod"], function(lambda t: -20.0 if t >= 0.8273 else 0.0))
    return m


def rope(restitution: float) -> Mechanism:
    """A weight that falls aside until its rope goes taut."""
    m = Mechanism("rope", gravity=(0.0, -G))
    weight = m.body("weight", 2.0, inertia=0.1)
    m.rope("rope", m.ground.at(0, 0), weight.origin, 1.0, restitution)
    m.start_near(weight=(0.6, 0.0, 0.0))
    return m


def off_the_end() -> Mechanism:
    """A mass off its rope's end: after the rope goes taut it comes loose with almost no speed."""
    m = Mechanism("rope")
    mass = m.body("mass", 2.46, com=(0.043, 0.034), inertia=0.0027)
    m.rope("rope", m.ground.origin, mass.origin, 0.6)
    m.start_near(mass=(0.2147, -0.3101, 0))
    return m


def two_ropes() -> Mechanism:
    """A weight on two ropes of unequal length, thrown sideways."""
    m = Mechanism("ropes", gravity=(0.0, -G))
    weight = m.body("weight", 1.0, inertia=0.01)
    m.rope("left", m.ground.at(-0.4, 0), weight.origin, 0.7, 0.2)
    m.rope("right", m.ground.at(0.5, 0), weight.origin, 0.6)
    m.start_near(weight=(0.05, -0.2, 0.0))
    m.start_moving(weight=(0.6, 0.0, 0.0))
    return m


def bar_on_ropes() -> Mechanism:
    """A bar that falls into two ropes."""
    m = Mechanism("swing", gravity=(0.0, -G))
    bar = m.bar("bar", 0.8, mass=1.5)
    m.rope("left", m.ground.at(-0.5, 0), bar.start, 0.5, 0.1)
    m.rope("right", m.ground.at(0.5, 0), bar.end, 0.6, 0.1)
    m.start_near(bar=(-0.4, -0.25, 4.0))
    return m


def clutch() -> Mechanism:
    """A wheel that an oscillating load turns one way alone."""
    m = Mechanism("freewheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=2.0)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel)
    m.torque("load", wheel, harmonic(3.0, 1.0, math.pi / 2))
    return m


def wrong_way() -> Mechanism:
    """A wheel that starts the way in which its clutch holds."""
    m = Mechanism("freewheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=2.0)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel, clockwise=True)
    m.torque("load", wheel, harmonic(1.0, 9.0, math.pi / 2))
    m.start_moving(wheel=3.0)
    return m


def two_wheels() -> Mechanism:
    """A driven wheel that takes another along, which overruns it."""
    m = Mechanism("wheels", gravity=None)
    first, second = m.body("first", 1.0, inertia=0.2), m.body("second", 1.0, inertia=0.5)
    m.revolute("A", m.ground.origin, first.origin)
    m.revolute("B", m.ground.at(1, 0), second.origin)
    m.one_way("clutch", first, second)
    m.torsion_spring("coil", m.ground, first, 8.0, 0.1)
    m.torsion_spring("drag", m.ground, second, 0.0, 0.3)
    m.torque("motor", first, harmonic(4.0, 3.0, 0.4))
    return m
