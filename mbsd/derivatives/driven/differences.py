"""Compiled: states beside those of a motion, and how its equations change between them."""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, kernel


@internal
def set_beside(q, v, way_q, way_v, per_size, per_speed, reach, ahead_q, behind_q, ahead_v, behind_v):
    """Fill states (3 nb,) ahead of and behind q, v along a direction; returns by how many times the direction."""
    far = 0.0
    for c in range(3, q.shape[0]):
        far = max(far, max(abs(way_q[c]), abs(way_v[c]) * per_speed) * per_size[c])
    step = reach / far if far > 0.0 else reach
    for c in range(q.shape[0]):
        ahead_q[c] = q[c] + step * way_q[c]
        behind_q[c] = q[c] - step * way_q[c]
        ahead_v[c] = v[c] + step * way_v[c]
        behind_v[c] = v[c] - step * way_v[c]
    return step


@kernel
def displace(q, v, directions_q, directions_v, some, per_size, per_speed, reach, out_q, out_v, steps):
    """Fill out_q, out_v (2, S, T, 3 nb) with states ahead of and behind q, v (T, 3 nb) along ``some`` (S,) directions.

    Directions are (D, T, 3 nb). States go as far as ``reach`` (T,), in sizes of coordinates, 1 / ``per_size`` (3 nb,),
    and of the fastest speed, 1 / ``per_speed``; steps (S, T) take by how many times the directions.
    """
    for d in range(some.shape[0]):
        own = some[d]
        for k in range(q.shape[0]):
            steps[d, k] = set_beside(
                q[k], v[k], directions_q[own, k], directions_v[own, k], per_size, per_speed, reach[k],
                out_q[0, d, k], out_q[1, d, k], out_v[0, d, k], out_v[1, d, k],
            )  # fmt: skip


@internal
def difference(row_body, half, ahead, behind, a, lam, velocity, acceleration, load):
    """Fill changes of J v - nu and J a - gamma (m,), and add that of -J^T lam to load (3 nb,).

    ``ahead`` and ``behind``: v (3 nb,), J (m, 6) and gamma (m,) of two states; ``half`` / 2 is their distance.
    """
    v, jac, gamma = ahead
    u, kac, delta = behind
    for r in range(row_body.shape[0]):
        rate = 0.0
        bend = delta[r] - gamma[r]
        push = half * lam[r]
        for side in range(2):
            at = 3 * row_body[r, side]
            if at > 0:
                for c in range(3):
                    entry = jac[r, 3 * side + c]
                    change = entry - kac[r, 3 * side + c]
                    rate += entry * v[at + c] - (entry - change) * u[at + c]
                    bend += change * a[at + c]
                    load[at + c] -= change * push
        velocity[r] = half * rate
        acceleration[r] = half * bend


@internal
def difference_of_speeds(row_body, half, v, jac, kac, velocity):
    """Fill the change of J v - nu (m,) between J ahead and behind, at one velocity v (3 nb,)."""
    for r in range(row_body.shape[0]):
        rate = 0.0
        for side in range(2):
            at = 3 * row_body[r, side]
            if at > 0:
                for c in range(3):
                    rate += (jac[r, 3 * side + c] - kac[r, 3 * side + c]) * v[at + c]
        velocity[r] = half * rate


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
            other = behind + s
            difference(
                row_body, half, (v[s], compact[s], gamma[s]), (v[other], compact[other], gamma[other]), a[k], lam[k],
                velocity[own, k], acceleration[own, k], load[own, k],
            )  # fmt: skip


@internal
def factor_mass(free, inertia, mass):
    """Fill mass (f, f), lower, with the Cholesky factor of Z^T M Z, Z the columns free (n, f)."""
    for i in range(free.shape[1]):
        for j in range(i + 1):
            value = 0.0
            for c in range(free.shape[0]):
                value += free[c, i] * inertia[c] * free[c, j]
            for g in range(j):
                value -= mass[i, g] * mass[j, g]
            mass[i, j] = math.sqrt(value) if i == j else value / mass[j, j]


