"""Numbers far apart: masses of connected bodies, and forces of the user that overflow beside the motion."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism
from mbsd.results.solution import Solution
from tools.hunt.mechanisms.free import chain
from tools.hunt.solving.free_case import TOLERANCE
from tools.hunt.subject import Subject, family
from tools.models.random_linkages import linkage

STEPS = 2000
"""More are looked at: usual are 20 to 200."""
COARSER = 100.0
"""Times the tolerance with which such a motion is simulated again."""
GROW = 2.5
"""Steps against those of that motion above which rounding asks for them: a method of order 8 takes the eighth root of
COARSER, 1.8 times as many (measured: 1.7), and one solution of the equations of motion too few 47 times and more."""


@family("masses far apart")
def heavy(rng: np.random.Generator) -> Subject:
    """A chain or a closed linkage of which some bodies are up to 1e11 times as heavy."""
    if rng.random() < 0.6:
        m = Mechanism("heavy")
        chain(m, rng, int(rng.integers(2, 5)), bool(rng.random() < 0.3))
    else:
        m = linkage(int(rng.integers(10**9)), 1, damping=False).m
        m.start_moving(**{next(name for name in m.bodies if name != "ground"): float(rng.uniform(-2, 2))})
    times = float(10 ** rng.uniform(5, 11))
    bodies = [name for name, body in m.bodies.items() if name != "ground" and body.mass > 0]
    for name in rng.choice(bodies, max(1, len(bodies) // 3), replace=False):
        body = m.bodies[str(name)]
        m.change(body.name, mass=body.mass * times, inertia=body.inertia * times)
    return Subject(m, float(rng.uniform(0.2, 0.6)), False, truth=_few_steps)


def _few_steps(sol: Solution) -> list[str]:
    """Steps that rounding asks for.

    Light bodies that a heavy one pulls straight swing and snap within microseconds, which takes thousands of steps in
    any coordinates. Those grow with the tolerance as the method's order says.
    """
    if sol.stats.steps <= STEPS:
        return []
    coarser = sol.mechanism.simulate(times=sol.t, tolerance=COARSER * TOLERANCE).stats.steps
    if sol.stats.steps <= GROW * coarser:
        return []
    return [f"{sol.stats.steps} steps, {coarser} with {COARSER:g} times the tolerance"]


@family("stiff forces of the user")
def stiff(rng: np.random.Generator) -> Subject:
    """A body on a bar or free, braked by a power or an exponential of its speed, which overflows in trial states."""
    m, power = Mechanism("braked"), int(rng.choice([0, 3, 5, 9]))
    size, scale = float(10 ** rng.uniform(0, 4)), float(rng.uniform(10, 40))
    free = rng.random() < 0.5
    body = m.body("body", 1.0, inertia=0.1) if free else m.bar("body", 0.5, 1.0)
    if not free:
        m.revolute("pin", m.ground.origin, body.start)  # pyright: ignore[reportAttributeAccessIssue]
        m.start_near(body=-40)

    def brake(speed: float) -> float:
        return -size * speed**power if power else -math.exp(scale * speed) + math.exp(-scale * speed)

    def function(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
        return (brake(v[0]), 0.0, 0.0) if free else (0.0, 0.0, 0.05 * brake(v[2]))

    m.user_force("brake", function, body)
    fast = float(rng.uniform(0.2, 1.0)) * (1.0 if power == 0 else 3.0)
    m.start_moving(body=(fast, 0.0, 0.0) if free else fast)
    return Subject(m, float(rng.uniform(0.05, 0.3)), False, traits=frozenset({"stiff"}))
