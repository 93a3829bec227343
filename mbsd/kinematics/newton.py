"""Positions, velocities and accelerations along a driven motion: Newton-Raphson with a predictor.

    predict   q from the quintic through the last two (q, v, a)
    correct   J dq = -Phi, until |dq| is below the tolerance
    then      J v = nu,  J a = gamma  with the factors of the last Newton step

The last Newton step moves q by less than ``TOLERANCE``, so its factors serve velocities and accelerations too.

Branch guard: a step is refused, and the caller puts a pose into it, when

- a driver goes further than its stride or jumps (motions between two poses would go unseen);
- Newton does not contract well, or corrects a large part of what was predicted;
- the step is not the one that the rates at both ends make,  dq = h (v_0 + v_1) / 2 - h^2 (a_1 - a_0) / 12,
  so that equations which hold again after a pitch or a turn cannot be met on another one;
- the determinant of an irreducible block of J changes sign, shrinks fast, or would on a straight line through its last
  two values: near such a pose two assemblies come close, and steps shorter than the way to it tell them apart.

Loops of Newton-Raphson elsewhere solve other systems: blocks of few unknowns (groups/newton/block.py, which share the
test and the guard), and starts far from closed, by damped steps of least norm (pose/close.py).

Where the two assemblies meet, steps do not tell them apart however short they are: mbsd/kinematics/change_points/
passes these poses.

Source: Haug 1989, ch. 4 (Newton-Raphson); Hairer, Norsett, Wanner, Solving ODEs I, II.6 (Hermite interpolation).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import inlined, kernel
from mbsd.equations.assembly import evaluate_gamma, evaluate_nu, evaluate_position
from mbsd.kinematics.elimination import factorise, solve

TOLERANCE = 1e-12
"""Tolerance of a Newton correction, relative to the mechanism's size (m) and to 1 rad."""
ROUNDING = 1e-9
"""A correction that stops shrinking below this has met rounding in an ill-conditioned pose, and is accepted."""
MAX_ITERATIONS = 12
SUSPICIOUS = 0.25
"""A correction above this part of the step may have left the branch."""
CONTRACTS = 0.1
"""A second correction above this part of the first was not made near the solution."""
UNEXPLAINED = 0.02
"""Part of a step, in sizes and rad, that the rates at its ends may leave unexplained."""
SHRINKS = 0.1
"""A determinant that falls to this part of its last value, or heads for it, may vanish in between."""

DONE, NO_CONTRACTION, BRANCH_DOUBT, SINGULAR = 0, 1, 2, 3


class DrivenMotion(NamedTuple):
    """A motion of which one row after the other is solved."""

    times: Any
    """(T,) s"""
    drives: Any
    """(T, motions + 1, 3) laws of drivers with two derivatives."""
    stride: Any
    """(motions + 1,) how far each law may go in a step."""
    q: Any
    """(T, 3 nb), and so are v and a."""
    v: Any
    a: Any


@inlined
def _predict(q, v, a, t, k, time, out):
    """Predict the pose at ``time``: the quintic through results k-2 and k-1, or the last alone."""
    factors = quintic_factors(t, k, time)
    for c in range(3, q.shape[1]):
        out[c] = quintic_value(factors, k, q, v, a, c)


@kernel
def _extent(delta, per_metre):
    """Return the largest part of a change of pose (3 nb,) in sizes and rad; NaN counts as infinite."""
    largest = 0.0
    for b in range(3, delta.shape[0], 3):
        part = max(abs(delta[b]) * per_metre, abs(delta[b + 1]) * per_metre, abs(delta[b + 2]))
        if not part <= largest:
            largest = part if part == part else np.inf
    return largest


@inlined
def has_settled(iteration, change, last):
    """Return True if a correction is small enough, or more than half the last: rounding is met."""
    return change <= TOLERANCE or (iteration > 0 and not change < 0.5 * last)


@inlined
def is_suspicious(first, second, step):
    """Return True if the first two corrections of a step are too large for the predicted branch."""
    return first > SUSPICIOUS * step + 1e-9 or second > CONTRACTS * first + 1e-9


@inlined
def heads_for_zero(determinants, times, k, first):
    """Return the step in which a determinant may have vanished: k, or the one after ``first``; else 0.

    ``first``: the row at which the determinants begin.
    """
    for d in range(determinants.shape[1]):
        now = determinants[k, d]
        before = determinants[k - 1, d]
        if not now * before > SHRINKS * before * before:
            return k
        if k > first + 1:
            slope = (before - determinants[k - 2, d]) / (times[k - 1] - times[k - 2])
            if (before + slope * (times[k] - times[k - 1])) * before < SHRINKS * before * before:
                return k
        if k == first + 2:  # seen backwards, for the first step has nothing before it
            slope = (now - before) / (times[k] - times[k - 1])
            if (before - slope * (times[k - 1] - times[k - 2])) * before < SHRINKS * before * before:
                return k - 1
    return 0


@inlined
def _unexplained(q, v, a, k, h, per_metre):
    """Return the largest part of step k that its end rates do not explain, in sizes and rad.

    NaN counts as infinite.
    """
    largest = 0.0
    half = 0.5 * h
    twelfth = h * h / 12.0
    now, before, rate, rate_before, bend, bend_before = q[k], q[k - 1], v[k], v[k - 1], a[k], a[k - 1]
    for b in range(3, q.shape[1], 3):
        for c in range(b, b + 3):
            gap = now[c] - before[c] - half * (rate[c] + rate_before[c]) + twelfth * (bend[c] - bend_before[c])
            gap = abs(gap) * (per_metre if c < b + 2 else 1.0)
            if not gap <= largest:
                largest = gap if gap == gap else np.inf
    return largest


