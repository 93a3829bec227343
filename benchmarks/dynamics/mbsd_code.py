"""mbsd: the same plain data as a Mechanism, by DOP853 in coordinates that the program chooses."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import mbsd
from benchmarks.dynamics.cases import Case
from benchmarks.dynamics.pins import GROUND, Pinned, Record
from benchmarks.dynamics.settings import tolerances
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.motion import in_reference, independent_steps, integrate
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.simulate import integrator_named

VERSION = mbsd.__version__
SAMPLES = 1000


def ladders(case: Case) -> Iterator[list[dict[str, Any]]]:
    """Settings to try, each ladder from cheap to exact."""
    del case
    yield [{"method": "dop853", "tolerance": tol} for tol in tolerances(1e-2, 1e-9, 24)]


def mechanism(model: Pinned, name: str) -> mbsd.Mechanism:
    """As a user would write it, body frames at the centres of mass."""
    m = mbsd.Mechanism(name, gravity=(0.0, -model.gravity))
    bodies = {GROUND: m.ground}
    for k, solid in enumerate(model.solids):
        bodies[k] = m.body(f"body{k}", solid.mass, inertia=solid.inertia)
        x, y, angle = solid.pose
        m.start_near(**{f"body{k}": (x, y, math.degrees(angle))})
        if any(solid.velocity):
            m.start_moving(**{f"body{k}": solid.velocity})
    for k, pin in enumerate(model.pins):
        m.revolute(f"pin{k}", bodies[pin.i].at(*pin.a), bodies[pin.j].at(*pin.b))
    for k, (body, torque) in enumerate(model.torques):
        m.torque(f"torque{k}", bodies[body], torque)
    for k, s in enumerate(model.springs):
        m.spring(f"spring{k}", bodies[s.i].at(*s.a), bodies[s.j].at(*s.b), s.stiffness, free_length=s.length)
    return m


def ready(case: Case) -> PreparedDynamics:
    """Packed, assembled and factorised, ready to integrate."""
    return prepare_dynamics(mechanism(case.model, case.name.replace(" ", "_")), 0.0, case.duration)


def started(
    prepared: PreparedDynamics, method: Integrator, tolerance: float, times: np.ndarray
) -> tuple[Callable[[], Any], Any]:
    """Return a run from the start that is ready to be timed, and its outputs at ``times`` (s)."""
    duration = float(times[-1])
    state, out = prepared.begun(times)
    run = Run(prepared, method, tolerance, duration, duration, {})
    independent = independent_steps(run, state)
    to_end = independent.to_end if independent else partial(in_reference, run)
    return lambda: to_end(state, out), out


def prepare(case: Case, settings: dict[str, Any]) -> tuple[Callable[[], Callable[[], Any]], Callable[[], Record]]:
    """``fresh`` gives a run that starts anew, whose making is not timed; ``record`` what it computes."""
    prepared, method = ready(case), integrator_named(case.name, settings["method"])
    ends = np.array([0.0, case.duration])

    def fresh() -> Callable[[], Any]:
        return started(prepared, method, settings["tolerance"], ends)[0]

    def record() -> Record:
        times = np.linspace(0.0, case.duration, SAMPLES + 1)
        _, out = integrate(prepared, method, times, settings["tolerance"], case.duration)
        states = out.y.reshape(len(times), 2, -1, 3)[:, :, 1:]  # without the ground
        return Record(out.t, states[:, 0], states[:, 1])

    return fresh, record
