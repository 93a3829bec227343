"""Runs with Python functions, states of forces, many contacts or bodies, and odd starts."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mbsd import Mechanism, angle_reaches, constant_rate
from tools.models import contact_models, releases, stops
from tools.models.contact_models import G
from tools.numbers.events import contacts
from tools.numbers.events.record import Case

CHAOS = "impacts multiply small differences"
STIFF = "oil is stiff, and the method's error at stops is larger"


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield Case("ball in a Python wind", wind, 1.03, kink=CHAOS, quick=True)
    yield Case("bead on a Python ellipse with a stop", ellipse, 0.93, kink=CHAOS)
    yield Case("four-bar whose motor is Python", python_motor, 0.53, kink=CHAOS)
    yield Case("ram that reaches its stop", ram, 0.331, kink=STIFF)
    yield Case("start that is made consistent", inconsistent, 0.93, kink=CHAOS)
    yield Case("body without mass that is let go", massless, 1.53)
    yield Case("cradle of 42", lambda: contacts.cradle(42, 1.0), 0.63, even=True)
    yield Case("chain of 202 with a stop", long_chain, 0.0271, steps=3, kink=CHAOS)
    yield Case("row of 18 cranks with a stop", row_with_a_stop, 0.33, steps=4, kink=CHAOS)
    yield Case("chosen outputs", lambda: contact_models.ball(0.6), 1.53, {"step": 0.011}, kink=CHAOS)
    yield Case("loose tolerance", stops.limited, 0.93, {"tolerance": 1e-8}, kink="its tolerance is loose")


def wind() -> Mechanism:
    """A bouncing ball in a wind that a Python function gives."""
    m = contact_models.ball(0.6, 0.5)
    m.change("floor", friction=0.2, static_friction=0.3)
    m.user_force("wind", lambda t, q, v: (0.5 - 0.3 * v[0], -0.3 * v[1], -0.01 * v[2]), m.bodies["ball"])
    return m


def ellipse() -> Mechanism:
    """A bead on an ellipse that a Python function gives, and a wall."""
    m = Mechanism("ellipse", gravity=(0, -G))
    bead = m.body("bead", 1.0, inertia=0.1)
    m.constraint("ellipse", m.ground.origin, bead.origin, lambda x, y, a: x * x + 4.0 * y * y - 1.0)
    m.coordinate_stop("wall", m.ground.origin, bead.origin, 0.1, upper=True, restitution=0.5)
    m.start_near(bead=(-0.6, -0.4, 0))
    return m


def python_motor() -> Mechanism:
    """The four-bar between stops, with a torque by a Python function beside its motor."""
    m = stops.barrier(True)
    m.user_force("own", lambda t, q, v: (0.0, 0.0, 0.5 * math.sin(9.0 * t) - 0.02 * v[2]), m.bodies["crank"])
    return m


def ram() -> Mechanism:
    """A carriage that a hydraulic cylinder pushes against a stop, and an event at a pressure."""
    m = Mechanism("ram", gravity=None)
    carriage = m.body("carriage", 300.0, inertia=10.0)
    rail = m.prismatic("rail", m.ground.origin, carriage.origin)
    m.hydraulic_cylinder(
        "ram", m.ground.at(-1.0, 0.0), carriage.origin, 0.08, 0.05, 0.4, 0.9, 2e7, valve=0.6, rated_flow=1e-3
    )
    m.stop("end", rail, upper=0.13, restitution=0.1)
    m.event("pressed", lambda t, moment: moment.state("ram", "pressure_a") - 1e7, direction=1)
    m.start_near(carriage=(0.1, 0.0, 0.0))
    return m


def inconsistent() -> Mechanism:
    """A double pendulum with a stop, whose given velocities its pins do not allow."""
    m = Mechanism("thrown", gravity=(0, -G))
    a, b = m.bar("a", 0.6, mass=1.0), m.bar("b", 0.4, mass=0.5)
    m.revolute("A", m.ground.origin, a.start)
    elbow = m.revolute("B", a.end, b.start)
    m.stop("end", elbow, lower=-0.35, upper=0.35, restitution=0.5)
    m.start_near(a=-60, b=-70)
    m.start_moving(a=(0.5, 0.2, 1.0), b=(0.0, 1.0, 2.0))
    return m


def massless() -> Mechanism:
    """A body that loses its mass with its weld, and goes on as it went."""
    m = Mechanism("light")
    rod, bob = m.bar("rod", 0.5, mass=0.0), m.body("arm", mass=1.0, inertia=0.1)
    m.revolute("A", m.ground.origin, rod.start)
    m.weld("B", rod.end, bob.origin)
    m.event("low", angle_reaches(rod, -1.0), releases="B")
    m.start_near(rod=0)
    return m


def long_chain() -> Mechanism:
    """A chain of 202 bars whose first meets a stop."""
    m, end = Mechanism("chain", gravity=(0, -G)), None
    start: dict[str, float] = {}
    for k in range(202):
        bar = m.bar(f"bar{k}", 0.05, mass=0.1)
        m.revolute(f"pin{k}", m.ground.origin if end is None else end, bar.start)
        start[f"bar{k}"] = -30.0 if k == 0 else -80.0
        end = bar.end
    m.angle_stop("post", m.ground.origin, m.bodies["bar0"].start, -0.53, restitution=0.2)
    m.start_near(**start)
    return m


def row_with_a_stop() -> Mechanism:
    """Cranks that repeat each other, one of which meets a stop."""
    m = releases.row_of_cranks(18)
    m.stop("end", "A0", upper=-0.6, restitution=0.3)
    m.event("quarter", angle_reaches(m.bodies["crank3"], -0.8))
    clock = m.body("clock", 1.0, inertia=1.0)
    m.revolute("axle", m.ground.at(5, 0), clock.origin)
    m.drive_angle("hand", clock, constant_rate(3.0))
    return m
