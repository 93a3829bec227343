"""Accelerations and multipliers at a state.

    M a + J^T lam = Q                  S lam = J W^-1 Q - gamma,   S = J W^-1 J^T
    J a = gamma                        a = W^-1 (Q - J^T lam)

W is M. Where bodies lack mass, W is M lifted by a small inertia, and the solution is refined until it balances
(refinement.py).

    Baumgarte   J a = gamma - 2 alpha (J v - nu) - beta^2 Phi

Friction of joints depends on lam: it is added to Q and solved for again until both agree (joint_friction.py). That of
sliding contacts is in each of these solutions (sliding.py).

Source: Haug 1989, ch. 6; Baumgarte 1972, Comp. Meth. Appl. Mech. Eng. 1.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy, merged
from mbsd.dynamics.reference.pins import factor_pins, solve_pins
from mbsd.dynamics.reference.refinement import MOST_MORE, SHRINKS, refine, unbalanced
from mbsd.dynamics.reference.schur import factor_schur, times_jacobian
from mbsd.dynamics.reference.sliding import begin_sliding, slide
from mbsd.equations.assembly import evaluate_gamma, evaluate_position
from mbsd.equations.joint_friction import (
    AGREES,
    BEGINS_AGAIN,
    CHANGE,
    FAILED,
    MOST_PASSES,
    apply_friction,
    begin_friction,
    note_friction,
    settle,
)
from mbsd.equations.laws import evaluate_laws
from mbsd.equations.loads import apply_loads


@lazy(float)
def _begin_again(dyn, scratch, t, state, a, lam):
    """Loads and friction as before the first pass; returns their power (W)."""
    force = scratch.force
    power = 0.0
    _begin(dyn, force, a, lam)
    if dyn.loads.total > 0:
        power = apply_loads(dyn.loads, dyn.laws, t, state[0], state[1], scratch.ws.cos_sin, force)
    return power + begin_friction(dyn.system, dyn.loads, state[1], scratch.ws, force)


@internal
def _begin(dyn, force, a, lam):
    """Begin with the weights alone, and without accelerations and multipliers."""
    for c in range(a.shape[0]):
        force[c] = dyn.weight[c]
        a[c] = 0.0
    for r in range(lam.shape[0]):
        lam[r] = 0.0


@internal
def _stabilise(dyn, scratch, v):
    """Add Baumgarte's terms to gamma, at velocities v (3 nb,) and the pose evaluated last."""
    schur = dyn.schur
    alpha = dyn.baumgarte[0]
    beta = dyn.baumgarte[1]
    phi = scratch.ws.phi
    gamma = scratch.ws.right[0]
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            if r >= 0:
                gamma[r] -= 2.0 * alpha * times_jacobian(scratch.factors, schur, k, s, v) + beta * beta * phi[r]
    for k in range(dyn.system.driven.shape[0]):
        gamma[dyn.system.driven[k, 0]] += 2.0 * alpha * scratch.drive[dyn.system.driven[k, 1], 1]


@merged
def accelerate(dyn, scratch, t, state, a, lam):
    """Fill a (3 nb,) and lam (m,) at a state (2, 3 nb) and time (s).

    Returns the power of loads and drivers, gravity left out (W).
    """
    system = dyn.system
    schur = dyn.schur
    ws = scratch.ws
    factors = scratch.factors
    drive = scratch.drive
    force = scratch.force
    gamma = ws.right[0]
    q = state[0]
    v = state[1]
    n3 = q.shape[0]
    power = 0.0
    if drive.shape[0] > 1:
        evaluate_laws(dyn.laws, drive.shape[0], t, drive)
    alpha = dyn.baumgarte[0]
    pins = schur.pins.shape[0] > 0 and not alpha > 0.0
    if pins:
        scratch.report[0] = factor_pins(schur, factors, ws.cos_sin, system.marker_arm, q, v, dyn.inverse, 0.0)
    else:
        evaluate_position(system, q, drive, ws)
        evaluate_gamma(system, v, drive, ws, gamma)
        scratch.report[0] = factor_schur(schur, dyn.inverse, ws.jac, factors, 0.0)
    _begin(dyn, force, a, lam)
    if dyn.loads.total > 0:
        power = apply_loads(dyn.loads, dyn.laws, t, q, v, ws.cos_sin, force)
    if pins:
        solve_pins(schur, factors, dyn.inverse, force, a, lam)
        return power
    with_friction = dyn.loads.friction.shape[0] > 0
    sliding = dyn.sliding.rows.shape[0] > 0
    if with_friction:
        power += begin_friction(system, dyn.loads, v, ws, force)
    if alpha > 0.0:
        _stabilise(dyn, scratch, v)
    first = dyn.passes
    tries = 0
    left = math.inf
    begun = False
    for done in range((dyn.passes + MOST_MORE) * (MOST_PASSES + 1)):
        refine(schur, factors, dyn.inverse, dyn.inertia, force, gamma, 1.0, ws.pose, a, lam)
        if done + 1 < first:
            continue
        if dyn.passes > 1:
            last = left
            left = unbalanced(schur, factors, dyn.inverse, dyn.inertia, force, lam, ws.pose)
            if left > 0.0 and left < SHRINKS * last:
                continue
            left = math.inf
        if sliding:
            if not begun:
                begin_sliding(dyn, scratch)
                begun = True
            power += slide(dyn, scratch, v, a, lam)
        if not with_friction:
            break
        follows = settle(dyn, ws, a, lam)
        if follows == AGREES:
            break
        if tries == MOST_PASSES:
            dyn.loads.iteration[FAILED] = 1.0
            for c in range(3, n3):
                a[c] = math.nan
            break
        tries += 1
        if follows == BEGINS_AGAIN:
            power = _begin_again(dyn, scratch, t, state, a, lam)
            first = done + 1 + dyn.passes
            begun = False
            continue
        power += apply_friction(system, dyn.loads, v, ws, dyn.loads.normal[CHANGE], 0.0, force)
    if with_friction:
        note_friction(system, dyn.loads, v, ws, lam)
    for k in range(system.driven.shape[0]):
        power -= lam[system.driven[k, 0]] * drive[system.driven[k, 1], 1]
    return power
