"""Positions, velocities and accelerations along a driven motion: Newton-Raphson with a predictor.

    predict   q from the quintic through the last two (q, v, a)
    correct   J dq = -Phi, until |dq| is below the tolerance
    then      J v = nu,  J a = gamma  with the factors of the last Newton step

The last Newton step moves q by less than ``TOLERANCE``, so its factors serve velocities and accelerations too.

Branch guard: a step is refused (the caller halves it) when Newton does not contract, when the correction is not
small against the step that was predicted, or when the sign of det J changes though the prediction was not
confirmed: then the pose may lie on the other assembly.

Source: Haug 1989, ch. 4 (Newton-Raphson); Hairer, Norsett, Wanner, Solving ODEs I, II.6 (Hermite interpolation).
"""

from __future__ import annotations

import numpy as np

from mbsd.assembly import evaluate_gamma, evaluate_nu, evaluate_position
from mbsd.elimination import factorise, solve
from mbsd.jit import inlined, kernel

TOLERANCE = 1e-12
"""Of a Newton correction, relative to the mechanism's size (m) and to 1 rad."""
ROUNDING = 1e-9
"""A correction that stops shrinking below this has met rounding in an ill-conditioned pose, and is accepted."""
MAX_ITERATIONS = 12
CONFIRMED = 1e-3
"""A correction below this part of the predicted step confirms the branch, even past a change point."""
SUSPICIOUS = 0.25
"""A correction above this part of the predicted step may have left the branch."""
LONGEST_STRETCH = 4.0
"""Beyond this ratio of step lengths the quintic is not trusted; the last (q, v, a) alone predicts."""

DONE, NO_CONTRACTION, BRANCH_DOUBT, SINGULAR = 0, 1, 2, 3


@inlined
def _predict(q, v, a, t, k, time, out):
    """Pose at ``time`` from results 0 .. k-1: the quintic through the last two, or the last alone.

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
    last = k - 1
    before = max(k - 2, 0)
    for c in range(3, q.shape[1]):
        out[c] = (
            q[last, c]
            + from_q * (q[before, c] - q[last, c])
            + from_v * v[last, c]
            + earlier_v * v[before, c]
            + from_a * a[last, c]
            + earlier_a * a[before, c]
        )


@kernel
def _extent(delta, per_metre):
    """Largest part of a change of pose (3 nb,): lengths in sizes, angles in rad; NaN counts as infinite."""
    largest = 0.0
    for b in range(3, delta.shape[0], 3):
        part = max(abs(delta[b]) * per_metre, abs(delta[b + 1]) * per_metre, abs(delta[b + 2]))
        if not part <= largest:
            largest = part if part == part else np.inf
    return largest


@kernel
def sweep(system, seq, fac, ws, size, times, drives, q, v, a, residual, sign, start):
    """Solve positions, velocities and accelerations at ``times[start:]``; rows before ``start`` are known.

    times (T,), drives (T, motions, 3), q, v, a (T, 3 nb), residual (T,) largest |Phi| and sign (T,) of det J are
    filled. With ``start`` 0, q[0] must hold the assembled pose. ``size`` is the mechanism's length (m).
    Returns (status, index): DONE and T, or why and at which index the step was refused.
    """
    n3 = q.shape[1]
    per_metre = 1.0 / size
    pose = ws.pose
    delta = ws.delta
    right = ws.right
    for k in range(start, times.shape[0]):
        if k > 0:
            _predict(q, v, a, times, k, times[k], pose)
        else:
            for c in range(n3):
                pose[c] = q[0, c]
        first = 0.0
        last = np.inf
        evaluate_nu(system, drives[k], right[1])
        for iteration in range(MAX_ITERATIONS):
            evaluate_position(system, pose, drives[k], ws)
            determinant, margin = factorise(seq, ws.jac, fac)
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
            if change <= TOLERANCE:
                break
            if iteration > 0 and not change < 0.5 * last:
                break
            last = change
        if not change <= ROUNDING:
            return NO_CONTRACTION, k
        if k > 0:
            for c in range(3, n3):
                delta[0, c] = pose[c] - q[k - 1, c]
            step = _extent(delta[0], per_metre)
            if first > SUSPICIOUS * step + 1e-9:
                return BRANCH_DOUBT, k
            if determinant != sign[k - 1] and first > CONFIRMED * step + 1e-9:
                return BRANCH_DOUBT, k
        for c in range(n3):
            q[k, c] = pose[c]
        sign[k] = determinant
        worst = 0.0
        for r in range(ws.phi.shape[0]):
            worst = max(worst, abs(ws.phi[r]))
        residual[k] = worst
        for c in range(3, n3):
            v[k, c] = delta[1, c]
        evaluate_gamma(system, v[k], drives[k], ws, right[0])
        solve(seq, fac, 1, right, delta)
        for c in range(3, n3):
            a[k, c] = delta[0, c]
    return DONE, times.shape[0]
