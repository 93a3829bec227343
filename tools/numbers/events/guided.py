"""Runs whose joints end steps: Genevas, meeting wheels, curves that cross themselves."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from mbsd import Mechanism
from tools.models import guided, releases
from tools.models.engines import petrol, slider_crank
from tools.numbers.events.record import Case

FREE = ("independent", "reference")
JUMPS = "the acceleration jumps where a pin enters and leaves its slot"
FLAT = "joints that repeat others are exchanged where the ones that hold lie flat"
CHAOS = "rebounds multiply small differences"


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield from _genevas()
    yield from _wheels()
    yield from _curves()
    yield from _repeated()
    yield from _approaches()
    yield from _phases()


def _genevas() -> Iterator[Case]:
    built = {
        "geneva of 4": partial(guided.free_geneva, 4),
        "geneva of 6": partial(guided.free_geneva, 6),
        "geneva of 5 backwards": lambda: guided.free_geneva(5, None, -9.0),
        "geneva that swings back": guided.swinging_geneva,
        "two genevas": guided.heavy_pair_of_genevas,
    }
    for name, build in built.items():
        for formulation in FREE:
            options = {"formulation": formulation}
            yield Case(f"{name}, {formulation}", build, 1.53, options, kink=JUMPS, quick=name == "geneva of 4")
    yield Case("geneva with a stop", lambda: _stopped(guided.free_geneva(6)), 0.93, kink=JUMPS)
    yield Case("geneva on a motor", lambda: _hung(guided.geneva(5, start=-1.5)), 2.53, kink=JUMPS)


def _wheels() -> Iterator[Case]:
    for stiffness in (1.0, 3.0):
        yield Case(f"loose gears {stiffness:g}", partial(guided.loose_gears, stiffness), 0.93)
    yield Case("loose gears up to near their middle", guided.loose_gears, 0.93)


def _curves() -> Iterator[Case]:
    for name, build in {
        "bead on an eight": guided.coaster,
        "bead on an eight, events": partial(guided.coaster, True),
        "bead on an eight, stop": partial(guided.coaster, stop=True),
    }.items():
        yield Case(name, build, 1.53 if name.endswith("stop") else 0.73, kink=CHAOS, quick=name.endswith("events"))


def _repeated() -> Iterator[Case]:
    for formulation in ("auto", "reference"):
        options = {"formulation": formulation}
        yield Case(f"three cranks turn, {formulation}", lambda: releases.cranks(12.0), 0.93, options, kink=FLAT)
    yield Case("three cranks with stops", _thrown_cranks, 1.03, kink=CHAOS, quick=True)
    yield Case("three cranks that turn into stops", lambda: releases.cranks(9.0, True), 0.73, kink=FLAT)
    yield Case("three cranks and a motor", lambda: releases.cranks(motor=True), 0.33, {"tolerance": 1e-12}, kink=FLAT)
    yield Case("three dry cranks", lambda: releases.dry(False), 0.63, kink=FLAT)
    yield Case("three cranks that stick", _thrown_dry_cranks, 1.03, kink=FLAT)
    yield Case("door with two hinges", releases.doors, 0.93)
    yield Case("door with two hinges and a stop", _stopped_door, 0.93, kink=CHAOS)


def _approaches() -> Iterator[Case]:
    for model in ("flores", "hunt_crossley"):
        for formulation in ("auto", "reference"):
            name, options = f"ball that remembers, {model}, {formulation}", {"formulation": formulation}
            yield Case(name, partial(soft_ball, 0.8, model), 0.93, options, kink=CHAOS)
    yield Case("ball that remembers, event", lambda: watched(soft_ball(0.7, "flores")), 0.93, kink=CHAOS, quick=True)
    yield Case("ball that remembers, wall", lambda: soft_ball(0.7, "flores", True), 0.93, kink=CHAOS)
    yield Case("gears that remember", meshed, 0.053, kink="stiff flanks multiply small differences")


def _phases() -> Iterator[Case]:
    for rows in (True, False):
        name = "engine with rows of phases" if rows else "engine without rows of phases"
        yield Case(name, engine, 0.0531, {"event_rows": rows}, kink="the pressure jumps where the exhaust opens")
    yield Case("engine with rows and an event", lambda: turned(engine()), 0.0531, {"event_rows": True}, kink="as above")


def _stopped(m: Mechanism) -> Mechanism:
    """A Geneva whose crank a stop ends."""
    m.stop("end", "O", upper=3.0, restitution=0.5)
    return m


def _hung(m: Mechanism) -> Mechanism:
    """A Geneva with a bar on its wheel, which a stop keeps near."""
    bob = m.bar("bob", 0.1, mass=0.2)
    pin = m.revolute("hang", m.bodies["wheel"].at(0.03, 0.0), bob.start)
    m.stop("end", pin, lower=-0.6, upper=0.6, restitution=0.4)
    m.start_near(bob=20)
    return m


def _thrown_cranks() -> Mechanism:
    m = releases.cranks(stops=True)
    m.start_moving(crank0=5.0)
    return m


def _thrown_dry_cranks() -> Mechanism:
    m = releases.dry(True)
    m.start_moving(crank0=4.0)
    return m


def _stopped_door() -> Mechanism:
    m = releases.doors()
    m.stop("end", "hinge", lower=-0.9, restitution=0.3)
    return m


def soft_ball(restitution: float, model: str, wall: bool = False) -> Mechanism:
    """A ball on a floor by penalty, whose damping goes by how fast it came."""
    m = Mechanism("soft", gravity=(0, -9.81))
    ball = m.body("ball", 0.5, inertia=2e-3)
    m.contact("floor", m.ground.origin, ball.origin, 1e5, radius=0.05, restitution=restitution, damping_model=model)
    if wall:
        m.rigid_contact("wall", m.ground.at(0.3, 0, 1.5707963267948966), ball.origin, 0.05, 0.5)
    m.start_near(ball=(0, 0.3, 0))
    m.start_moving(ball=(0.5, 0.0, 0.0))
    return m


def watched(m: Mechanism) -> Mechanism:
    """The same with an event where the ball is high and falls."""
    m.event("high", lambda t, moment: moment.body("ball").y - 0.13, direction=-1)
    return m


def meshed() -> Mechanism:
    """Gears with backlash whose flanks remember how fast they met, and an event."""
    m = Mechanism("gears", gravity=None)
    a, b = m.body("a", mass=1.0, inertia=2e-3), m.body("b", mass=1.0, inertia=1e-3)
    m.revolute("A", m.ground.origin, a.origin)
    m.revolute("B", m.ground.at(0.09, 0.0), b.origin)
    m.gear_mesh("mesh", a.origin, b.origin, radius_i=0.06, radius_j=0.03, stiffness=1e6, backlash=1e-4, restitution=0.8)
    m.event("half", lambda t, moment: moment.body("a").theta - 0.05)
    m.start_near(a=0, b=0)
    m.start_moving(a=2.0, b=-3.0)
    return m


def engine() -> Mechanism:
    """A free slider-crank of an engine."""
    m = slider_crank(petrol(exhaust_opens=2.27), rate=None, start=0.4, fires_at=1.5707963267948966)
    m.start_moving(crank=150.0)
    return m


def turned(m: Mechanism) -> Mechanism:
    """The same with an event at an angle of its crank, and a stop of the other kind: it ends there."""
    m.event("far", lambda t, moment: moment.body("crank").theta - 5.0)
    return m
