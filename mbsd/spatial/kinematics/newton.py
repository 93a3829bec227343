"""Positions, velocities, accelerations and multipliers along a driven motion, in one loop.

The loop is that of planar driven motions (mbsd/kinematics/newton.py), with its predictor, its tests and its guard:

    predict   q from the quintic through the last two (q, q', q''), Euler parameters as any other coordinate
    correct   J d = -Phi;  r += d_r,  e := (1, d_w / 2) e, normalised, until |d| is below the tolerance
    then      J v = nu,  J a = gamma,  J^T lam = Q - M a  with the factors of the last Newton step

Turns are counted from a guess: the last angle and what its rate adds. A step is refused where the planar one is.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import inlined, internal, kernel
from mbsd.kinematics.elimination import factorise, solve, solve_transposed
from mbsd.kinematics.newton import (
    BRANCH_DOUBT,
    DONE,
    MAX_ITERATIONS,
    NO_CONTRACTION,
    ROUNDING,
    SINGULAR,
    UNEXPLAINED,
    has_settled,
    heads_for_zero,
    is_suspicious,
    jumps,
    quintic_factors,
    quintic_value,
)
from mbsd.spatial.equations.evaluation import (
    evaluate_gamma,
    evaluate_nu,
    evaluate_position,
    find_loads,
    find_wrenches,
)
from mbsd.spatial.equations.forces import apply_forces
from mbsd.spatial.equations.friction import add_swept_friction

NARROW = 4
"""Status of a step at which rows of redundant joints come near to depend on each other."""


class DrivenMotion(NamedTuple):
    """A motion of which one row after the other is solved."""

    times: Any
    """(T,) s"""
    drives: Any
    """(T, drivers + 1, 3) laws with two derivatives."""
    stride: Any
    """(drivers + 1,) how far each law may go in a step."""
    q: Any
    """(T, 3 + 7 n) coordinates, and so are dq and ddq, their derivatives."""
    dq: Any
    ddq: Any
    v: Any
    """(T, 3 + 6 n) velocities, and so are a, accelerations."""
    a: Any
    turn: Any
    """(T, turns) counted angles (rad), and so is their rate."""
    turn_rate: Any
    residual: Any
    """(T,) largest |Phi|."""
    margin: Any
    """(T,) smallest over largest pivot of the dense block."""
    determinant: Any
    """(T, d) of each block of J."""
    lam: Any
    """(T, m) multipliers; (0, m) where they are found elsewhere, as those of redundant joints are."""
    wrench: Any
    """(T, joints, 6)"""


@inlined
def extent(delta, per_metre):
    """Return the largest part of a change (3 + 6 n,) in sizes and rad; NaN counts as infinite."""
    largest = 0.0
    for d in range(3, delta.shape[0], 6):
        way = max(abs(delta[d]), abs(delta[d + 1]), abs(delta[d + 2])) * per_metre
        turn = max(abs(delta[d + 3]), abs(delta[d + 4]), abs(delta[d + 5]))
        total = delta[d] + delta[d + 1] + delta[d + 2] + delta[d + 3] + delta[d + 4] + delta[d + 5]
        largest = max(largest, way, turn) if total == total else np.inf
    return largest


@inlined
def move(q, delta):
    """Move q (3 + 7 n,) by delta (3 + 6 n,): places, and small rotations in the world."""
    for b in range(1, (delta.shape[0] + 3) // 6):
        c = 7 * b - 4
        d = 6 * b - 3
        for k in range(3):
            q[c + k] += delta[d + k]
        e0 = q[c + 3]
        e1 = q[c + 4]
        e2 = q[c + 5]
        e3 = q[c + 6]
        x = 0.5 * delta[d + 3]
        y = 0.5 * delta[d + 4]
        z = 0.5 * delta[d + 5]
        f0 = e0 - x * e1 - y * e2 - z * e3
        f1 = e1 + x * e0 + y * e3 - z * e2
        f2 = e2 + y * e0 + z * e1 - x * e3
        f3 = e3 + z * e0 + x * e2 - y * e1
        n = 1.0 / math.sqrt(f0 * f0 + f1 * f1 + f2 * f2 + f3 * f3)
        q[c + 3] = f0 * n
        q[c + 4] = f1 * n
        q[c + 5] = f2 * n
        q[c + 6] = f3 * n


@inlined
def rates(q, v, dq):
    """Fill dq (3 + 7 n,) with q' at velocities v (3 + 6 n,): e' = (0, w) e / 2."""
    for b in range(1, (v.shape[0] + 3) // 6):
        c = 7 * b - 4
        d = 6 * b - 3
        for k in range(3):
            dq[c + k] = v[d + k]
        _turn(q, c + 3, v[d + 3], v[d + 4], v[d + 5], dq)


@inlined
def _turn(e, c, x, y, z, out):
    """Fill out[c : c + 4] with (0, w) e / 2 of e[c : c + 4] and w = (x, y, z)."""
    out[c] = -0.5 * (x * e[c + 1] + y * e[c + 2] + z * e[c + 3])
    out[c + 1] = 0.5 * (x * e[c] + y * e[c + 3] - z * e[c + 2])
    out[c + 2] = 0.5 * (y * e[c] + z * e[c + 1] - x * e[c + 3])
    out[c + 3] = 0.5 * (z * e[c] + x * e[c + 2] - y * e[c + 1])


@inlined
def bends(q, v, a, ddq):
    """Fill ddq (3 + 7 n,) with q'': e'' = (0, w') e / 2 - |w|^2 e / 4."""
    for b in range(1, (v.shape[0] + 3) // 6):
        c = 7 * b - 4
        d = 6 * b - 3
        for k in range(3):
            ddq[c + k] = a[d + k]
        _turn(q, c + 3, a[d + 3], a[d + 4], a[d + 5], ddq)
        square = 0.25 * (v[d + 3] * v[d + 3] + v[d + 4] * v[d + 4] + v[d + 5] * v[d + 5])
        for k in range(3, 7):
            ddq[c + k] -= square * q[c + k]


@inlined
def _unexplained(q, dq, ddq, k, h, per_metre):
    """Return the largest part of step k that its end rates leave unexplained, in sizes and rad."""
    largest = 0.0
    half = 0.5 * h
    twelfth = h * h / 12.0
    now, before, rate, rate_before, bend, bend_before = q[k], q[k - 1], dq[k], dq[k - 1], ddq[k], ddq[k - 1]
    for b in range(3, q.shape[1], 7):
        for c in range(b, b + 7):
            gap = now[c] - before[c] - half * (rate[c] + rate_before[c]) + twelfth * (bend[c] - bend_before[c])
            gap = abs(gap) * (per_metre if c < b + 3 else 2.0)
            if not gap <= largest:
                largest = gap if gap == gap else np.inf
    return largest


@inlined
def _way(q, k, per_metre):
    """Return how far step k leads, in sizes and rad."""
    largest = 0.0
    now, before = q[k], q[k - 1]
    for b in range(3, q.shape[1], 7):
        for c in range(b, b + 7):
            part = abs(now[c] - before[c]) * (per_metre if c < b + 3 else 2.0)
            if not part <= largest:
                largest = part if part == part else np.inf
    return largest


@internal
def _predict(motion, k, pose):
    """Fill pose (3 + 7 n,) with the quintic through results k - 2 and k - 1, or from the last alone."""
    factors = quintic_factors(motion.times, k, motion.times[k])
    for c in range(3, pose.shape[0]):
        pose[c] = quintic_value(factors, k, motion.q, motion.dq, motion.ddq, c)


@internal
def _begin(motion, ws, k, h, pose):
    """Fill pose and guessed turns of step k from those before; of the first step from what is given."""
    if k == 0:
        for c in range(pose.shape[0]):
            pose[c] = motion.q[0, c]
        for n in range(ws.guess.shape[0]):
            ws.guess[n] = motion.turn[0, n]
        return
    _predict(motion, k, pose)
    for n in range(ws.guess.shape[0]):
        ws.guess[n] = motion.turn[k - 1, n] + h * motion.turn_rate[k - 1, n]


@internal
def _balance(system, laws, seq, fac, ws, motion, k):
    """Fill multipliers and wrenches of step k."""
    find_loads(system, motion.v[k], motion.a[k], ws, ws.load)
    if system.force.shape[0] + system.call.shape[0] > 0:
        apply_forces(system, laws, motion.times[k], motion.q[k], motion.v[k], ws, ws.load, motion.lam[k])
    solve_transposed(seq, fac, ws.load, motion.lam[k])
    if system.friction.shape[0] > 0:
        add_swept_friction(system, seq, fac, ws, motion.v[k], ws.load, motion.lam[k])
    find_wrenches(system, ws, motion.lam[k], motion.wrench[k])


@kernel
def sweep(system, laws, seq, fac, ws, size, motion, start, chosen, part):
    """Solve all of ``motion`` from row ``start`` on; rows before are known.

    The rows of J in ``seq`` are those chosen for times from row ``chosen`` on. With ``start`` 0, q[0] and turn[0] must
    hold the assembled pose. ``size`` is the mechanism's length (m). A step is NARROW whose margin is less than ``part``
    of that of row ``chosen``. Returns (status, index): DONE and T, or why and at which index the step was refused.
    """
    times = motion.times
    drives = motion.drives
    q = motion.q
    per_metre = 1.0 / size
    pose = ws.pose
    delta = ws.delta
    right = ws.right
    for k in range(start, times.shape[0]):
        h = 0.0
        if k > 0:
            h = times[k] - times[k - 1]
            for law in range(1, drives.shape[1]):
                if jumps(drives[k, law], drives[k - 1, law], h, motion.stride[law]):
                    return BRANCH_DOUBT, k
        _begin(motion, ws, k, h, pose)
        first = second = 0.0
        last = np.inf
        change = np.inf
        margin = 0.0
        evaluate_nu(system, drives[k], right[1])
        for iteration in range(MAX_ITERATIONS):
            evaluate_position(system, pose, drives[k], ws)
            margin = factorise(seq, ws.jac, fac)
            if margin < 1e-12:
                return SINGULAR, k
            for r in range(ws.phi.shape[0]):
                right[0, r] = -ws.phi[r]
            solve(seq, fac, 2, right, delta)
            move(pose, delta[0])
            change = extent(delta[0], per_metre)
            if iteration == 0:
                first = change
            elif iteration == 1:
                second = change
            if has_settled(iteration, change, last):
                break
            last = change
        if not change <= ROUNDING:
            return NO_CONTRACTION, k
        for c in range(q.shape[1]):
            q[k, c] = pose[c]
        for n in range(ws.guess.shape[0]):
            motion.turn[k, n] = ws.turn[n]
        motion.margin[k] = margin
        if margin < part * motion.margin[chosen]:
            return NARROW, k
        for d in range(motion.determinant.shape[1]):
            motion.determinant[k, d] = fac.determinant[d]
        worst = 0.0
        for r in range(system.held):
            worst = max(worst, abs(ws.phi[r]))
        motion.residual[k] = worst
        for c in range(3, delta.shape[1]):
            motion.v[k, c] = delta[1, c]
        if k > 0:
            if is_suspicious(first, second, _way(q, k, per_metre)):
                return BRANCH_DOUBT, k
            refused = heads_for_zero(motion.determinant, times, k, chosen) if k > chosen else 0
            if refused > 0:
                return BRANCH_DOUBT, refused
        evaluate_gamma(system, motion.v[k], drives[k], ws, right[0])
        solve(seq, fac, 1, right, delta)
        for c in range(3, delta.shape[1]):
            motion.a[k, c] = delta[0, c]
        for n in range(ws.guess.shape[0]):
            motion.turn_rate[k, n] = ws.turn_rate[n]
        rates(q[k], motion.v[k], motion.dq[k])
        bends(q[k], motion.v[k], motion.a[k], motion.ddq[k])
        if k > 0 and _unexplained(q, motion.dq, motion.ddq, k, h, per_metre) > UNEXPLAINED:
            return BRANCH_DOUBT, k
        if motion.lam.shape[0] > 0:
            _balance(system, laws, seq, fac, ws, motion, k)
    return DONE, times.shape[0]