@kernel
def sweep(system, seq, fac, ws, size, motion, residual, determinant, start, chosen):
    """Solve positions, velocities and accelerations of ``motion`` from row ``start`` on.

    Rows before are known.

    The rows of J in ``seq`` are those chosen for times from row ``chosen`` on. residual (T,) largest |Phi| and
    determinant (T, d) of each block of J are filled, too. With ``start`` 0, q[0] must hold the assembled pose. ``size``
    is the mechanism's length (m). Returns (status, index): DONE and T, or why and at which index the step was refused.
    """
    times = motion.times
    drives = motion.drives
    q = motion.q
    v = motion.v
    a = motion.a
    n3 = q.shape[1]
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
            _predict(q, v, a, times, k, times[k], pose)
        else:
            for c in range(n3):
                pose[c] = q[0, c]
        first = 0.0
        second = 0.0
        last = np.inf
        evaluate_nu(system, drives[k], right[1])
        for iteration in range(MAX_ITERATIONS):
            evaluate_position(system, pose, drives[k], ws)
            margin = factorise(seq, ws.jac, fac)
            if margin < 1e-12:
                return SINGULAR, k
            for r in range(ws.phi.shape[0]):
                right[0, r] = -ws.phi[r]
            solve(seq, fac, 2, right, delta)
            for c in range(3, n3):
                pose[c] += delta[0, c]
            change = _extent(delta[0], per_metre)
            if iteration == 0:
                first = change
            elif iteration == 1:
                second = change
            if has_settled(iteration, change, last):
                break
            last = change
        if not change <= ROUNDING:
            return NO_CONTRACTION, k
        for c in range(n3):
            q[k, c] = pose[c]
        for d in range(determinant.shape[1]):
            determinant[k, d] = fac.determinant[d]
        worst = 0.0
        for r in range(ws.phi.shape[0]):
            worst = max(worst, abs(ws.phi[r]))
        residual[k] = worst
        for c in range(3, n3):
            v[k, c] = delta[1, c]
        if k > 0:
            for c in range(3, n3):
                delta[0, c] = pose[c] - q[k - 1, c]
            step = _extent(delta[0], per_metre)
            if is_suspicious(first, second, step):
                return BRANCH_DOUBT, k
            refused = heads_for_zero(determinant, times, k, chosen) if k > chosen else 0
            if refused > 0:
                return BRANCH_DOUBT, refused
        evaluate_gamma(system, v[k], drives[k], ws, right[0])
        solve(seq, fac, 1, right, delta)
        for c in range(3, n3):
            a[k, c] = delta[0, c]
        if k > 0 and _unexplained(q, v, a, k, h, per_metre) > UNEXPLAINED:
            return BRANCH_DOUBT, k
    return DONE, times.shape[0]


LONGEST_STRETCH = 4.0
"""Ratio of step lengths beyond which the quintic is not trusted; the last (q, v, a) alone predicts."""


@inlined
def quintic_factors(t, k, time):
    """Return weights at ``time`` of the data of poses k - 1, k - 2: the difference of q, v and a of each.

    With s = ahead / h the quintic is linear in the six data, so its five factors are found once for all coordinates.
    """
    ahead = time - t[k - 1]
    h = t[k - 1] - t[k - 2] if k > 1 else 0.0
    from_q = 0.0
    from_v = ahead
    from_a = 0.5 * ahead * ahead
    earlier_v = 0.0
    earlier_a = 0.0
    if ahead < LONGEST_STRETCH * h:
        s = ahead / h
        cube = s * s * s
        from_q = -cube * (10.0 + s * (15.0 + 6.0 * s))
        p1 = -cube * (4.0 + s * (7.0 + 3.0 * s))
        p2 = -cube * (0.5 + s * (1.0 + 0.5 * s))
        from_v = h * (s + from_q - p1)
        from_a = h * h * (0.5 * s * s - 0.5 * from_q + p1 - p2)
        earlier_v = h * p1
        earlier_a = h * h * p2
    return from_q, from_v, from_a, earlier_v, earlier_a


@inlined
def quintic_value(factors, k, q, v, a, c):
    """Return coordinate c by these factors from poses k - 1 and k - 2 in q, v, a (T, 3 nb)."""
    from_q, from_v, from_a, earlier_v, earlier_a = factors
    last = k - 1
    before = max(k - 2, 0)
    return (
        q[last, c]
        + from_q * (q[before, c] - q[last, c])
        + from_v * v[last, c]
        + earlier_v * v[before, c]
        + from_a * a[last, c]
        + earlier_a * a[before, c]
    )


JUMP = 0.25
"""Part of a law's step that its rates may leave unexplained."""


@inlined
def jumps(law, before, h, stride):
    """Return True if a law's value (3,) is over ``stride`` from that h before, or off its rates' lead.

    h is in s.
    """
    step = law[0] - before[0]
    gap = step - h * (0.5 * (law[1] + before[1]) - h / 12.0 * (law[2] - before[2]))
    if not (abs(step) <= stride and h * abs(law[1]) <= stride and h * abs(before[1]) <= stride):
        return True
    return not abs(gap) <= JUMP * abs(step) + 1e-9
