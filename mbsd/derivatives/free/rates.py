"""Compiled: how rates of a state and guards of events change near it, in any formulation.

    d(q', v') / d(q, v)      central differences of ``derivative``, n coordinates and k velocities one by one

A state is an array (2, 3 + n), with three idle entries in front and k velocities; see mbsd/dynamics/formulation.py.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.dynamics.events.rows import release_rows
from mbsd.dynamics.events.users import act, value_of
from mbsd.dynamics.formulation import along, derivative, measure, project

IDLE = 3
"""Idle entries in front of a state."""


@kernel
def differentiate_rates(dyn, scratch, t, y, step, k, trial, out, lam, matrix):
    """Fill matrix (T, n + k, n + k) with d(q', v') / d(q, v) at t (T,) (s) and states y (T, 2, 3 + n).

    ``step`` (2, 3 + n): how far coordinates and velocities go. trial (2, 3 + n), out (2, 2, 3 + n), lam (m,): scratch.
    """
    n = y.shape[2] - IDLE
    for r in range(y.shape[0]):
        for part in range(2):
            for c in range(y.shape[2]):
                trial[part, c] = y[r, part, c]
        for part in range(2):
            for c in range(n if part == 0 else k):
                here = trial[part, IDLE + c]
                ahead = here + step[part, IDLE + c]
                behind = here - step[part, IDLE + c]
                trial[part, IDLE + c] = ahead
                derivative(dyn, scratch, t[r], trial, out[0], lam)
                trial[part, IDLE + c] = behind
                derivative(dyn, scratch, t[r], trial, out[1], lam)
                trial[part, IDLE + c] = here
                for i in range(n):
                    matrix[r, i, part * n + c] = (out[0, 0, IDLE + i] - out[1, 0, IDLE + i]) / (ahead - behind)
                for i in range(k):
                    matrix[r, n + i, part * n + c] = (out[0, 1, IDLE + i] - out[1, 1, IDLE + i]) / (ahead - behind)


@kernel
def tabulate_rates(dyn, scratch, t, y, lam, out):
    """Fill out (T, 2, 3 + n) with q' and v' at t (T,) (s) and states y (T, 2, 3 + n); lam (m,) is scratch."""
    for r in range(y.shape[0]):
        derivative(dyn, scratch, t[r], y[r], out[r], lam)


@kernel
def tabulate_gaps(dyn, scratch, row, t, y, out):
    """Fill out (2, T) with the gap of a row of J and J v at t (T,) (s) and states y (T, 2, 3 + n)."""
    for r in range(y.shape[0]):
        measure(dyn, scratch, t[r], y[r, 0])
        out[0, r] = scratch.ws.phi[row]
        out[1, r] = along(dyn, scratch, row, y[r, 1])


@kernel
def tabulate_values(events, e, t, y, out):
    """Fill out (T,) with the value of event e of the user at t (T,) (s) and states y (T, 2, 3 + n)."""
    for r in range(y.shape[0]):
        out[r] = value_of(events, e, t[r], y[r, 0], y[r, 1])


@kernel
def let_act(dyn, scratch, contacts, events, e, t, y):
    """Let the compiled action of event e change velocities of a state y (2, 3 + n) at t (s), as the loop does."""
    act(events, e, t, y[0], y[1])
    release_rows(dyn, contacts)
    project(dyn, scratch, t, y, 2)
