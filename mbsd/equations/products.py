"""Compiled: products with the Jacobians of a motion, and the reactions that they make of multipliers.

Numbers are added in one order: body by body, row by row.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel


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
