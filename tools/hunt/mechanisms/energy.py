"""Free mechanisms whose energy tells: Genevas in both formulations, impacts on contacts with a restitution."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, curve
from mbsd.model.entries import MODELS
from mbsd.results.solution import Solution
from tools.hunt.mechanisms.machines import solid
from tools.hunt.solving.free_case import TOLERANCE
from tools.hunt.subject import Subject, family

KEPT = 2e-8
"""Part of the largest energy of motion by which energy less work may change at a tolerance of 1e-9."""
ALMOST, FINER, FALLS = 10.0, 0.01, 0.1
"""Up to so many bounds it may change by more, if with this part of the tolerance it changes by less than that part:
outputs within a long step have the error of its interpolant, which is of order 7 and does not choose the steps."""


def audited(sol: Solution, formulation: str = "auto") -> list[str]:
    """What a solution gains or loses without work."""
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
        "damping_model": str(rng.choice(list(MODELS))),
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