@internal
def couple(fixed, free, inertia, out):
    """Fill out (f, r) with Z^T M of the columns fixed (n, r): what J asks for pushes along the basis."""
    for i in range(free.shape[1]):
        for r in range(fixed.shape[1]):
            value = 0.0
            for c in range(free.shape[0]):
                value += free[c, i] * inertia[c] * fixed[c, r]
            out[i, r] = value


@internal
def accelerate(free, coupled, rows, bend, load, mass):
    """Fill the last row of ``mass`` with Z a of M a + J^T lam = load (3 + n,), J a = -bend (m,).

    The other rows are of factor_mass; ``coupled`` (f, r) is of couple.
    """
    count = free.shape[1]
    for i in range(count):
        value = 0.0
        for c in range(free.shape[0]):
            value += free[c, i] * load[3 + c]
        for r in range(rows.shape[0]):
            value += coupled[i, r] * bend[rows[r]]
        for g in range(i):
            value -= mass[i, g] * mass[count, g]
        mass[count, i] = value / mass[i, i]
    for i in range(count - 1, -1, -1):
        for g in range(i + 1, count):
            mass[count, i] -= mass[g, i] * mass[count, g]
        mass[count, i] /= mass[i, i]


@internal
def spread_out(fixed, free, rows, bend, mass, a):
    """Fill a (n,), where ``accelerate`` has left Z a."""
    for c in range(free.shape[0]):
        value = 0.0
        for r in range(rows.shape[0]):
            value -= fixed[c, r] * bend[rows[r]]
        for i in range(free.shape[1]):
            value += free[c, i] * mass[free.shape[1], i]
        a[c] = value


@internal
def push_back(fixed, inertia, rows, load, a, lam):
    """Add to lam (m,) the multipliers of M a + J^T lam = load (3 + n,)."""
    for c in range(fixed.shape[0]):
        push = load[3 + c] - inertia[c] * a[c]
        for r in range(rows.shape[0]):
            lam[rows[r]] += fixed[c, r] * push


@internal
def close_state(fixed, rows, open_, out):
    """Fill out (3 + n,) with x of J x = -open_ (m,), J in ``rows``, with none of the basis."""
    for c in range(fixed.shape[0]):
        value = 0.0
        for r in range(rows.shape[0]):
            value -= fixed[c, r] * open_[rows[r]]
        out[3 + c] = value


@kernel
def close(fixed, rows, some, open_, out):
    """Fill ``some`` of out (D, T, 3 + n) with x of J x = -open_ (D, T, m), J in ``rows``, with none of the basis."""
    for i in range(some.shape[0]):
        for k in range(fixed.shape[0]):
            close_state(fixed[k], rows, open_[some[i], k], out[some[i], k])


@kernel
def accelerate_along(fixed, free, inertia, rows, bend, load, mass, coupled, a, lam):
    """Fill a (D, T, n) and lam (D, T, m) of M a + J^T lam = load (D, T, 3 + n), J a = -bend (D, T, m), J in ``rows``.

    fixed (T, n, r) and free (T, n, f) are the columns of the inverse of J and a basis; mass (f + 1, f) and coupled
    (f, r) are scratch.
    """
    for k in range(fixed.shape[0]):
        factor_mass(free[k], inertia, mass)
        couple(fixed[k], free[k], inertia, coupled)
        for d in range(bend.shape[0]):
            accelerate(free[k], coupled, rows, bend[d, k], load[d, k], mass)
            spread_out(fixed[k], free[k], rows, bend[d, k], mass, a[d, k])
            push_back(fixed[k], inertia, rows, load[d, k], a[d, k], lam[d, k])


@kernel
def combine(y, parts, out):
    """Fill out (P, R, n) with parts (2 f + P, R, n): those of P, and y (R, 2 f, P) others."""
    first = y.shape[1]
    for k in range(out.shape[1]):
        for p in range(out.shape[0]):
            for c in range(out.shape[2]):
                out[p, k, c] = parts[first + p, k, c]
            for j in range(first):
                weight = y[k, j, p]
                for c in range(out.shape[2]):
                    out[p, k, c] += weight * parts[j, k, c]
