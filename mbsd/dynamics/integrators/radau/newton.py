"""Newton's method for the three stages of Radau IIA: linear equations decoupled, and halved by q' = N(q) v.

    y' = f(t, y),  y = (q, v),  f = (N v, a):     (mu 1 - f_y) x = r   is
    (mu 1 - B - A / mu) x_v = r_v + A s / mu,      x_q = (r_q + N x_v) / mu,      N s = r_q

once with the real eigenvalue mu = REAL / h, once with the complex one (PART + i TURN) / h, kept as a real matrix of
twice the size. A = da/dq N, how accelerations change where q moves along each velocity, B = da/dv. Where N changes with
q, what that gives is left out: Newton's method needs no more than that.

Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, inlined, internal
from mbsd.dynamics.formulation import derivative, rates, speeds
from mbsd.dynamics.integrators.full_matrix import factor_full, solve_full
from mbsd.dynamics.integrators.radau.tableau import PART, REAL, TI, TURN, C, T
from mbsd.dynamics.integrators.step_size import allowed
from mbsd.dynamics.state import EVALUATIONS, TIME

Z, F, W = 1, 4, 7
"""First rows of Scratch.stages that hold stage increments, derivatives at the stages, transformed increments."""
AFTER, ERROR_ROW, OTHER = 10, 11, 12
"""The state after the step, its error, and scratch."""
PASSES = 6


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
                dyn, scratch, state.clock[TIME] + C[i] * h, trial, k[F + i], scratch.ws.right[1]
            )
        state.count[EVALUATIONS] += 3
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
