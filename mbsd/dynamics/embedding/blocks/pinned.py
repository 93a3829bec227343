"""A block of one pinned body in independent coordinates, whose angle is the only unknown: as a cam's lever.

    F(theta, z) = f;   F_theta omega_j = f'_j - J v_j,   F_theta alpha = gamma + f'' - J a

v_j, a: of the body's pin and the other body, with the angle held. Otherwise as in block.py.
"""

from __future__ import annotations

import math

from mbsd.dynamics.embedding.blocks.prediction import expected, expected_since
from mbsd.kinematics.groups.blocks import BODY, BODY_I, BODY_J, MOTION, PARENT
from mbsd.kinematics.groups.carrying.columns import SPEED
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.rows import bend_of, evaluate_row
from mbsd.kinematics.newton import MAX_ITERATIONS, ROUNDING, SHRINKS, SUSPICIOUS, TOLERANCE


@fused
def place_pinned(block, motion, work, past, coordinate, drive, step, now):
    """Turn the body; ``work`` takes F with its derivatives and its row. Returns F_theta, or 0 where it is doubted.

    ``step``: how far the bodies beside went since the last accepted pose.
    """
    tree = block.tree[0]
    row = block.rows[0]
    frame = block.frame[0]
    arm = block.arms[0]
    q = motion.q
    turn = motion.turn
    jac = work.jac[0]
    out = work.out[0]
    body = tree[BODY]
    b = 3 * body
    parent = tree[PARENT]
    px = q[3 * parent] + turn[parent, 0] * frame[0] - turn[parent, 1] * frame[1]
    py = q[3 * parent + 1] + turn[parent, 1] * frame[0] + turn[parent, 0] * frame[1]
    own = 3 if row[BODY_J] == body else 0
    wanted = drive[row[MOTION], 0]
    for attempt in range(2):
        theta = past.q[b + 2]
        if past.determinant != 0.0:
            theta = (
                expected(past.here[0], past.seen, coordinate, now - past.seen[coordinate.shape[0] - 1])
                if attempt == 0
                else expected_since(past.kept[0], coordinate)
            )
        slope = 0.0
        change = math.inf
        previous = math.inf
        for iteration in range(MAX_ITERATIONS):
            turn[body, 0] = math.cos(theta)
            turn[body, 1] = math.sin(theta)
            sx = turn[body, 0] * frame[5] - turn[body, 1] * frame[6]
            sy = turn[body, 1] * frame[5] + turn[body, 0] * frame[6]
            q[b] = px - sx
            q[b + 1] = py - sy
            q[b + 2] = theta
            value = evaluate_row(row, arm, q, turn, block.numbers, work.matrix, out, jac)
            slope = jac[own] * sy - jac[own + 1] * sx + jac[own + 2]
            if slope == 0.0:
                break
            correction = (wanted - value) / slope
            theta += correction
            change = abs(correction)
            if change <= TOLERANCE:
                break
            if iteration > 0 and not change < 0.5 * previous:
                break
            previous = change
        if change <= ROUNDING:
            cosine = turn[body, 0]
            turn[body, 0] -= turn[body, 1] * correction  # a correction of 1e-9 is exact this way
            turn[body, 1] += cosine * correction
            q[b + 2] = theta
            if past.determinant == 0.0:
                return slope
            way = max(step, abs(theta - past.q[b + 2]))
            missed = abs(theta - expected_since(past.kept[0], coordinate))
            if slope / past.determinant > SHRINKS and missed <= SUSPICIOUS * way + 1e-9:
                return slope
        if past.determinant == 0.0:
            break
    return 0.0


@fused
def move_pinned(block, motion, work, slope, here, rate, coordinate, drive):
    """Columns of B and convective accelerations of the body that ``place_pinned`` has turned."""
    tree = block.tree[0]
    row = block.rows[0]
    frame = block.frame[0]
    arm = block.arms[0]
    q = motion.q
    turn = motion.turn
    jac = work.jac[0]
    out = work.out[0]
    v = motion.v
    a = motion.a
    columns = coordinate.shape[0] - 1
    own_body = tree[BODY]
    parent = tree[PARENT]
    b = 3 * own_body
    own = 3 if row[BODY_J] == own_body else 0
    other = row[BODY_I] if own == 3 else row[BODY_J]
    law = row[MOTION]
    px = turn[parent, 0] * frame[0] - turn[parent, 1] * frame[1]
    py = turn[parent, 1] * frame[0] + turn[parent, 0] * frame[1]
    sx = turn[own_body, 0] * frame[5] - turn[own_body, 1] * frame[6]
    sy = turn[own_body, 1] * frame[5] + turn[own_body, 0] * frame[6]
    q[b] = q[3 * parent] + px - sx
    q[b + 1] = q[3 * parent + 1] + py - sy
    turning = 0.0
    for c in range(3):
        v[b + c] = 0.0
        v[3 * other + c] = 0.0
    for j in range(columns):
        at = 3 * j
        omega = rate[parent, at + 2]
        vx = rate[parent, at] - omega * py
        vy = rate[parent, at + 1] + omega * px
        held = jac[own] * vx + jac[own + 1] * vy
        for c in range(3):
            held += jac[3 - own + c] * rate[other, at + c]
        imposed = drive[law, 1] if law > 0 and j == columns - 1 else 0.0
        omega = (imposed - held) / slope
        here[2 + j] = omega
        rate[own_body, at] = vx + omega * sy
        rate[own_body, at + 1] = vy - omega * sx
        rate[own_body, at + 2] = omega
        speed = coordinate[j, SPEED]
        for c in range(3):
            v[b + c] += rate[own_body, at + c] * speed
            v[3 * other + c] += rate[other, at + c] * speed
        turning += rate[parent, at + 2] * speed
    at = 3 * columns
    omega = rate[parent, at + 2]
    square = turning * turning
    ax = rate[parent, at] - omega * py - square * px
    ay = rate[parent, at + 1] + omega * px - square * py
    square = v[b + 2] * v[b + 2]
    ax += square * sx
    ay += square * sy
    held = jac[own] * ax + jac[own + 1] * ay
    for c in range(3):
        held += jac[3 - own + c] * rate[other, at + c]
    alpha = (bend_of(row, arm, q, v, turn, out) + drive[law, 2] - held) / slope
    here[0] = q[b + 2]
    here[1] = alpha
    a[b] = ax + alpha * sy
    a[b + 1] = ay - alpha * sx
    a[b + 2] = alpha
    for c in range(3):
        rate[own_body, at + c] = a[b + c]
