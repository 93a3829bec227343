"""Friction of joints from their reactions, of which the law is in model/forces/friction.py.

    F = -mu(s) tanh(s / s_0) (N + N_0) h - c x',    s = h x'    h: radius of a pin (m), 1 of a guide
    N = max(|R|, 2 |M| / L)                         R, M: reaction of the joint at its place

N comes from the multipliers, which F changes: r = N(lam(x)) - x = 0 is found as in the plane,

    x += w r,   w <- -w r_old . (r - r_old) / |r - r_old|^2,   w = 1 at first

Source: Irons, Tuck 1969, Int. J. Num. Meth. Eng. 1.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.kinematics.elimination import solve_transposed
from mbsd.spatial.equations.forces import along_row, push_row

ROW, FIRST, END, COLUMN, BODY, PLACE = range(6)
"""Columns of System.friction: the row that pushes, rows of its joint, column and number of its second body, a place."""
COEFFICIENT, STATIC, STRIBECK, VISCOUS, SLIP_SPEED, PRELOAD, LEVER, LENGTH = range(8)
"""Columns of System.friction_number."""
USED, LAST, FOUND, PUSH, RATE = range(5)
"""Rows of Workspace.friction: normal forces used now, their last error, those of the multipliers, friction, rates."""
MOST_PASSES = 100
SETTLED = 1e-12
"""Part of the largest normal force that may be left."""


@internal
def find_normals(system, ws, lam, turned):
    """Fill the normal forces that multipliers lam (m,) give; ``turned``: torques of J are in body axes."""
    for n in range(system.friction.shape[0]):
        c = system.friction[n, COLUMN]
        f0 = f1 = f2 = t0 = t1 = t2 = 0.0
        for r in range(system.friction[n, FIRST], system.friction[n, END]):
            row = ws.jac[r]
            f0 -= lam[r] * row[c]
            f1 -= lam[r] * row[c + 1]
            f2 -= lam[r] * row[c + 2]
            t0 -= lam[r] * row[c + 3]
            t1 -= lam[r] * row[c + 4]
            t2 -= lam[r] * row[c + 5]
        if turned:
            m = ws.rotation[system.friction[n, BODY]]
            x, y, z = t0, t1, t2
            t0 = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z
            t1 = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z
            t2 = m[2, 0] * x + m[2, 1] * y + m[2, 2] * z
        s = ws.arm[system.friction[n, PLACE]]
        t0 -= s[1] * f2 - s[2] * f1
        t1 -= s[2] * f0 - s[0] * f2
        t2 -= s[0] * f1 - s[1] * f0
        normal = math.sqrt(f0 * f0 + f1 * f1 + f2 * f2)
        if system.friction_number[n, LENGTH] > 0.0:
            normal = max(normal, 2.0 * math.sqrt(t0 * t0 + t1 * t1 + t2 * t2) / system.friction_number[n, LENGTH])
        ws.friction[FOUND, n] = normal


@internal
def _friction(number, normal, rate):
    """Return the friction at a rate under a normal force."""
    slip = number[LEVER] * rate
    over = slip / number[STRIBECK]
    coefficient = number[COEFFICIENT] + (number[STATIC] - number[COEFFICIENT]) * math.exp(-over * over)
    sense = math.tanh(slip / number[SLIP_SPEED])
    return -coefficient * sense * (normal + number[PRELOAD]) * number[LEVER] - number[VISCOUS] * rate


@internal
def add_change(system, ws, load):
    """Add to load what friction under the normal forces used now is more than it was."""
    for n in range(system.friction.shape[0]):
        push = _friction(system.friction_number[n], ws.friction[USED, n], ws.friction[RATE, n])
        push_row(system, ws, system.friction[n, ROW], push - ws.friction[PUSH, n], load)
        ws.friction[PUSH, n] = push


@internal
def begin_friction(system, ws, v):
    """Fill the rates of joints with friction at velocities v (3 + 6 n,), in the axes of J, while none acts yet."""
    for n in range(system.friction.shape[0]):
        ws.friction[RATE, n] = along_row(system, ws, system.friction[n, ROW], v)
        ws.friction[PUSH, n] = 0.0
        if not ws.friction[USED, n] < 1e100:
            ws.friction[USED, n] = 0.0


@internal
def correct_normals(ws, step, weight):
    """Correct the normal forces used; returns the next weight, 0 where they agree or are no numbers."""
    largest = worst = product = square = 0.0
    for n in range(ws.friction.shape[1]):
        gap = ws.friction[FOUND, n] - ws.friction[USED, n]
        if not math.isfinite(gap):
            return 0.0
        largest = max(largest, ws.friction[FOUND, n])
        worst = max(worst, abs(gap))
        product += ws.friction[LAST, n] * (gap - ws.friction[LAST, n])
        square += (gap - ws.friction[LAST, n]) ** 2
    if worst <= SETTLED * largest:
        return 0.0
    if step > 0 and square > 0.0:
        weight *= -product / square
    for n in range(ws.friction.shape[1]):
        ws.friction[LAST, n] = ws.friction[FOUND, n] - ws.friction[USED, n]
        ws.friction[USED, n] += weight * ws.friction[LAST, n]
    return weight


@internal
def end_friction(system, ws, lam):
    """Put friction into the multipliers of its rows; returns its power (W)."""
    power = 0.0
    for n in range(system.friction.shape[0]):
        lam[system.friction[n, ROW]] = -ws.friction[PUSH, n]
        power += ws.friction[PUSH, n] * ws.friction[RATE, n]
    return power


@lazy(float)
def add_swept_friction(system, seq, fac, ws, v, load, lam):
    """Add friction to load and lam (m,) of a driven motion, whose multipliers are lam; returns its power (W)."""
    begin_friction(system, ws, v)
    weight = 1.0
    for step in range(MOST_PASSES):
        add_change(system, ws, load)
        solve_transposed(seq, fac, load, lam)
        find_normals(system, ws, lam, False)
        weight = correct_normals(ws, step, weight)
        if weight == 0.0:
            return end_friction(system, ws, lam)
    lam[0] = math.nan
    return math.nan
