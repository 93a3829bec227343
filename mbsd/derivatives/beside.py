"""Compiled: states beside those of a motion, and how its equations change from one side of it to the other."""

from __future__ import annotations

import math

from mbsd.compiling.jit import kernel


@kernel
def displace(q, v, directions_q, directions_v, some, scale, fastest, reach, out_q, out_v, steps):
    """Fill out_q, out_v (2, S, T, 3 nb) with states ahead of and behind q, v (T, 3 nb) along ``some`` (S,) directions.

    Directions are (D, T, 3 nb). States go as far as ``reach``, in parts of ``scale`` (3 nb,) and of the speed
    ``fastest``; steps (S, T) take by how many times the directions.
    """
    for d in range(some.shape[0]):
        own = some[d]
        for k in range(q.shape[0]):
            far = 0.0
            for c in range(3, q.shape[1]):
                far = max(far, abs(directions_q[own, k, c]) / scale[c])
                far = max(far, abs(directions_v[own, k, c]) / scale[c] / fastest)
            step = reach / far if far > 0.0 else reach
            steps[d, k] = step
            for c in range(q.shape[1]):
                out_q[0, d, k, c] = q[k, c] + step * directions_q[own, k, c]
                out_q[1, d, k, c] = q[k, c] - step * directions_q[own, k, c]
                out_v[0, d, k, c] = v[k, c] + step * directions_v[own, k, c]
                out_v[1, d, k, c] = v[k, c] - step * directions_v[own, k, c]


@kernel
def differ(row_body, steps, some, v, a, lam, compact, gamma, force, velocity, acceleration, load):
    """Fill ``some`` of velocity, acceleration (D, T, m), load (D, T, 3 nb): of J v - nu, J a - gamma, Q - J^T lam.

    v, gamma, force and compact J are of the states of ``displace``, one after the other; a and lam (T, ...) are held.
    """
    times = a.shape[0]
    behind = steps.shape[0] * times
    for d in range(steps.shape[0]):
        own = some[d]
        for k in range(times):
            s = d * times + k
            half = 0.5 / steps[d, k]
            for c in range(load.shape[2]):
                load[own, k, c] = half * (force[s, c] - force[behind + s, c])
            for r in range(row_body.shape[0]):
                rate = 0.0
                bend = gamma[behind + s, r] - gamma[s, r]
                push = half * lam[k, r]
                for side in range(2):
                    at = 3 * row_body[r, side]
                    if at > 0:
                        for c in range(3):
                            entry = compact[s, r, 3 * side + c]
                            change = entry - compact[behind + s, r, 3 * side + c]
                            rate += entry * v[s, at + c] - (entry - change) * v[behind + s, at + c]
                            bend += change * a[k, at + c]
                            load[own, k, at + c] -= change * push
                velocity[own, k, r] = half * rate
                acceleration[own, k, r] = half * bend


@kernel
def accelerate_along(fixed, free, inertia, rows, bend, load, mass, a, lam):
    """Fill a (D, T, n) and lam (D, T, m) of M a + J^T lam = load (D, T, 3 + n), J a = -bend (D, T, m), J in ``rows``.

    fixed (T, n, r) and free (T, n, f) are the columns of the inverse of J and a basis; mass (f, f) is scratch.
    """
    count = free.shape[2]
    width = fixed.shape[1]
    for k in range(fixed.shape[0]):
        for i in range(count):
            for j in range(i + 1):
                value = 0.0
                for c in range(width):
                    value += free[k, c, i] * inertia[c] * free[k, c, j]
                for g in range(j):
                    value -= mass[i, g] * mass[j, g]
                mass[i, j] = math.sqrt(value) if i == j else value / mass[j, j]
        for d in range(bend.shape[0]):
            for i in range(count):
                mass[count, i] = 0.0
            for c in range(width):
                value = 0.0
                for r in range(rows.shape[0]):
                    value -= fixed[k, c, r] * bend[d, k, rows[r]]
                a[d, k, c] = value
                push = load[d, k, 3 + c] - inertia[c] * value
                for i in range(count):
                    mass[count, i] += free[k, c, i] * push
            for i in range(count):
                for g in range(i):
                    mass[count, i] -= mass[i, g] * mass[count, g]
                mass[count, i] /= mass[i, i]
            for i in range(count - 1, -1, -1):
                for g in range(i + 1, count):
                    mass[count, i] -= mass[g, i] * mass[count, g]
                mass[count, i] /= mass[i, i]
            for c in range(width):
                for i in range(count):
                    a[d, k, c] += free[k, c, i] * mass[count, i]
                push = load[d, k, 3 + c] - inertia[c] * a[d, k, c]
                for r in range(rows.shape[0]):
                    lam[d, k, rows[r]] += fixed[k, c, r] * push


@kernel
def close(fixed, rows, some, open_, out):
    """Fill ``some`` of out (D, T, 3 + n) with x of J x = -open_ (D, T, m), J in ``rows``, with none of the basis."""
    for i in range(some.shape[0]):
        d = some[i]
        for k in range(fixed.shape[0]):
            for c in range(fixed.shape[1]):
                value = 0.0
                for r in range(rows.shape[0]):
                    value -= fixed[k, c, r] * open_[d, k, rows[r]]
                out[d, k, 3 + c] = value


@kernel
def combine(y, at, parts, out):
    """Fill out (P, R, n) with parts (2 f + P, T, n) at nodes ``at`` (R,): those of P, and y (T, 2 f, P) others."""
    first = y.shape[1]
    for i in range(at.shape[0]):
        k = at[i]
        for p in range(out.shape[0]):
            for c in range(out.shape[2]):
                out[p, i, c] = parts[first + p, k, c]
            for j in range(first):
                weight = y[k, j, p]
                for c in range(out.shape[2]):
                    out[p, i, c] += weight * parts[j, k, c]
