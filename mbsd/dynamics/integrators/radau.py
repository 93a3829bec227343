"""Radau IIA of order 5 with variable step: implicit, for stiff dampers and springs, each step projected twice.

    Z_i = h sum A_ij f(t + c_j h, y + Z_j)      i = 1 .. 3
    y1 = y + Z_3,   then q and v are projected
    err = (mu 1 - f_y)^-1 (f(t, y) + sum E_i Z_i / h),  mu = REAL / h
    h  *= safety err^(-1/4), with the step before in mind, within 0.2 .. 10

f is the derivative with the multipliers eliminated; Z is found by Newton's method with A = da/dq and B = da/dv by
differences, kept while it converges. Outputs come from the polynomial through the stages, of order 3, and are projected
too. The method damps what is faster than its steps and keeps its order where the damping is stiff.

The linear equations of Newton's method are decoupled, and halved by q' = N(q) v:

    y' = f(t, y),  y = (q, v),  f = (N v, a):     (mu 1 - f_y) x = r   is
    (mu 1 - B - A / mu) x_v = r_v + A s / mu,      x_q = (r_q + N x_v) / mu,      N s = r_q

once with the real eigenvalue mu = REAL / h, once with the complex one (PART + i TURN) / h, kept as a real matrix of
twice the size. A = da/dq N, how accelerations change where q moves along each velocity, B = da/dv. Where N changes with
q, what that gives is left out: Newton's method needs no more than that.

The coefficients are in the form that decouples the linear equations of the three stages:

C: nodes. A^-1 = T diag(REAL, [[PART, -TURN], [TURN, PART]]) TI with h-free eigenvalues REAL and PART +- i TURN.
E: the embedded error estimate of order 3. D: collocation polynomial, Z(x) = sum_k x^(k+1) sum_i D[i, k] Z_i.
WEIGHTS: rows integrate a quadratic through the nodes from 0 to each of them (the matrix A of the method).

Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8 (RADAU5); order of its parts and
decimals of T as in scipy 1.18.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import apart, inlined, internal, kernel
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import begin_run, derivative, project, rates, record_output, speeds
from mbsd.dynamics.integrators.full_matrix import differentiate, factor_full, solve_full, too_large
from mbsd.dynamics.integrators.kind import Integrator, register
from mbsd.dynamics.integrators.step_size import allowed, first_step
from mbsd.dynamics.state import record_here

ROOT6 = 6.0**0.5
C = np.array([(4.0 - ROOT6) / 10.0, (4.0 + ROOT6) / 10.0, 1.0])
E = np.array([-13.0 - 7.0 * ROOT6, -13.0 + 7.0 * ROOT6, -1.0]) / 3.0
REAL = 3.0 + 3.0 ** (2.0 / 3.0) - 3.0 ** (1.0 / 3.0)
PART = 3.0 + 0.5 * (3.0 ** (1.0 / 3.0) - 3.0 ** (2.0 / 3.0))
TURN = -0.5 * (3.0 ** (5.0 / 6.0) + 3.0 ** (7.0 / 6.0))
WEIGHTS = np.array(
    [
        [(88.0 - 7.0 * ROOT6) / 360.0, (296.0 - 169.0 * ROOT6) / 1800.0, (-2.0 + 3.0 * ROOT6) / 225.0],
        [(296.0 + 169.0 * ROOT6) / 1800.0, (88.0 + 7.0 * ROOT6) / 360.0, (-2.0 - 3.0 * ROOT6) / 225.0],
        [(16.0 - ROOT6) / 36.0, (16.0 + ROOT6) / 36.0, 1.0 / 9.0],
    ]
)
T = np.array(
    [
        [0.09443876248897524, -0.14125529502095421, 0.03002919410514742],
        [0.25021312296533332, 0.20412935229379994, -0.38294211275726192],
        [1.0, 1.0, 0.0],
    ]
)
TI = np.array(
    [
        [4.17871859155190428, 0.32768282076106237, 0.52337644549944951],
        [-4.17871859155190428, -0.32768282076106237, 0.47662355450055044],
        [0.50287263494578682, -2.57192694985560522, 0.59603920482822492],
    ]
)
D = np.array(
    [
        [13.0 / 3.0 + 7.0 * ROOT6 / 3.0, -23.0 / 3.0 - 22.0 * ROOT6 / 3.0, 10.0 / 3.0 + 5.0 * ROOT6],
        [13.0 / 3.0 - 7.0 * ROOT6 / 3.0, -23.0 / 3.0 + 22.0 * ROOT6 / 3.0, 10.0 / 3.0 - 5.0 * ROOT6],
        [1.0 / 3.0, -8.0 / 3.0, 10.0 / 3.0],
    ]
)


Z, F, W = 1, 4, 7
"""First rows of Scratch.stages that hold stage increments, derivatives at the stages, transformed increments."""
AFTER, ERROR_ROW, OTHER = 10, 11, 12
"""The state after the step, its error, and scratch."""


@internal
def factor_both(scratch, h, size):
    """Factor both matrices for a step h (s) from A and B in scratch.full."""
    value = scratch.full.value
    real = REAL / h
    part = PART / h
    turn = TURN / h
    square = part * part + turn * turn
    for i in range(size):
        for j in range(size):
            a = value[0, i, j]
            b = value[1, i, j]
            value[2, i, j] = -b - a / real
            value[3, i, j] = -b - a * part / square
            value[3, i, j + size] = -a * turn / square
            value[3, i + size, j] = a * turn / square
            value[3, i + size, j + size] = value[3, i, j]
        value[2, i, i] += real
        value[3, i, i] += part
        value[3, i + size, i + size] += part
        value[3, i, i + size] -= turn
        value[3, i + size, i] += turn
    factor_full(scratch.full, 2, size)
    factor_full(scratch.full, 3, 2 * size)


@internal
def solve_real(dyn, scratch, q, h, x):
    """Solve for x (2, n), in place, with the real eigenvalue at q (n,)."""
    way = scratch.change[0]
    turned = scratch.change[1]
    for c in range(3, x.shape[1]):
        way[c] = x[0, c]
    speeds(dyn, q, way)
    size = x.shape[1] - 3
    a = scratch.full.value[0]
    side = scratch.full.side[2]
    mu = REAL / h
    for i in range(size):
        total = 0.0
        for j in range(size):
            total += a[i, j] * way[j + 3]
        side[i] = x[1, i + 3] + total / mu
    solve_full(scratch.full, 2, size)
    for i in range(size):
        x[1, i + 3] = side[i]
    rates(dyn, q, x[1], turned)
    for i in range(size):
        x[0, i + 3] = (x[0, i + 3] + turned[i + 3]) / mu


@internal
def solve_complex(dyn, scratch, q, h, x, z):
    """Solve for x + i z (2, n each), in place, with the complex eigenvalue at q (n,)."""
    way = scratch.change[0]
    turned = scratch.change[1]
    for c in range(3, x.shape[1]):
        way[c] = x[0, c]
        turned[c] = z[0, c]
    speeds(dyn, q, way)
    speeds(dyn, q, turned)
    size = x.shape[1] - 3
    a = scratch.full.value[0]
    side = scratch.full.side[3]
    part = PART / h
    turn = TURN / h
    square = part * part + turn * turn
    for i in range(size):
        total = 0.0
        other = 0.0
        for j in range(size):
            total += a[i, j] * way[j + 3]
            other += a[i, j] * turned[j + 3]
        side[i] = x[1, i + 3] + (part * total + turn * other) / square
        side[i + size] = z[1, i + 3] + (part * other - turn * total) / square
    solve_full(scratch.full, 3, 2 * size)
    for i in range(size):
        x[1, i + 3] = side[i]
        z[1, i + 3] = side[i + size]
    rates(dyn, q, x[1], way)
    rates(dyn, q, z[1], turned)
    for i in range(size):
        total = x[0, i + 3] + way[i + 3]
        other = z[0, i + 3] + turned[i + 3]
        x[0, i + 3] = (part * total + turn * other) / square
        z[0, i + 3] = (part * other - turn * total) / square


@inlined
def norm(settings, y, after, x):
    """Return the root mean square of x (2, n) in tolerances between two states."""
    total = 0.0
    for part in range(2):
        for c in range(3, y.shape[1]):
            total += (x[part, c] / allowed(settings, y, after, part, c)) ** 2
    return math.sqrt(total / max(2 * (y.shape[1] - 3), 1))


@apart
def find_stages(dyn, scratch, state, settings, h, tolerance):
    """Improve the increments Z of the three stages until they fulfil their equations.

    Returns the passes taken, negative where they did not converge; the rate of convergence is in scratch.report[3].
    """
    k = scratch.stages
    y = state.y
    n3 = y.shape[1]
    trial = k[OTHER]
    for part in range(2):
        for c in range(3, n3):
            for i in range(3):
                total = 0.0
                for j in range(3):
                    total += TI[i, j] * k[Z + j, part, c]
                k[W + i, part, c] = total
    last = 0.0
    scratch.report[3] = 1.0
    for step in range(PASSES):
        for i in range(3):
            for part in range(2):
                for c in range(3, n3):
                    trial[part, c] = y[part, c] + k[Z + i, part, c]
            scratch.power[i] = derivative(
                dyn, scratch, state.clock[run_state.TIME] + C[i] * h, trial, k[F + i], scratch.ws.right[1]
            )
        state.count[run_state.EVALUATIONS] += 3
        for part in range(2):
            for c in range(3, n3):
                first = 0.0
                second = 0.0
                third = 0.0
                for j in range(3):
                    first += TI[0, j] * k[F + j, part, c]
                    second += TI[1, j] * k[F + j, part, c]
                    third += TI[2, j] * k[F + j, part, c]
                k[F, part, c] = first - REAL / h * k[W, part, c]
                k[F + 1, part, c] = second - (PART * k[W + 1, part, c] - TURN * k[W + 2, part, c]) / h
                k[F + 2, part, c] = third - (PART * k[W + 2, part, c] + TURN * k[W + 1, part, c]) / h
        solve_real(dyn, scratch, y[0], h, k[F])
        solve_complex(dyn, scratch, y[0], h, k[F + 1], k[F + 2])
        size = 0.0
        for i in range(3):
            size += norm(settings, y, y, k[F + i]) ** 2
        size = math.sqrt(size / 3.0)
        if not size < 1e300:
            return -(step + 1)
        rate = -1.0
        if step > 0:
            rate = size / last
            scratch.report[3] = rate
            if rate >= 1.0 or rate ** (PASSES - step) / (1.0 - rate) * size > tolerance:
                return -(step + 1)
        for part in range(2):
            for c in range(3, n3):
                for i in range(3):
                    k[W + i, part, c] += k[F + i, part, c]
                for i in range(3):
                    total = 0.0
                    for j in range(3):
                        total += T[i, j] * k[W + j, part, c]
                    k[Z + i, part, c] = total
        if size == 0.0 or (rate > 0.0 and rate / (1.0 - rate) * size < tolerance):
            return step + 1
        last = size
    return -PASSES


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
        derivative(dyn, scratch, state.clock[run_state.TIME], scratch.state, k[0], scratch.ws.right[1])
        state.count[run_state.EVALUATIONS] += 1
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
    while state.count[run_state.NEXT] < out.t.shape[0] and out.t[state.count[run_state.NEXT]] < reached:
        at = state.count[run_state.NEXT]
        x = (out.t[at] - state.clock[run_state.TIME]) / h
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
        record_output(dyn, scratch, out, at, state.clock[run_state.WORK] + work)
        state.count[run_state.EVALUATIONS] += 1
        state.count[run_state.NEXT] = at + 1


@internal
def _begin_at_zero(k):
    """Let the search for the stages begin at the state itself."""
    for i in range(3):
        for part in range(2):
            for c in range(3, k.shape[2]):
                k[Z + i, part, c] = 0.0


@internal
def _factor_of(error, h, before, error_before, passes):
    """Return the factor by which the step h (s) may grow, after ``passes`` and by this error and the one before."""
    factor = error**-0.25 if error > 0.0 else 10.0
    if before > 0.0 and error > 0.0:
        factor *= min(1.0, h / before * (error_before / error) ** 0.25)
    return factor * (0.9 * (2.0 * PASSES + 1.0) / (2.0 * PASSES + passes))


@internal
def _accept(dyn, scratch, state, out, h, reached):
    """Write the outputs within the step h (s), whose end is stages[AFTER], and stand at its end."""
    y = state.y
    _outputs(dyn, scratch, state, out, h, reached)
    for i in range(3):
        state.clock[run_state.WORK] += h * WEIGHTS[2, i] * scratch.power[i]
    for part in range(2):
        for c in range(3, y.shape[1]):
            y[part, c] = scratch.stages[AFTER, part, c]
    state.clock[run_state.POWER] = derivative(dyn, scratch, reached, y, state.dy, state.lam)
    state.clock[run_state.TIME] = reached
    state.count[run_state.EVALUATIONS] += 1
    state.count[run_state.ACCEPTED] += 1


@internal
def _begin(dyn, scratch, state, settings):
    """Find the derivative at the state, and the first step if there was none."""
    begin_run(dyn, scratch, state)
    if state.clock[run_state.STEP] == 0.0:
        state.clock[run_state.STEP] = first_step(dyn, scratch, state, settings, 0.25)


@internal
def _reach(k, y):
    """Put the end of the step, which its last stage gives, into k[AFTER]."""
    for part in range(2):
        for c in range(3, y.shape[1]):
            k[AFTER, part, c] = y[part, c] + k[Z + 2, part, c]


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` accepted steps at most, writing the outputs passed. Returns a status."""
    y = state.y
    k = scratch.stages
    n3 = y.shape[1]
    newton = max(2.3e-15 / settings.relative, min(0.03, math.sqrt(settings.relative)))
    _begin(dyn, scratch, state, settings)
    accepted = 0
    refused = False
    current = False  # A and B belong to this step
    usable = False  # A and B may be used
    factored = 0.0  # the step that the matrices were factored for
    before = 0.0  # length and error of the last accepted step
    error_before = 0.0
    while True:
        t = state.clock[run_state.TIME]
        while state.count[run_state.NEXT] < out.t.shape[0] and out.t[state.count[run_state.NEXT]] <= t:
            record_here(scratch, state, out)
        if t >= end:
            return run_state.REACHED
        if accepted == max_steps:
            return run_state.PAUSED
        h = min(state.clock[run_state.STEP], settings.longest)
        if h < SMALLEST_STEP * settings.longest and t + h < end:
            return run_state.STEP_TOO_SMALL
        last = t + h >= end
        if last:
            h = end - t
        if before > 0.0 and not refused:
            _extrapolate(scratch, h / before)
        else:
            _begin_at_zero(k)
        passes = -1
        while passes < 0:
            if not usable:
                state.count[run_state.EVALUATIONS] += differentiate(dyn, scratch, t, y, state.dy[1], k[0], k[OTHER])
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
                _begin_at_zero(k)
        error = 1e9
        if passes > 0:
            _reach(k, y)
            error = _estimate(dyn, scratch, state, settings, h, refused or before == 0.0)
            if error < 1.0:
                project(dyn, scratch, t + h, k[AFTER], 2)
                if not scratch.report[2] <= max(CONTRACTION * scratch.report[1], ROUNDING):
                    passes = -1
        factor = 0.5
        if passes > 0 and error == error:
            factor = _factor_of(error, h, before, error_before, passes)
        if passes < 0 or not error < 1.0:
            if h < SMALLEST_STEP * settings.longest:
                return run_state.NOT_FINITE
            state.clock[run_state.STEP] = h * max(0.2, min(factor, 0.9))
            state.count[run_state.REJECTED] += 1
            refused = True
            continue
        reached = end if last else t + h
        _accept(dyn, scratch, state, out, h, reached)
        accepted += 1
        usable = passes <= 2 or scratch.report[3] <= KEPT
        current = False
        factor = min(factor, 1.0 if refused else 10.0)
        if (usable and 1.0 <= factor < 1.2) or (last and factor > 1.0):
            factor = 1.0
        if not last or factor < 1.0:
            state.clock[run_state.STEP] = min(h * factor, settings.longest)
        before = h
        error_before = max(error, 1e-4)
        refused = False


RADAU = register(
    Integrator("radau", advance, STAGES, order=5, fixed_step=False, general=True, matrices=(4, 2), refusal=too_large)
)
