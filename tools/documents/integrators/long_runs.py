"""Energy over ten thousand periods of a pendulum and a four-bar, by the solver's own integrators."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.motion import integrate
from mbsd.dynamics.simulate import integrator_named
from mbsd.dynamics.state import EVALUATIONS
from tools.documents.integrators.mechanisms import four_bar, pendulum

PERIODS = 10_000
A_PERIOD = 2.653
"""Outputs in a period, so that they fall on all its phases."""
MARKS = 32
"""Along the logarithm of time, at which the largest error so far is kept."""
RUNS: dict[str, dict[str, float]] = {
    "dop853": {"tolerance": 1e-7},
    "dop853, tight": {"tolerance": 1e-11},
    "radau": {"tolerance": 1e-5},
    "rk4": {"steps": 100},
    "symplectic": {"steps": 80},
    "rattle": {"steps": 400},
    "generalized_alpha": {"steps": 100},
    "baumgarte": {"steps": 100},
}
"""Tolerance, or steps in a period: 400 evaluations of the accelerations for each explicit one. What follows a comma is
no part of the method's name."""


def swing(m: Mechanism) -> tuple[float, float]:
    """Period (s) of a motion that starts at rest, back to its start; largest kinetic energy (J)."""
    sol = m.simulate(10.0, steps=100_000, tolerance=1e-10)
    rate = sol.body(next(name for name in m.bodies if name in ("rod", "crank"))).omega
    ends = np.flatnonzero((rate[1:-1] > 0) != (rate[2:] > 0)) + 1
    where = sol.t[ends] + (sol.t[ends + 1] - sol.t[ends]) * rate[ends] / (rate[ends] - rate[ends + 1])
    return float(where[1]), float(sol.energy.kinetic.max())


def one(m: Mechanism, length: float, scale: float, name: str) -> dict[str, Any]:
    """Largest energy errors so far, as parts of ``scale`` (J); evaluations a period of ``length`` (s); seconds."""
    method, setting = integrator_named(m.name, name.partition(",")[0]), RUNS[name]
    times = np.linspace(0.0, PERIODS * length, int(PERIODS * A_PERIOD) + 1)
    ready = prepare_dynamics(m, 0.0, float(times[-1]))
    tolerance, step = setting.get("tolerance", 1.0), length / setting.get("steps", 1.0)
    integrate(ready, method, times[:3], tolerance, step)  # compiled before the clock starts
    begin = time.process_time()
    state, out = integrate(ready, method, times, tolerance, step)
    seconds = time.process_time() - begin
    kinetic = 0.5 * (out.y[:, 1] ** 2 * ready.dynamics.inertia).sum(axis=1)
    energy = kinetic - out.y[:, 0] @ ready.dynamics.weight
    error = np.maximum.accumulate(np.abs(energy - energy[0])) / scale
    marks = np.unique(np.geomspace(A_PERIOD + 1, len(times) - 1, MARKS).astype(int))
    return {
        "periods": [round(float(at / length), 2) for at in times[marks]],
        "errors": [float(f"{value:.3g}") for value in error[marks]],
        "evaluations": round(float(state.count[EVALUATIONS]) / PERIODS),
        "seconds": seconds,
    }


def measured(tell: Callable[[str], None]) -> dict[str, dict[str, dict[str, Any]]]:
    """By mechanism and name of the run."""
    out: dict[str, dict[str, dict[str, Any]]] = {}
    for make in (pendulum, four_bar):
        length, scale = swing(make())
        out[make().name] = {}
        for name in RUNS:
            out[make().name][name] = numbers = one(make(), length, scale, name)
            tell(f"{make().name}, {length:.4f} s, {name}: {numbers['errors'][-1]}, {numbers['seconds']:.1f} s")
    return out
