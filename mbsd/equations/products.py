"""Compiled products with Jacobians: reactions from multipliers, residuals of the equations of motion.

Numbers are added in one order: body by body, row by row. Small dense systems are solved by Gaussian elimination with
row pivoting.
"""

from __future__ import annotations

from mbsd.compiling.jit import internal, kernel


@kernel
def spread_rows(row_body, compact, out):
    """Fill out (T, m, 3 nb), zero before, with compact J (T, m, 6) as matrices; ground comes first."""
    for k in range(compact.shape[0]):
        for r in range(row_body.shape[0]):
            for side in range(2):
                at = 3 * row_body[r, side]
                for c in range(3):
                    out[k, r, at + c] = compact[k, r, 3 * side + c]


@kernel
def times_rows(row_body, grounded, compact, x, out):
    """Fill out (T, m) with J x, for compact J (T, m, 6) and x (T, 3 nb), whose entries of ground are zero.

    ``grounded``: whether the first body of every row is ground.
    """
    for k in range(compact.shape[0]):
        for r in range(row_body.shape[0]):
            row = compact[k, r]
            at = 3 * row_body[r, 1]
            total = row[3] * x[k, at] + row[4] * x[k, at + 1] + row[5] * x[k, at + 2]
            if not grounded:
                at = 3 * row_body[r, 0]
                total = row[0] * x[k, at] + row[1] * x[k, at + 1] + row[2] * x[k, at + 2] + total
            out[k, r] = total


@kernel
def times_columns(row_body, compact, lam, out):
    """Add J^T lam to out (T, 3 nb), for compact J (T, m, 6) and lam (T, m)."""
    for k in range(compact.shape[0]):
        for side in range(2):
            for r in range(row_body.shape[0]):
                at = 3 * row_body[r, side]
                for c in range(3):
                    out[k, at + c] += compact[k, r, 3 * side + c] * lam[k, r]


@kernel
def tabulate_wrenches(joints, first_row, markers, marker_body, marker_arm, place, turn, compact, q, lam, out):
    """Fill out (T, k, 3) with forces of ``joints`` (k,) on second bodies, at the second marker (N, N m).

    compact (T, n, 6) and lam (T, n) hold the rows of these joints alone, one joint after the other. ``turn`` (2, T, b):
    cosine and sine of the angles of bodies, that of body ``place`` (nb,); ground needs none.
    """
    for k in range(out.shape[0]):
        row = 0
        for number in range(joints.shape[0]):
            joint = joints[number]
            j = markers[joint, 1]
            carrier = marker_body[j]
            body = carrier if carrier > 0 else marker_body[markers[joint, 0]]
            side = 3 if carrier > 0 else 0
            fx = 0.0
            fy = 0.0
            torque = 0.0
            for _ in range(first_row[joint], first_row[joint + 1]):
                fx += compact[k, row, side] * lam[k, row]
                fy += compact[k, row, side + 1] * lam[k, row]
                torque += compact[k, row, side + 2] * lam[k, row]
                row += 1
            sign = -1.0 if carrier > 0 else 1.0
            fx *= sign
            fy *= sign
            torque *= sign
            c = 1.0
            s = 0.0
            if carrier > 0:
                c = turn[0, k, place[carrier]]
                s = turn[1, k, place[carrier]]
            x = marker_arm[j, 0]
            y = marker_arm[j, 1]
            arm_x = q[k, 3 * carrier] + (c * x - s * y) - q[k, 3 * body]
            arm_y = q[k, 3 * carrier + 1] + (s * x + c * y) - q[k, 3 * body + 1]
            out[k, number, 0] = fx
            out[k, number, 1] = fy
            out[k, number, 2] = torque - (arm_x * fy - arm_y * fx)


@kernel
def leave(row_body, first, inertia, weight, drives, compact, v, a, lam, velocity, acceleration, load):
    """Fill velocity (S, m) with J v - nu, change gamma to J a - gamma, and finish load (S, 3 nb).

    gamma is in ``acceleration``.

    ``load`` has the forces: m g - M a - J^T lam are added. drives, a and lam are (T, ...), and S states v (S, 3 nb)
    with compact J (S, m, 6) are T of one kind after the other. ``first`` is the row of the first driver.
    """
    times = a.shape[0]
    for s in range(v.shape[0]):
        k = s % times
        for c in range(load.shape[1]):
            load[s, c] += weight[c] - inertia[c] * a[k, c]
        for r in range(row_body.shape[0]):
            rate = 0.0
            bend = 0.0
            push = lam[k, r]
            for side in range(2):
                at = 3 * row_body[r, side]
                for c in range(3):
                    entry = compact[s, r, 3 * side + c]
                    if at > 0:
                        rate += entry * v[s, at + c]
                        bend += entry * a[k, at + c]
                    load[s, at + c] -= entry * push
            velocity[s, r] = rate
            acceleration[s, r] = bend - acceleration[s, r]
        for d in range(1, drives.shape[1]):
            velocity[s, first + d - 1] -= drives[k, d, 1]


@internal
def eliminate(matrix, side):
    """Replace side (n, c) by the solution of matrix (n, n), which is overwritten."""
    size = matrix.shape[0]
    count = side.shape[1]
    for k in range(size):
        best = k
        for i in range(k + 1, size):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            for c in range(k, size):
                matrix[k, c], matrix[best, c] = matrix[best, c], matrix[k, c]
            for c in range(count):
                side[k, c], side[best, c] = side[best, c], side[k, c]
        for i in range(k + 1, size):
            part = matrix[i, k] / matrix[k, k]
            if part != 0.0:
                for c in range(k + 1, size):
                    matrix[i, c] -= part * matrix[k, c]
                for c in range(count):
                    side[i, c] -= part * side[k, c]
    for k in range(size - 1, -1, -1):
        for i in range(k + 1, size):
            part = matrix[k, i]
            for c in range(count):
                side[k, c] -= part * side[i, c]
        for c in range(count):
            side[k, c] /= matrix[k, k]
