"""Radau IIA of order 5 with variable step: implicit, for stiff dampers and springs, each step projected twice.

    Z_i = h sum A_ij f(t + c_j h, y + Z_j)      i = 1 .. 3
    y1 = y + Z_3,   then q and v are projected
    err = (mu 1 - f_y)^-1 (f(t, y) + sum E_i Z_i / h),  mu = REAL / h
    h  *= safety err^(-1/4), with the step before in mind, within 0.2 .. 10

f is the derivative with the multipliers eliminated; Z is found by Newton's method with A = da/dq and B = da/dv by
differences, kept while it converges. Outputs come from the polynomial through the stages, of order 3, and are projected
too. The method damps what is faster than its steps and keeps its order where the damping is stiff.

Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8 (RADAU5); order of its parts as in scipy.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal, kernel
from mbsd.dynamics.formulation import begin_run, derivative, project, record_output
from mbsd.dynamics.integrators.full_matrix import differentiate, too_large
from mbsd.dynamics.integrators.kind import Integrator, register
from mbsd.dynamics.integrators.radau.newton import (
    AFTER,
    ERROR_ROW,
    OTHER,
    Z,
    factor_both,
    find_stages,
    norm,
    solve_real,
)
from mbsd.dynamics.integrators.radau.tableau import WEIGHTS, D, E
from mbsd.dynamics.integrators.step_size import first_step
from mbsd.dynamics.state import (
    ACCEPTED,
    EVALUATIONS,
    NEXT,
    NOT_FINITE,
    PAUSED,
    POWER,
    REACHED,
    REJECTED,
    STEP,
    STEP_TOO_SMALL,
    TIME,
    WORK,
    record_here,
)

STAGES = 13
SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""
PASSES = 6
KEPT = 1e-3
"""Rate of convergence below which A and B are kept."""
CONTRACTION = 0.1
"""The second projection must change the pose by less than this part of the first."""
ROUNDING = 1e-9
"""Changes below this (sizes, rad) are rounding in an ill-conditioned pose, and accepted."""


@internal
def _extrapolate(scratch, ratio):
    """Guess Z from the polynomial of the step before, which was 1 / ratio as long."""
    k = scratch.stages
    for part in range(2):
        for c in range(3, k.shape[2]):
            first = 0.0
            second = 0.0
            third = 0.0
            end = k[Z + 2, part, c]
            for i in range(3):
                first += D[i, 0] * k[Z + i, part, c]
                second += D[i, 1] * k[Z + i, part, c]
                third += D[i, 2] * k[Z + i, part, c]
            for i in range(3):
                x = 1.0 + ratio * (WEIGHTS[i, 0] + WEIGHTS[i, 1] + WEIGHTS[i, 2])
                k[Z + i, part, c] = x * (first + x * (second + x * third)) - end


@apart
def _estimate(dyn, scratch, state, settings, h, again):
    """Return the error of the step in tolerances; ``again`` filters it once more, after a step was refused."""
    k = scratch.stages
    y = state.y
    err = k[ERROR_ROW]
    n3 = y.shape[1]
    for part in range(2):
        for c in range(3, n3):
            ahead = 0.0
            for i in range(3):
                ahead += E[i] * k[Z + i, part, c]
            k[OTHER, part, c] = ahead / h
            err[part, c] = state.dy[part, c] + ahead / h
    solve_real(dyn, scratch, y[0], h, err)
    size = norm(settings, y, k[AFTER], err)
    if again and size > 1.0:
        for part in range(2):
            for c in range(3, n3):
                scratch.state[part, c] = y[part, c] + err[part, c]
        derivative(dyn, scratch, state.clock[TIME], scratch.state, k[0], scratch.ws.right[1])
        state.count[EVALUATIONS] += 1
        for part in range(2):
            for c in range(3, n3):
                err[part, c] = k[0, part, c] + k[OTHER, part, c]
        solve_real(dyn, scratch, y[0], h, err)
        size = norm(settings, y, k[AFTER], err)
    return size


@apart
def _outputs(dyn, scratch, state, out, h, reached):
    """Write the outputs within the step, from the polynomial through its stages."""
    k = scratch.stages
    while state.count[NEXT] < out.t.shape[0] and out.t[state.count[NEXT]] < reached:
        at = state.count[NEXT]
        x = (out.t[at] - state.clock[TIME]) / h
        work = 0.0
        for i in range(3):
            shape = x * (D[i, 0] + x * (D[i, 1] + x * D[i, 2]))
            for j in range(3):
                work += h * shape * WEIGHTS[i, j] * scratch.power[j]
        for part in range(2):
            for c in range(3, k.shape[2]):
                value = state.y[part, c]
                for i in range(3):
                    value += x * (D[i, 0] + x * (D[i, 1] + x * D[i, 2])) * k[Z + i, part, c]
                scratch.state[part, c] = value
        record_output(dyn, scratch, out, at, state.clock[WORK] + work)
        state.count[EVALUATIONS] += 1
        state.count[NEXT] = at + 1


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` accepted steps at most, writing the outputs passed. Returns a status."""
    y = state.y
    k = scratch.stages
    n3 = y.shape[1]
    newton = max(2.3e-15 / settings.relative, min(0.03, math.sqrt(settings.relative)))
    begin_run(dyn, scratch, state)
    if state.clock[STEP] == 0.0:
        state.clock[STEP] = first_step(dyn, scratch, state, settings, 0.25)
    accepted = 0
    refused = False
    current = False  # A and B belong to this step
    usable = False  # A and B may be used
    factored = 0.0  # the step that the matrices were factored for
    before = 0.0  # length and error of the last accepted step
    error_before = 0.0
    while True:
        t = state.clock[TIME]
        while state.count[NEXT] < out.t.shape[0] and out.t[state.count[NEXT]] <= t:
            record_here(scratch, state, out)
        if t >= end:
            return REACHED
        if accepted == max_steps:
            return PAUSED
        h = min(state.clock[STEP], settings.longest)
        if h < SMALLEST_STEP * settings.longest and t + h < end:
            return STEP_TOO_SMALL
        last = t + h >= end
        if last:
            h = end - t
        if before > 0.0 and not refused:
            _extrapolate(scratch, h / before)
        else:
            for i in range(3):
                for part in range(2):
                    for c in range(3, n3):
                        k[Z + i, part, c] = 0.0
        passes = -1
        while passes < 0:
            if not usable:
                state.count[EVALUATIONS] += differentiate(dyn, scratch, t, y, state.dy[1], k[0], k[OTHER])
                usable = True
                current = True
                factored = 0.0
            if factored != h:
                factor_both(scratch, h, n3 - 3)
                factored = h
            passes = find_stages(dyn, scratch, state, settings, h, newton)
            if passes < 0:
                if current:
                    break
                usable = False
                for i in range(3):
                    for part in range(2):
                        for c in range(3, n3):
                            k[Z + i, part, c] = 0.0
        error = 1e9
        if passes > 0:
            for part in range(2):
                for c in range(3, n3):
                    k[AFTER, part, c] = y[part, c] + k[Z + 2, part, c]
            error = _estimate(dyn, scratch, state, settings, h, refused or before == 0.0)
            if error < 1.0:
                project(dyn, scratch, t + h, k[AFTER], 2)
                if not scratch.report[2] <= max(CONTRACTION * scratch.report[1], ROUNDING):
                    passes = -1
        factor = 0.5
        if passes > 0 and error == error:
            factor = error**-0.25 if error > 0.0 else 10.0
            if before > 0.0 and error > 0.0:
                factor *= min(1.0, h / before * (error_before / error) ** 0.25)
            factor *= 0.9 * (2.0 * PASSES + 1.0) / (2.0 * PASSES + passes)
        if passes < 0 or not error < 1.0:
            if h < SMALLEST_STEP * settings.longest:
                return NOT_FINITE
            state.clock[STEP] = h * max(0.2, min(factor, 0.9))
            state.count[REJECTED] += 1
            refused = True
            continue
        reached = end if last else t + h
        _outputs(dyn, scratch, state, out, h, reached)
        for i in range(3):
            state.clock[WORK] += h * WEIGHTS[2, i] * scratch.power[i]
        for part in range(2):
            for c in range(3, n3):
                y[part, c] = k[AFTER, part, c]
        state.clock[POWER] = derivative(dyn, scratch, reached, y, state.dy, state.lam)
        state.clock[TIME] = reached
        state.count[EVALUATIONS] += 1
        state.count[ACCEPTED] += 1
        accepted += 1
        usable = passes <= 2 or scratch.report[3] <= KEPT
        current = False
        factor = min(10.0, factor)
        if refused:
            factor = min(factor, 1.0)
        if (usable and 1.0 <= factor < 1.2) or (last and factor > 1.0):
            factor = 1.0
        if not last or factor < 1.0:
            state.clock[STEP] = min(h * factor, settings.longest)
        before = h
        error_before = max(error, 1e-4)
        refused = False


RADAU = register(
    Integrator("radau", advance, STAGES, order=5, fixed_step=False, general=True, matrices=(4, 2), refusal=too_large)
)
