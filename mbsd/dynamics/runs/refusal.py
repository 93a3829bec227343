"""Why a run cannot go on, in words that name the place and the remedy."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.friction_along import REMEDY, jam
from mbsd.base.errors import SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.runs.diagnosis import jump
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.runs.runaway import runaway_at
from mbsd.equations.joint_friction import FAILED, X

JUMP_STEP = 1e-9
"""Part of the longest step within which a force that jumps is looked for where steps shrink to nothing."""


def refusal(run: Run, status: int, state: run_state.State) -> SimulationError:
    """The error of a run whose step ended with ``status`` in ``state``: where, why, and what helps."""
    packed, method = run.ready.packed, run.method
    bodies = len(packed.body_names) - packed.states
    time, speeds = state.clock[run_state.TIME], np.abs(state.y[1].reshape(-1, 3)[1:bodies])
    fastest = packed.body_names[1 + int(np.argmax((speeds / [packed.size, packed.size, 1]).max(1)))]
    where = f"{packed.name}: {method.name} stops at t = {time:.6g} s, where '{fastest}' is fastest"
    if status == run_state.NO_CONVERGENCE:
        own = ", or method='dop853'; stiff springs and dampers ask for method='radau'" if method.fixed_step else ""
        return SimulationError(
            f"{where}: the equations of a step of {run.settings.step:.3g} s have no solution near the last one. "
            f"Take a smaller step{own}, or look for a force or law that jumps."
        )
    loads = run.ready.dynamics.loads
    if loads.iteration[FAILED]:
        return SimulationError(f"{where}: {jam(packed, loads.normal[X])}. {REMEDY}, or raise slip_speed.")
    if method.fixed_step:
        return SimulationError(
            f"{where}: numbers are no longer finite after a step of {run.settings.step:.3g} s. "
            "Take a smaller step, or method='dop853'; stiff springs and dampers ask for method='radau'."
        )
    short = f"steps below {state.clock[run_state.STEP]:.1e} s do not meet the tolerance {run.tolerance:g}"
    growing = runaway_at(run, state)
    if growing is not None:
        return SimulationError(f"{where}: {short}; {growing}")
    jumping = jump(run, state, JUMP_STEP * run.settings.longest)
    if jumping is not None:
        return SimulationError(f"{where}: {short}; {jumping}")
    return SimulationError(
        f"{where}: {short}. "
        "The pose is singular here, or a force jumps or grows without bound; change the lengths, smooth the force, "
        "or loosen the tolerance."
    )
