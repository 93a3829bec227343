"""State, outputs and settings of a run, as integrators read and write them.

n: entries of a row of the state, in the plane three for each body; see formulation.py.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import inlined, shared

REACHED, PAUSED, STEP_TOO_SMALL, NOT_FINITE, NO_CONVERGENCE, CHOOSE, UNCLEAR = 0, 1, 2, 3, 4, 5, 6
"""What ``advance`` returns: the end was reached, the allowed steps were used, or why it cannot go on.

Of independent coordinates: other ones may be better, or an output falls on a pose that they do not tell clearly.
"""
TIME, STEP, WORK, POWER, ERROR = 0, 1, 2, 3, 4
"""Entries of State.clock."""
NEXT, ACCEPTED, REJECTED, EVALUATIONS, STARTED = 0, 1, 2, 3, 4
"""Entries of State.count."""


class State(NamedTuple):
    """Where a run stands; enough to go on from, so a copy is a point to return to."""

    y: Any
    """(2, n) coordinates and velocities."""
    dy: Any
    """(2, n) their derivative; valid once STARTED."""
    lam: Any
    """(m,)"""
    memory: Any
    """(2, n) what a method itself remembers from step to step; a restart makes it anew."""
    clock: Any
    """(8,) time (s), next step (s), work of loads and drivers so far (J), their power (W), last error."""
    count: Any
    """(8,) next output, steps accepted and rejected, evaluations, whether dy is valid."""


class Output(NamedTuple):
    """Results at the output times."""

    t: Any
    """(T,) s, rising."""
    y: Any
    """(T, 2, n)"""
    a: Any
    """(T, n)"""
    lam: Any
    """(T, m); (0, m) where neither multipliers nor accelerations are asked for."""
    work: Any
    """(T,) of loads and drivers since the start (J)."""
    margin: Any
    """(T,) least part of a block's determinant left by elimination."""


class Settings(NamedTuple):
    """Tolerances and lengths of steps."""

    absolute: Any
    """(2, n) absolute tolerance of coordinates and velocities."""
    relative: float
    """Relative tolerance of velocities and of x and y."""
    growing: Any
    """(2, n) the same for each entry; 0 for angles, which are no less exact after many turns."""
    longest: float
    """s"""
    smallest: float
    """Step (s) at which a method with an error estimate gives up."""
    step: float
    """Step of methods with a fixed step (s)."""
    options: Any
    """(options,) of the method itself, see Integrator.options."""


def start_state(y: np.ndarray, rows: int, time: float) -> State:
    """Return a run that begins at a consistent y (2, n)."""
    state = State(y.copy(), np.zeros_like(y), np.zeros(rows), np.zeros_like(y), np.zeros(8), np.zeros(8, np.int64))
    state.clock[TIME] = time
    return state


def copied(state: State) -> State:
    """Return a copy, to return to."""
    return State(*(part.copy() for part in state))


def output_for(times: np.ndarray, coordinates: int, rows: int) -> Output:
    """Return room for the results at ``times``."""
    count = len(times)
    return Output(
        np.ascontiguousarray(times, float),
        np.zeros((count, 2, coordinates)),
        np.zeros((count, coordinates)),
        np.zeros((count, rows)),
        np.zeros(count),
        np.zeros(count),
    )


@shared
def record_here(scratch, state, out):
    """Write the next output from the state itself, which stands at its time and is projected."""
    k = state.count[NEXT]
    for c in range(state.y.shape[1]):
        out.y[k, 0, c] = state.y[0, c]
        out.y[k, 1, c] = state.y[1, c]
        out.a[k, c] = state.dy[1, c]
    if out.lam.shape[0] > 0:
        for r in range(state.lam.shape[0]):
            out.lam[k, r] = state.lam[r]
    out.work[k] = state.clock[WORK]
    out.margin[k] = scratch.report[0]
    state.count[NEXT] = k + 1


@inlined
def fixed_step(state, out, settings, end):
    """Return the next step (s) of a method with a fixed one, and its end: equal steps up to the next output or end."""
    t = state.clock[TIME]
    target = end
    if state.count[NEXT] < out.t.shape[0] and out.t[state.count[NEXT]] < end:
        target = out.t[state.count[NEXT]]
    left = math.ceil((target - t) / settings.step * (1.0 - 1e-9))
    if left <= 1.0:
        return target - t, target
    return (target - t) / left, t + (target - t) / left
