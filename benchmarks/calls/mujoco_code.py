"""MuJoCo: one hinge by a rollout of all steps; a linkage can only be driven softly."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from mujoco.rollout import rollout

from benchmarks.calls import DURATION, GRAVITY, LENGTH, MASS, OUTPUTS, energy_drift
from benchmarks.harness import Fresh

VERSION = mujoco.__version__
INERTIA = MASS * LENGTH**2 / 12


def run(problem: str) -> tuple[str, Fresh, Callable[[Any], float]]:
    """Return settings, a fresh run of the simulation and the error of its result."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{DURATION / OUTPUTS}" integrator="RK4" gravity="0 {-GRAVITY} 0"/><worldbody>'
        f'<body><joint type="hinge" axis="0 0 1"/><inertial pos="{LENGTH / 2} 0 0" mass="{MASS}" '
        f'diaginertia="{INERTIA / 2!r} {INERTIA / 2!r} {INERTIA!r}"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = np.zeros(mujoco.mj_stateSize(model, kind))

    def call() -> np.ndarray:
        mujoco.mj_resetData(model, data)
        mujoco.mj_getState(model, data, start, kind)
        states, _ = rollout(model, data, start, nstep=OUTPUTS)
        return np.asarray(states)[0]

    def error(states: Any) -> float:
        return energy_drift(states[:, 1], states[:, 2])  # after the time

    return f"rollout, RK4, steps {OUTPUTS}", lambda: call, error
