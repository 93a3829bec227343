"""Steps of a run in reference coordinates."""

from __future__ import annotations

from mbsd.dynamics import state as run_state
from mbsd.dynamics.prepare.exchange import exchange_rows
from mbsd.dynamics.rows.bounds import LOOK
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
    turn = 0
    while True:
        if turn % LOOK == 0:
            exchange_rows(run.ready, state)
        turn += 1
        status = advance(run, state, out, end, 1)
        pace.note()
        if status == run_state.REACHED:
            return


def some_steps(run: Run, state: run_state.State, out: run_state.Output, end: float) -> int:
    """As :func:`advance`, with a look at rows that repeat others now and then."""
    if not run.ready.switches.spare:
        return advance(run, state, out, end, run.steps_at_once)
    status = run_state.PAUSED
    for _ in range(0, run.steps_at_once, LOOK):
        exchange_rows(run.ready, state)
        status = advance(run, state, out, end, LOOK)
        if status == run_state.REACHED:
            break
    return status
