"""Simulated mechanisms with contacts, stops, ropes and clutches, some of which must keep their energy."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, curve
from mbsd.model.forces.contact import DAMPING_MODELS
from mbsd.results.solution import Solution
from tools.models.contact_models import ball, box, disc
from tools.random_mechanisms.machines import solid
from tools.random_mechanisms.subject import TOLERANCE, Subject, family

# Simulated mechanisms with unilateral contacts, stops, ropes, clutches, and with contact by penalty.


EVENTS = frozenset({"contacts"})


@family("balls and boxes on floors")
def falling(rng: np.random.Generator) -> Subject:
    """A ball that bounces, a box that falls on its feet, a disc that rolls or slides down a slope."""
    kind = int(rng.integers(3))
    if kind == 0:
        m = ball(float(rng.choice([0.0, 0.5, 0.9])), float(rng.uniform(0.05, 0.5)))
        m.start_moving(ball=(float(rng.normal()), float(rng.normal()), float(rng.normal())))
    elif kind == 1:
        m = box(float(rng.choice([0.0, 0.4])), float(rng.uniform(0.0, 0.6)))
        m.start_near(box=(0.0, 0.45, float(rng.choice([0.0, rng.uniform(-10, 10)]))))
        m.start_moving(box=(float(rng.normal()), 0.0, 0.0))
    else:
        m = disc(float(rng.uniform(0.05, 0.8)), float(rng.uniform(-0.4, 0.4)))
    return Subject(m, float(rng.uniform(0.2, 0.6)), False, traits=EVENTS)


@family("stops, ropes, clutches")
def stops(rng: np.random.Generator) -> Subject:
    """A pendulum that meets a stop, a mass on a rope, a freewheel, a slider between ends."""
    kind, m = int(rng.integers(4)), Mechanism("stops")
    bounce = float(rng.choice([0.0, 0.6]))
    if kind == 0:
        rod = m.bar("rod", 0.5, 1.0)
        pin = m.revolute("A", m.ground.origin, rod.start)
        m.stop("stop", pin, lower=-math.pi / 2 - float(rng.uniform(0.1, 0.5)), restitution=bounce)
        m.start_near(rod=float(rng.uniform(-60, 0)))
    elif kind == 1:
        mass = solid(m, "mass", rng, 0.1)
        m.rope("rope", m.ground.origin, mass.origin, 0.6, restitution=bounce)
        m.start_near(mass=(float(rng.uniform(0.1, 0.4)), float(rng.uniform(-0.4, 0.0)), 0))
    elif kind == 2:
        wheel, crank = solid(m, "wheel", rng, 0.3), solid(m, "crank", rng, 0.2)
        m.revolute("A", m.ground.origin, wheel.origin)
        m.revolute("B", m.ground.origin, crank.origin)
        m.one_way("clutch", crank, wheel)
        m.torsion_spring("spring", m.ground, crank, 8.0, 0.05, 0.5)
        m.start_near(wheel=(0, 0, 0), crank=(0, 0, 0))
        m.start_moving(crank=float(rng.uniform(-4, 4)), wheel=float(rng.uniform(-1, 4)))
    else:
        block = solid(m, "block", rng, 0.1)
        rail = m.prismatic("rail", m.ground.at(0, 0, 0.6), block.origin)
        m.stop("ends", rail, lower=-0.3, upper=0.3, restitution=bounce)
        m.start_near(block=(0, 0, math.degrees(0.6)))
        m.start_moving(block=(1.0 * math.cos(0.6), 1.0 * math.sin(0.6), 0))
    return Subject(m, float(rng.uniform(0.2, 0.7)), False, traits=EVENTS)


@family("contact by penalty, tyres, gas")
def penalty(rng: np.random.Generator) -> Subject:
    """A ball on springy ground, a wheel on a road, a piston on gas."""
    kind, m = int(rng.integers(3)), Mechanism("penalty")
    if kind == 0:
        body = m.body("ball", 1.0, inertia=0.004)
        hill = curve([-2.0, -0.7, 0.6, 2.0], [0.1, -0.05, 0.1, 0.0]) if rng.random() < 0.5 else None
        friction = float(rng.uniform(0, 0.5))
        m.contact("floor", m.ground.origin, body.origin, 4e3, 1.5, 0.1, friction, 0.1, hill, slip_speed=0.1)
        m.start_near(ball=(0, 0.4, 0))
        m.start_moving(ball=(float(rng.normal()), 0.0, float(rng.normal())))
    elif kind == 1:
        wheel = m.body("wheel", 5.0, inertia=0.3)
        m.tyre("tyre", m.ground.origin, wheel.origin, 0.3, 2e4, damping=100.0, standstill=0.5)
        m.start_near(wheel=(0, 0.298, 0))
        m.start_moving(wheel=(float(rng.uniform(1, 5)), 0, -10.0))
    else:
        piston = solid(m, "piston", rng, 0.05)
        m.prismatic("bore", m.ground.at(0, 0, math.pi / 2), piston.origin)
        m.gas("gas", m.ground.at(0, 0, math.pi / 2), piston.origin, 2e-3, 1.2e5, at=0.12, clearance=0.01)
        m.start_near(piston=(0, float(rng.uniform(0.1, 0.2)), 90))
    return Subject(m, float(rng.uniform(0.1, 0.4)), False, traits=frozenset({"stiff"}))


# Free mechanisms whose energy tells: Genevas in both formulations, impacts on contacts with a restitution.


KEPT = 2e-8
"""Part of the largest energy of motion by which energy less work may change at a tolerance of 1e-9."""
ALMOST, FINER, FALLS = 10.0, 0.01, 0.1
"""Up to so many bounds it may change by more, if with this part of the tolerance it changes by less than that part:
outputs within a long step have the error of its interpolant, which is of order 7 and does not choose the steps."""


def audited(sol: Solution, formulation: str = "auto") -> list[str]:
    """Return what a solution gains or loses without work, in words."""
    bound, changed = _change(sol)
    if changed <= bound:
        return []
    if changed <= ALMOST * bound:
        finer = sol.mechanism.simulate(times=sol.t, tolerance=FINER * TOLERANCE, formulation=formulation)
        if _change(finer)[1] < FALLS * changed:
            return []
    return [f"energy less work changes by {changed:.3g} J, bound {bound:.3g} J"]


def _change(sol: Solution) -> tuple[float, float]:
    """By how much energy less work may change, and does (J)."""
    assert sol.audit is not None
    return KEPT * max(float(sol.energy.kinetic.max()), 1e-3), float(np.ptp(sol.audit))


def _in_both(sol: Solution) -> list[str]:
    """The same of the mechanism in each formulation."""
    out, m = audited(sol), sol.mechanism
    for formulation in ("reference", "independent"):
        other = m.simulate(times=sol.t, tolerance=TOLERANCE, formulation=formulation)
        out += [f"{formulation}: {problem}" for problem in audited(other, formulation)]
    return out


@family("free Geneva", weight=0.5)
def free_geneva(rng: np.random.Generator) -> Subject:
    """A crank that turns a Geneva by its own inertia, up and down in a field of gravity."""
    m, slots = Mechanism("free geneva", gravity=(0.0, -9.81 * float(rng.random() < 0.7))), int(rng.integers(3, 9))
    distance = float(rng.uniform(0.1, 0.4))
    crank, wheel = solid(m, "crank", rng, distance), solid(m, "wheel", rng, distance)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(distance, 0), wheel.origin)
    m.geneva("geneva", crank.origin, wheel.origin, slots, distance * math.sin(math.pi / slots))
    m.start_near(crank=float(rng.uniform(-180, 180)), wheel=180.0 / slots * float(rng.integers(2)))
    m.start_moving(crank=float(rng.choice([-1, 1]) * rng.uniform(3, 30)))
    return Subject(m, float(rng.uniform(0.3, 1.0)), False, truth=_in_both, traits=frozenset({"jumps"}))


@family("contact with a restitution", weight=0.5)
def restitution(rng: np.random.Generator) -> Subject:
    """A ball that bounces, a pendulum against a wall, two balls that meet, with damping by their approach."""
    m, kind = Mechanism("restitution"), int(rng.integers(3))
    loss = {
        "restitution": float(rng.uniform(0.2, 1.0)),
        "damping_model": str(rng.choice(list(DAMPING_MODELS))),
        "exponent": float(rng.choice([1.0, 1.5, 2.2])),
        "stiffness": float(10 ** rng.uniform(3.5, 6)),
        "radius": 0.1,
    }
    if kind == 0:
        ball = m.body("ball", 1.0, inertia=0.004)
        hill = curve([-2.0, -0.7, 0.6, 2.0], [0.1, -0.05, 0.1, 0.0]) if rng.random() < 0.5 else None
        m.contact(
            "floor",
            m.ground.origin,
            ball.origin,
            profile=hill,
            friction=float(rng.uniform(0, 0.4)),
            slip_speed=0.1,
            **loss,
        )
        m.start_near(ball=(0, 0.4, 0))
        m.start_moving(ball=(float(rng.normal()), 0.0, float(rng.normal())))
    elif kind == 1:
        rod = m.bar("rod", 1.0, 2.0)
        m.revolute("A", m.ground.origin, rod.start)
        m.contact("wall", m.ground.at(0.1, 0, math.pi / 2), rod.end, **loss)
        m.start_near(rod=float(rng.uniform(-60, 0)))
    else:
        m.gravity = None
        first, two = solid(m, "one", rng, 0.1), solid(m, "two", rng, 0.1)
        m.contact("meet", first.at(0.0, 0.0, float(rng.uniform(-0.3, 0.3))), two.origin, **loss)
        m.start_near(one=(0, 0, 0), two=(0.0, 0.3, 0))
        m.start_moving(two=(float(rng.normal(scale=0.3)), -1.5, 0.0))
    return Subject(m, float(rng.uniform(0.3, 0.8)), False, truth=audited, traits=frozenset({"stiff"}))
