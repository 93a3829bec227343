"""mbsd: m.sweep() and m.simulate() with all their results: motion, reactions, torque, checks."""

from __future__ import annotations

import itertools

import mbsd
from benchmarks.calls import (
    CHANGED,
    DURATION,
    GRAVITY,
    LENGTH,
    MASS,
    OUTPUTS,
    SIMULATION,
    STEPS,
    SWEEP,
    Call,
    energy_drift,
    rocker_error,
)
from benchmarks.four_bar.mbsd_code import model
from mbsd.results.solution import Solution

VERSION = mbsd.__version__


def calls() -> list[Call]:
    """By problem."""
    linkage, changing, speeds = model(), model(), itertools.count()

    def changed() -> Solution:
        changing.change("motor", law=mbsd.constant_rate(1.0 + 1e-3 * next(speeds)))
        return changing.sweep(steps=STEPS)

    def rocker(sol: Solution) -> float:
        return rocker_error(sol.body("crank").theta, sol.body("rocker").theta)

    pendulum = mbsd.Mechanism("pendulum", gravity=(0.0, -GRAVITY))
    rod = pendulum.bar("rod", LENGTH, mass=MASS)
    pendulum.revolute("A", pendulum.ground.at(0, 0), rod.start)
    pendulum.start_near(rod=0)

    def drift(sol: Solution) -> float:
        return energy_drift(sol.body("rod").theta, sol.body("rod").omega)

    return [
        Call(SWEEP, "m.sweep()", lambda: linkage.sweep(steps=STEPS), rocker),
        Call(CHANGED, "m.change, m.sweep()", changed, rocker),
        Call(SIMULATION, "m.simulate(10.0)", lambda: pendulum.simulate(DURATION, steps=OUTPUTS), drift),
    ]
