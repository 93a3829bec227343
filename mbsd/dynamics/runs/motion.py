"""Runs in the coordinates that suit them: independent ones where there are some, else reference coordinates."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from mbsd.base.errors import ModelError, SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.independent.embedding import NO_PLAN, Embedded, can_embed, embed, embedded_at_start
from mbsd.dynamics.independent.steps import IndependentSteps
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.multipliers import fill_multipliers
from mbsd.dynamics.runs.carried_steps import CarriedSteps, can_carry
from mbsd.dynamics.runs.pace import Pace
from mbsd.dynamics.runs.run import AUTO, INDEPENDENT, REFERENCE, Run
from mbsd.dynamics.runs.steps import advance


def to_end(
    run: Run, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
) -> bool:
    """Go on to the last output time, from a start or restart; returns whether in independent coordinates.

    Then multipliers and margins are still to be found (reference/multipliers.py). Raises SimulationError, and
    ModelError if independent coordinates are asked for and impossible.
    """
    independent = independent_steps(run, state)
    if independent is None:
        in_reference(run, state, out, progress)
        return False
    independent.to_end(state, out, progress)
    return True


def independent_steps(run: Run, state: run_state.State) -> IndependentSteps | None:
    """Steps in independent coordinates from this state on, or None where the run stays in reference coordinates.

    Raises ModelError if independent coordinates are asked for and impossible.
    """
    if run.formulation == REFERENCE or (run.formulation == AUTO and run.ready.masses_apart):
        return None  # independent coordinates solve once, and lose the digits of the light bodies
    why, made = _choice(run, state)
    if made is not None and (made.pays or run.formulation == INDEPENDENT):
        return IndependentSteps(run, made, state)
    if run.formulation == INDEPENDENT:
        raise ModelError(f"{run.ready.packed.name}: formulation='independent' is not possible here: {why}")
    return None


def _choice(run: Run, state: run_state.State) -> tuple[str | None, Embedded | None]:
    if not run.method.independent:
        return f"method '{run.method.name}' works in reference coordinates", None
    why = can_embed(run.ready)
    if why is not None:
        return why, None
    if np.array_equal(state.y[0], run.ready.initial.q) and np.array_equal(state.y[1], run.ready.initial.v):
        return NO_PLAN, embedded_at_start(run.ready)
    return NO_PLAN, embed(run.ready, state.y[0], state.y[1], float(state.clock[run_state.TIME]))


def in_reference(
    run: Run, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
) -> None:
    """Go on to the last output time in reference coordinates; where these are asked for, independent ones carry them
    across singular poses."""
    end = float(out.t[-1])
    if run.formulation == REFERENCE and can_carry(run):
        if CarriedSteps(run, state, out, Pace(run, state, end, progress)).to_end():
            fill_multipliers(run.ready.packed, run.ready.dynamics, out.t, out.y, out.lam, out.margin)
        return
    pace = None if progress is None else Pace(run, state, end, progress)
    while advance(run, state, out, end, run.steps_at_once) != run_state.REACHED:
        pace = pace or Pace(run, state, end, progress)
        pace.note()
    if pace is not None:
        pace.note()


def integrate(
    ready: PreparedDynamics,
    method: Integrator,
    times: np.ndarray,
    tolerance: float,
    step: float,
    progress: Callable[[float], None] | None = None,
    options: Mapping[str, float] | None = None,
    formulation: str = AUTO,
) -> tuple[run_state.State, run_state.Output]:
    """Integrate to the last of ``times`` (s), which begin with the start; no events. Raises SimulationError.

    Multipliers are found in reference coordinates alone.
    """
    state, out = ready.begun(times)
    run = Run(ready, method, tolerance, step, float(times[-1] - times[0]), options or {}, formulation)
    to_end(run, state, out, progress)
    missing = len(times) - int(state.count[run_state.NEXT])
    if missing:
        raise SimulationError(
            f"{ready.packed.name}: the last {missing} of {len(times)} outputs were not reached, which is a fault of "
            "mbsd, not of the model; formulation='reference' goes another way"
        )
    return state, out
