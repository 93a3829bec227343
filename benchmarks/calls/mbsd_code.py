"""mbsd: the solver alone through a sweep; m.sweep() and m.simulate() with all their results."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import mbsd
from benchmarks import calls
from benchmarks.harness import Fresh
from mbsd.kinematics import prepared as ready_to_solve
from mbsd.kinematics.march import kinematics_at
from mbsd.results.solution import Solution
from tools.models import linkages

VERSION = mbsd.__version__


def model() -> mbsd.Mechanism:
    """Return the linkage, driven at 1 rad/s."""
    lengths = calls.GROUND, calls.CRANK, calls.COUPLER, calls.ROCKER
    start = math.degrees(calls.START[0]), math.degrees(calls.START[1])
    return linkages.four_bar(*lengths, start, at=0.0, law=mbsd.constant_rate(1.0))


def run(problem: str) -> tuple[str, Fresh, Callable[[Any], float]]:
    """Return settings, a fresh run and the error of its result."""
    if problem == calls.SIMULATION:
        return _simulation()
    m, speeds = model(), itertools.count()
    if problem == calls.FOUR_BAR:
        ready, angles = ready_to_solve.prepare(m), calls.ANGLES

        def error(result: Any) -> float:
            return max(calls.worst(result[0][:, k, 2], x) for k, x in zip((2, 3), calls.exact(angles), strict=True))

        words = "closed form of its groups, found by the program, pos+vel+acc"
        return words, lambda: lambda: kinematics_at(ready, angles), error

    def changed() -> Solution:
        m.change("motor", law=mbsd.constant_rate(1.0 + 1e-3 * next(speeds)))
        return m.sweep(steps=calls.STEPS)

    def rocker(sol: Solution) -> float:
        return calls.rocker_error(sol.body("crank").theta, sol.body("rocker").theta)

    if problem == calls.CHANGED:
        return "m.change, m.sweep()", lambda: changed, rocker
    return "m.sweep()", lambda: lambda: m.sweep(steps=calls.STEPS), rocker


def _simulation() -> tuple[str, Fresh, Callable[[Any], float]]:
    m = mbsd.Mechanism("pendulum", gravity=(0.0, -calls.GRAVITY))
    rod = m.bar("rod", calls.LENGTH, mass=calls.MASS)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=0)

    def drift(sol: Solution) -> float:
        return calls.energy_drift(sol.body("rod").theta, sol.body("rod").omega)

    return "m.simulate(10.0)", lambda: lambda: m.simulate(calls.DURATION, steps=calls.OUTPUTS), drift
