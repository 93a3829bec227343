"""Solutions of the equations of motion, refined pass by pass where coordinates lack mass or masses are far apart.

    W da + J^T dlam = r,   J (a + da) = gamma,     r = Q - M a - J^T lam: what the passes before left

W is M, lifted where M is zero. A pass leaves r = (W - M) da. That is smaller than before by the lift over the inertia
that joints lend to the coordinate, which changes with the pose: passes go on until each coordinate without mass is in
balance, measured by the sum of the moments that joints put on it.

Source: Golub and Van Loan, Matrix Computations, 3.5.3 (iterative improvement).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, inlined, lazy
from mbsd.dynamics.reference.schur import solve_schur, subtract_forces, times_jacobian

BALANCED = 1e-12
"""Part of the loads on a coordinate without mass that may stay unbalanced."""
SHRINKS = 0.5
"""A pass that leaves more than this part of what the last one left ends the refinement: the rest is rounding, or
nothing holds the coordinate."""
MOST_MORE = 60
"""Passes beside those that are always taken."""


@inlined
def refine(schur, factors, inverse, inertia, force, gamma, moving, pose, a, lam):
    """One pass: change a (3 nb,) and lam (m,) by what is left in ``force`` (3 nb,), which becomes Q - J^T lam.

    After factor_schur. gamma (m,) is taken ``moving`` times; pose (3 nb,) is scratch, zero for ground.
    """
    y = factors.side
    n3 = a.shape[0]
    for c in range(3, n3):
        pose[c] = a[c] + inverse[c] * (force[c] - inertia[c] * a[c])
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            y[k, s, 0] = times_jacobian(factors, schur, k, s, pose) - moving * gamma[r] if r >= 0 else 0.0
    solve_schur(schur, factors, 1)
    subtract_forces(factors, schur, 0, force)
    for c in range(3, n3):
        a[c] += inverse[c] * (force[c] - inertia[c] * a[c])
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            if r >= 0:
                lam[r] += y[k, s, 0]


@lazy(float)
def unbalanced(schur, factors, inverse, inertia, force, lam, carried):
    """Return the largest part of the loads on a coordinate without mass that the passes so far left in ``force``.

    ``carried`` (3 nb,) is scratch, zero for ground.
    """
    arm = factors.arm
    for c in range(force.shape[0]):
        carried[c] = 0.0
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            if r >= 0:
                for side in range(2):
                    at = 3 * schur.bodies[k, side]
                    for c in range(3):
                        carried[at + c] += abs(arm[2 * k + side, 3 * s + c] * lam[r])
    for c in range(3):
        carried[c] = 0.0  # as refine expects it of ground
    largest = 0.0
    for c in range(3, force.shape[0]):
        left = abs(force[c])
        if inertia[c] == 0.0 and inverse[c] > 0.0 and left > BALANCED * carried[c]:
            largest = max(largest, left / carried[c])
    return largest


@inlined
def solve_balanced(schur, factors, inverse, inertia, passes, force, gamma, moving, pose, a, lam):
    """Fill a (3 nb,) and lam (m,) under ``force`` (3 nb,), which is overwritten, in ``passes`` or more; see refine."""
    for c in range(a.shape[0]):
        a[c] = 0.0
    for r in range(lam.shape[0]):
        lam[r] = 0.0
    last = math.inf
    for done in range(passes + MOST_MORE):
        refine(schur, factors, inverse, inertia, force, gamma, moving, pose, a, lam)
        if done + 1 < passes:
            continue
        if passes == 1:
            break
        left = unbalanced(schur, factors, inverse, inertia, force, lam, pose)
        if left == 0.0 or not left < SHRINKS * last:
            break
        last = left


@apart
def respond(dyn, scratch, force, moving, a, lam):
    """Fill a (3 nb,) and lam (m,) under ``force`` (3 nb,), which is overwritten; gamma is taken ``moving`` times.

    After factor_schur; gamma (m,) is in scratch.ws.right[0]. The friction of sliding contacts and joints is left out.
    """
    solve_balanced(
        dyn.schur, scratch.factors, dyn.inverse, dyn.inertia, dyn.passes, force, scratch.ws.right[0], moving,
        scratch.ws.pose, a, lam,
    )  # fmt: skip
