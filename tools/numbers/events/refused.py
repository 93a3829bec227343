"""Runs that are refused, and the words that name why."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mbsd import Mechanism, angle_reaches
from tools.models import contact_models, guided, rough_contacts, sticking, stops, user_events
from tools.numbers.events.record import Case


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield Case("ball inside the floor", lambda: contact_models.ball(0.5, -0.5), 1.0, refused=("'floor'", "inside"))
    yield Case("arm beyond its stop", _beyond, 1.0, refused=("'stop'", "starts"))
    yield Case("rod that jams", lambda: rough_contacts.rod(2.5), 0.3, refused=("'tip'", "jams", "2.5"))
    yield Case("rod that jams at once", _painleve, 1.0, refused=("'table'", "jams", "t = 0 s", "Painleve"))
    yield Case("joints that jam", _jam, 1.0, refused=("joints jam", "'A'", "0.7588"))
    yield Case("gears that meet", guided.loose_gears, 1.5, refused=("'mesh'", "meet at t ="))
    yield Case("geneva of a wrong radius", _wrong_geneva, 1.0, refused=("'index'", "radius must be"))
    yield Case("event without a number", _nan, 1.0, refused=("'broken'", "nan", "t = 0 s"), quick=True)
    yield Case("compiled event without a number", _compiled_nan, 0.5, refused=("'bad'", "nan"))
    yield Case("action that fails", _fails, 1.0, refused=("'now'", "ZeroDivisionError"))
    yield Case("action of too few numbers", _few, 1.0, refused=("'three'", "2 numbers", "3 are wanted"))
    yield Case("action that releases what is not there", _no_joint, 1.0, refused=("'now'", "'nothing'"))
    own, name = {"formulation": "independent"}, "formulation='independent'"
    for what, build in {
        "contact": lambda: contact_models.ball(0.5),
        "stop": lambda: stops.barrier(True),
        "limits": stops.limited,
        "sticking joint": sticking.bell,
        "freewheel": sticking.ratchet,
        "event": user_events.swing,
    }.items():
        yield Case(f"{what}, independent", build, 0.5, own, refused=(name, "events, contacts"))
    for method in ("rattle", "symplectic"):
        options = {"method": method, "step": 1e-3}
        name = f"friction by {method}"
        yield Case(name, lambda: contact_models.disc(0.2), 0.5, options, refused=("friction of rigid contacts",))
        yield Case(f"dry joint by {method}", sticking.bell, 0.5, options, refused=("friction of joints",))


def _beyond() -> Mechanism:
    m = Mechanism("pushed", gravity=None)
    arm = m.bar("arm", 0.5, mass=1.0)
    m.revolute("pivot", m.ground.origin, arm.start)
    m.angle_stop("stop", m.ground.origin, arm.start, 0.5, upper=True, restitution=0.5)
    m.start_near(arm=60)
    return m


def _painleve() -> Mechanism:
    m = Mechanism("painleve")
    bar = m.bar("rod", 2.0, 1.0)
    m.rigid_contact("table", m.ground.origin, bar.start, friction=2.0)
    m.start_near(rod=(0.0, 0.0, 60.0))
    m.start_moving(rod=(-3.0, 0.0, 0.0))
    return m


def _jam() -> Mechanism:
    m = Mechanism("four-bar")
    lengths = (0.9995897538149691, 0.8, 1.4)
    crank, coupler, rocker = (m.bar(n, x, x) for n, x in zip(("crank", "coupler", "rocker"), lengths, strict=True))
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(1.2, 0), rocker.start)
    for pin in "ABCD":
        m.friction(f"rub {pin}", pin, 0.5, static=0.65, radius=0.05, sticks=True)
    m.start_near(crank=69.0, coupler=10.0, rocker=69.0)
    m.start_moving(crank=2.0)
    return m


def _wrong_geneva() -> Mechanism:
    m = guided.free_geneva(5)
    m.change("index", radius=0.07)
    return m


def _nan() -> Mechanism:
    m = contact_models.ball(0.5)
    m.event("broken", lambda t, moment: math.nan)
    return m


def _compiled_nan() -> Mechanism:
    import numba

    m = user_events.swing()
    bad = numba.njit(lambda t, q, v: math.nan if q[1] > -0.3 else 1.0)
    m.event("bad", bad, frames=m.bodies["arm"].end)
    return m


def _fails() -> Mechanism:
    m = contact_models.ball(0.5)
    m.event("now", lambda t, moment: t - 0.2, action=lambda moment: 1 / 0)
    return m


def _few() -> Mechanism:
    m = user_events.swing()
    arm = m.bodies["arm"]
    m.event("three", lambda t, q, v: q[0] - 0.1, frames=arm.end, action=lambda t, q, v: (1.0, 2.0))
    return m


def _no_joint() -> Mechanism:
    m = user_events.swing()
    m.event("now", angle_reaches(m.bodies["arm"], -1.0), action=lambda moment: moment.release("nothing"))
    return m
