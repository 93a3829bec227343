"""Steps of a run in reference coordinates."""

from __future__ import annotations

from mbsd.dynamics import state as run_state
from mbsd.dynamics.runs.pace import Pace
from mbsd.dynamics.runs.refusal import refusal
from mbsd.dynamics.runs.run import Run

NO_LIMIT = 10**12
RECENT = 1e3
"""Steps before a run stops in which what a function of the user did may be why."""


def advance(run: Run, state: run_state.State, out: run_state.Output, end: float, steps: int = NO_LIMIT) -> int:
    """Go on to ``end`` (s), ``steps`` steps at most; returns REACHED or PAUSED, raises SimulationError."""
    ready = run.ready
    status = ready.advance(run.method, ready.dynamics, run.scratch, state, out, run.settings, end, steps)
    accepted = status in (run_state.REACHED, run_state.PAUSED)
    check_callbacks(run, state, accepted)
    if not accepted:
        raise refusal(run, status, state)
    return status


def check_callbacks(run: Run, state: run_state.State, accepted: bool) -> None:
    """Raise what functions of the user raised in steps up to ``state``, ``accepted`` or not."""
    specials = run.ready.packed.specials
    if run.method.fixed_step:
        specials.check()
    elif accepted:
        specials.check_trials()
    else:
        specials.check_trials(state.clock[run_state.TIME] - RECENT * state.clock[run_state.STEP])


def step_to(run: Run, state: run_state.State, out: run_state.Output, end: float) -> None:
    """Go on to ``end`` (s) a step at a time, with word of long runs. Raises SimulationError."""
    pace = Pace(run, state, end, None)
    while advance(run, state, out, end, 1) != run_state.REACHED:
        pace.note()
