"""Models and checks of contacts: balls, discs and a box on a floor, times of events, energy."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism
from mbsd.results.solution import Solution

G = 9.81


def ball(restitution: float, height: float = 1.0) -> Mechanism:
    m = Mechanism("ball", gravity=(0.0, -G))
    body = m.body("ball", 2.0, inertia=0.1)
    m.rigid_contact("floor", m.ground.at(0, 0), body.origin, radius=0.1, restitution=restitution)
    m.start_near(ball=(0, 0.1 + height, 0))
    return m


def times_of(sol: Solution, name: str, what: str) -> list[float]:
    return [event.time for event in sol.events if event.name == name and event.what == what]


def balance(sol: Solution) -> np.ndarray:
    """Energy less work less what impacts took: constant."""
    assert sol.audit is not None
    return sol.audit - sum(np.where(sol.t > event.time, event.energy, 0.0) for event in sol.events)


def disc(friction: float, slope: float = 0.0) -> Mechanism:
    m = Mechanism("disc", gravity=(0.0, -G))
    wheel = m.body("wheel", 3.0, inertia=0.5 * 3.0 * 0.2**2)
    m.rigid_contact("road", m.ground.at(0, 0, slope), wheel.origin, radius=0.2, friction=friction)
    m.start_near(wheel=(-0.2 * math.sin(slope), 0.2 * math.cos(slope), 0))
    return m


def box(restitution: float, friction: float, points: int = 2) -> Mechanism:
    m = Mechanism("box", gravity=(0.0, -G))
    body = m.body("box", 4.0, inertia=4.0 * (1 + 0.25) / 12)
    for k, x in enumerate(np.linspace(-0.5, 0.5, points)):
        m.rigid_contact(
            f"foot {k}", m.ground.origin, body.at(float(x), -0.25), restitution=restitution, friction=friction
        )
    m.start_near(box=(0, 0.25, 0))
    return m
