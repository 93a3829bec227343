"""Generalised-alpha, of order 2 with a fixed step: implicit, for stiff dampers, stiff springs and contact.

    q1 = q + h v + h^2 ((1/2 - b) x + b x1)        v1 = v + h ((1 - g) x + g x1)
    (1 - m) x1 + m x = (1 - f) a(t1, q1, v1) + f a(t, q, v)

    m = (2 r - 1) / (r + 1),   f = r / (r + 1),   g = 1/2 + f - m,   b = (g + 1/2)^2 / 4

a(t, q, v) is the acceleration with the multipliers eliminated, x an average of it that the method remembers. r (option
``rho``, 0.8 if not given) is what one step leaves of an infinitely fast oscillation: 1 keeps all energy, 0 removes it
at once; slow motion is hardly damped. x1 is found by Newton's method with the matrix
(1 - m) 1 - (1 - f) (h^2 b A + h g B) by differences, kept while it converges; each step is then projected twice onto
the constraints.

Source: Chung, Hulbert 1993, J. Appl. Mech. 60; Arnold, Bruels 2007, Multibody Syst. Dyn. 18 (constrained systems;
there the multipliers are unknowns of the step, here they are eliminated).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, kernel
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import begin_run, close_step, derivative
from mbsd.dynamics.integrators.full_matrix import differentiate, factor_full, solve_full, too_large
from mbsd.dynamics.integrators.kind import Integrator, Option, register
from mbsd.dynamics.state import fixed_step, record_here

STAGES = 5
PASSES = 30
CLOSED = 1e-13
"""A pass that moves coordinates by less (sizes, rad) ends a step."""
ROUNDING = 1e-9
"""Below this (sizes, rad) passes that no longer shrink are rounding."""
SLOW = 0.3
"""A pass that leaves more of the last correction asks for a new matrix."""


@internal
def _matrix(dyn, scratch, t, trial, a, h, rho):
    """Factor the matrix at a trial state (2, 3 nb); returns the evaluations it took."""
    full = scratch.full
    m, f, g, b = _weights(rho)
    count = differentiate(dyn, scratch, t, trial, a, scratch.stages[3], scratch.stages[4])
    size = trial.shape[1] - 3
    for i in range(size):
        for j in range(size):
            full.value[2, i, j] = -(1.0 - f) * h * (h * b * full.value[0, i, j] + g * full.value[1, i, j])
        full.value[2, i, i] += 1.0 - m
    factor_full(full, 2, size)
    return count


@internal
def _weights(rho):
    """Return m, f, g, b."""
    m = (2.0 * rho - 1.0) / (rho + 1.0)
    f = rho / (rho + 1.0)
    g = 0.5 + f - m
    return m, f, g, 0.25 * (g + 0.5) ** 2


@internal
def _predict(scratch, state, h, rho):
    """Put what a step of h (s) knows at its begin into stages[1] and the first row of stages[2]."""
    y = state.y
    x = state.memory[0]
    known = scratch.stages[1]
    slope = scratch.stages[2]
    m, f, g, b = _weights(rho)
    if state.clock[run_state.STEP] > 0.0:
        for c in range(3, y.shape[1]):  # x is the acceleration at a part of a step after t
            x[c] = state.dy[1, c] + h / state.clock[run_state.STEP] * (x[c] - state.dy[1, c])
    for c in range(3, y.shape[1]):
        known[0, c] = y[0, c] + h * (y[1, c] + h * (0.5 - b) * x[c])
        known[1, c] = y[1, c] + h * (1.0 - g) * x[c]
        slope[0, c] = m * x[c] - f * state.dy[1, c]


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    y = state.y
    x = state.memory[0]
    trial = scratch.state
    known = scratch.stages[1]
    slope = scratch.stages[2]
    side = scratch.full.side[2]
    n3 = y.shape[1]
    rho = settings.options[0]
    m, f, g, b = _weights(rho)
    if state.count[run_state.STARTED] == 0:
        state.clock[run_state.STEP] = 0.0
    begin_run(dyn, scratch, state)
    if state.clock[run_state.STEP] == 0.0:  # a start, or a restart after an event
        for c in range(3, n3):
            x[c] = state.dy[1, c]
    factored = 0.0  # the step that the matrix was made for
    accepted = 0
    while True:
        t = state.clock[run_state.TIME]
        if state.count[run_state.NEXT] < out.t.shape[0] and out.t[state.count[run_state.NEXT]] <= t:
            record_here(scratch, state, out)
            continue
        if t >= end:
            return run_state.REACHED
        if accepted == max_steps:
            return run_state.PAUSED
        h, reached = fixed_step(state, out, settings, end)
        if abs(h - factored) > 1e-6 * h:
            factored = 0.0
        _predict(scratch, state, h, rho)
        last = 1e300
        converged = False
        for k in range(PASSES):
            for c in range(3, n3):
                trial[0, c] = known[0, c] + h * h * b * x[c]
                trial[1, c] = known[1, c] + h * g * x[c]
            derivative(dyn, scratch, reached, trial, scratch.stages[0], scratch.ws.right[1])
            state.count[run_state.EVALUATIONS] += 1
            for c in range(3, n3):
                slope[1, c] = scratch.stages[0, 1, c]
            if factored == 0.0 or (k == 4 or k == 12):
                state.count[run_state.EVALUATIONS] += _matrix(dyn, scratch, reached, trial, slope[1], h, rho)
                factored = h
                last = 1e300
            for c in range(3, n3):
                side[c - 3] = (1.0 - f) * slope[1, c] - (1.0 - m) * x[c] - slope[0, c]
            solve_full(scratch.full, 2, n3 - 3)
            moved = 0.0
            for c in range(3, n3):
                x[c] += side[c - 3]
                size = h * h * abs(side[c - 3]) * dyn.per_size[c]
                if not size <= moved:
                    moved = size
            if moved <= CLOSED or (moved <= ROUNDING and moved > SLOW * last):
                converged = True
                break
            if not moved < 1e300:
                break
            last = moved
        if not converged:
            return run_state.NO_CONVERGENCE
        if k > 3:
            factored = 0.0
        for c in range(3, n3):
            y[0, c] = known[0, c] + h * h * b * x[c]
            y[1, c] = known[1, c] + h * g * x[c]
        state.clock[run_state.WORK] += 0.5 * h * state.clock[run_state.POWER]
        if not close_step(dyn, scratch, reached, y):
            return run_state.NO_CONVERGENCE
        state.clock[run_state.POWER] = derivative(dyn, scratch, reached, y, state.dy, state.lam)
        state.clock[run_state.WORK] += 0.5 * h * state.clock[run_state.POWER]
        state.clock[run_state.TIME] = reached
        state.clock[run_state.STEP] = h
        state.count[run_state.EVALUATIONS] += 1
        state.count[run_state.ACCEPTED] += 1
        accepted += 1
        if not math.isfinite(state.clock[run_state.POWER] + scratch.report[1]):
            return run_state.NOT_FINITE


GENERALIZED_ALPHA = register(
    Integrator(
        "generalized_alpha",
        advance,
        STAGES,
        order=2,
        fixed_step=True,
        options={"rho": Option(0.8, 0.0, 1.0)},
        matrices=(3, 1),
        refusal=too_large,
    )
)
