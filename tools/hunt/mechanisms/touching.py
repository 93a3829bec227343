"""Simulated mechanisms with unilateral contacts, stops, ropes, clutches, and with contact by penalty."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, curve
from tools.hunt.mechanisms.machines import solid
from tools.hunt.subject import Subject, family
from tools.models.contact_models import ball, box, disc

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
