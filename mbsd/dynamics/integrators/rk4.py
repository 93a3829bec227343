"""The classical Runge-Kutta method of order 4 with a fixed step, each step projected twice onto the constraints.

A step so long that no pose near its end closes the joints ends the run.

    k1 = f(t, y),  k2 = f(t + h/2, y + h/2 k1),  k3 = f(t + h/2, y + h/2 k2),  k4 = f(t + h, y + h k3)
    y1 = y + h/6 (k1 + 2 k2 + 2 k3 + k4),   then q and v are projected

The steps between two outputs are equal and hit both. Source: Kutta 1901; Hairer, Norsett, Wanner, Solving ODEs I, II.1.

'baumgarte' is for teaching: RK4 without projection; errors of the constraints are pulled to zero.

    J a = gamma - 2 alpha (J v - nu) - beta^2 Phi

Errors of the constraints then follow e'' + 2 alpha e' + beta^2 e = what a step adds, critically damped where alpha =
beta. They stay small and are never zero, and there is no best alpha: too small and the joints come open, too large
(alpha times the step above 2.7) and the run blows up. Projection, as all other methods here do it, has neither fault.
Reactions hold the pull of the stabilisation too.

Its options are alpha and beta (1/s), both 10 if not given; alpha = 0 shows the bare drift.

Source: Baumgarte 1972, Comp. Meth. Appl. Mech. Eng. 1; Flores et al. 2011, J. Comput. Nonlinear Dyn. 6 (alpha).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, kernel
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import begin_run, close_step, derivative
from mbsd.dynamics.integrators.kind import Integrator, Option, register
from mbsd.dynamics.state import fixed_step, record_here

STAGES = 4


@apart
def march(dyn, scratch, state, out, settings, end, max_steps, projected):
    """Advance with the end of each step ``projected``, or as it is."""
    y = state.y
    k = scratch.stages
    trial = scratch.state
    n3 = y.shape[1]
    begin_run(dyn, scratch, state)
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
        for part in range(2):
            for c in range(3, n3):
                k[0, part, c] = state.dy[part, c]
        scratch.power[0] = state.clock[run_state.POWER]
        for s in range(1, 4):
            ahead = h if s == 3 else 0.5 * h
            for part in range(2):
                for c in range(3, n3):
                    trial[part, c] = y[part, c] + ahead * k[s - 1, part, c]
            scratch.power[s] = derivative(dyn, scratch, t + ahead, trial, k[s], scratch.ws.right[1])
        for part in range(2):
            for c in range(3, n3):
                y[part, c] += h / 6.0 * (k[0, part, c] + 2.0 * (k[1, part, c] + k[2, part, c]) + k[3, part, c])
        state.clock[run_state.WORK] += (
            h / 6.0 * (scratch.power[0] + 2.0 * (scratch.power[1] + scratch.power[2]) + scratch.power[3])
        )
        if projected and not close_step(dyn, scratch, reached, y):
            return run_state.NO_CONVERGENCE
        state.clock[run_state.POWER] = derivative(dyn, scratch, reached, y, state.dy, state.lam)
        state.clock[run_state.TIME] = reached
        state.count[run_state.EVALUATIONS] += 4
        state.count[run_state.ACCEPTED] += 1
        accepted += 1
        total = 0.0
        for c in range(3, n3):
            total += abs(state.dy[1, c])
        if not math.isfinite(total):
            return run_state.NOT_FINITE


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    return march(dyn, scratch, state, out, settings, end, max_steps, True)


RK4 = register(Integrator("rk4", advance, STAGES, order=4, fixed_step=True, general=True))


@kernel
def advance_baumgarte(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    dyn.baumgarte[0] = settings.options[0]
    dyn.baumgarte[1] = settings.options[1]
    status = march(dyn, scratch, state, out, settings, end, max_steps, False)
    dyn.baumgarte[0] = 0.0
    dyn.baumgarte[1] = 0.0
    return status


BAUMGARTE = register(
    Integrator(
        "baumgarte",
        advance_baumgarte,
        STAGES,
        order=4,
        fixed_step=True,
        options={"alpha": Option(10.0, 0.0, 1e9), "beta": Option(10.0, 0.0, 1e9)},
    )
)
