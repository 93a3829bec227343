"""RATTLE: symplectic and time-reversible, of order 2 with a fixed step; energy stays bounded over long runs.

    v_half = v0 + h/2 M^-1 (Q(q0, v0) - J(q0)^T lam)      q1 = q0 + h v_half,   lam so that Phi(q1, t1) = 0
    v1 = v_half + h/2 M^-1 (Q(q1, v1) - J(q1)^T mu)       mu so that J(q1) v1 = nu(t1)

The constraints hold by the method's own multipliers: no projection, which would spoil the symplectic map. The map is
symplectic where Q has a potential. Forces that depend on velocity keep it time-reversible, and v1 is found by
repeated evaluation: this suits weak damping, not stiff dampers.

lam is found by Newton's method with S = J W^-1 J^T at q0 instead of J(q1) W^-1 J(q0)^T; each pass gains a factor of
about h omega. W is M, lifted a little where bodies lack mass, and what it has too much is balanced in the next pass.

Source: Andersen 1983, J. Comput. Phys. 52; Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.

'symplectic' takes five steps of RATTLE as one of order 4, for long runs without friction:

    h p, h p, h (1 - 4 p), h p, h p,      p = 1 / (4 - 4^(1/3)) = 0.4145

The third goes back in time. Errors are far smaller than those of the composition of three.

Source: Suzuki 1990, Phys. Lett. A 146; Hairer, Lubich, Wanner, Geometric Numerical Integration, II.4.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, inlined, internal, kernel
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import begin_run, derivative
from mbsd.dynamics.integrators.kind import Integrator, register, without_sliding
from mbsd.dynamics.reference.projection import LIFT
from mbsd.dynamics.reference.schur import factor_schur, solve_schur, subtract_forces, times_jacobian
from mbsd.dynamics.state import fixed_step, record_here
from mbsd.equations.assembly import evaluate_nu, position
from mbsd.equations.laws import evaluate_laws
from mbsd.equations.loads import apply_loads

STAGES = 2
PASSES = 60
CLOSED = 1e-15
"""A pass that moves coordinates by less (sizes, rad) ends the search for lam."""
ROUNDING = 1e-10
"""Below this (sizes, rad) passes that no longer shrink are rounding."""
SUZUKI = 1.0 / (4.0 - 4.0 ** (1.0 / 3.0))


@internal
def _loads(dyn, scratch, t, y):
    """Put Q at (t, y) into scratch.stages[1, 0], after _factor at the same pose; returns its power (W)."""
    load = scratch.stages[1, 0]
    for c in range(load.shape[0]):
        load[c] = dyn.weight[c]
    if dyn.loads.total == 0:
        return 0.0
    return apply_loads(dyn.loads, dyn.laws, t, y[0], y[1], scratch.ws.cos_sin, load)


@internal
def _factor(dyn, scratch, t, q):
    """Evaluate laws and factor S at (t, q)."""
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    position(dyn.system, q, scratch.drive, scratch.ws)
    factor_schur(dyn.schur, dyn.inverse, scratch.ws.jac, scratch.factors, LIFT)


@inlined
def _stand(dyn, scratch, t, y):
    """Factor S and find the loads at (t, y), where a step begins; returns the power of the loads (W)."""
    _factor(dyn, scratch, t, y[0])
    return _loads(dyn, scratch, t, y)


@internal
def _correct(dyn, scratch, v, lam):
    """Change v (3 nb,) and lam (m,) by what removes the error of J v in ``side`` and the unbalanced impulse.

    Returns the largest change (sizes/s, rad/s); it is not a number if one is not. What W has more than M stays
    unbalanced for the next pass.
    """
    schur = dyn.schur
    factors = scratch.factors
    side = factors.side
    impulse = scratch.change[0]
    for c in range(3, v.shape[0]):
        scratch.ws.pose[c] = dyn.inverse[c] * impulse[c]
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            if schur.rows[k, s] >= 0:
                side[k, s, 0] += times_jacobian(factors, schur, k, s, scratch.ws.pose)
    solve_schur(schur, factors, 1)
    subtract_forces(factors, schur, 0, impulse)
    largest = 0.0
    for c in range(3, v.shape[0]):
        change = dyn.inverse[c] * impulse[c]
        v[c] += change
        impulse[c] -= dyn.inertia[c] * change
        size = abs(change) * dyn.per_size[c]
        if not size <= largest:
            largest = size
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            if r >= 0:
                lam[r] += side[k, s, 0]
    return largest


@inlined
def _driver_work(dyn, scratch, lam):
    """Return the work (J) of the impulses lam (m,) of drivers at the rates in scratch.drive."""
    work = 0.0
    for k in range(dyn.system.driven.shape[0]):
        work -= lam[dyn.system.driven[k, 0]] * scratch.drive[dyn.system.driven[k, 1], 1]
    return work


@internal
def _close(dyn, scratch, h, y):
    """Find v_half, in scratch.stages[0, 1], and lam with which the pose y[0] after h seconds closes.

    Returns False where no pass gets nearer.
    """
    schur = dyn.schur
    ws = scratch.ws
    side = scratch.factors.side
    start = scratch.stages[0, 0]
    v = scratch.stages[0, 1]
    lam = ws.right[0]
    last = 1e300
    for _ in range(PASSES):
        for c in range(3, v.shape[0]):
            y[0, c] = start[c] + h * v[c]
        position(dyn.system, y[0], scratch.drive, ws)
        for k in range(schur.rows.shape[0]):
            for s in range(2):
                r = schur.rows[k, s]
                side[k, s, 0] = ws.phi[r] / h if r >= 0 else 0.0
        moved = abs(h) * _correct(dyn, scratch, v, lam)
        if moved <= CLOSED or (moved <= ROUNDING and moved > 0.3 * last):
            return True
        if not moved < 1e3:
            return False
        last = moved
    return False


@apart
def rattle_step(dyn, scratch, t, h, y, power):
    """Step y (2, 3 nb) from t to t + h (s), h of either sign; _stand was called at its start, and is at its end.

    ``power`` is that of the loads at the start (W). Returns the power of the loads at the end and the work (J), in
    scratch.report[1:3], and whether lam and v1 were found.
    """
    system = dyn.system
    schur = dyn.schur
    ws = scratch.ws
    side = scratch.factors.side
    load = scratch.stages[1, 0]
    start = scratch.stages[0, 0]
    v = scratch.stages[0, 1]
    impulse = scratch.change[0]
    lam = ws.right[0]
    n3 = v.shape[0]
    work = 0.5 * h * power
    for c in range(3, n3):
        start[c] = y[0, c]
        v[c] = y[1, c]
        impulse[c] = 0.5 * h * load[c]
    for r in range(lam.shape[0]):
        lam[r] = 0.0
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t + h, scratch.drive)
    if not _close(dyn, scratch, h, y):
        return False
    for c in range(3, n3):
        y[0, c] = start[c] + h * v[c]
        y[1, c] = v[c]
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
        work += _driver_work(dyn, scratch, lam)
    _factor(dyn, scratch, t + h, y[0])
    evaluate_nu(system, scratch.drive, ws.right[1])
    converged = False
    for _ in range(PASSES):
        power = _loads(dyn, scratch, t + h, y)
        for c in range(3, n3):
            start[c] = y[1, c]
            y[1, c] = v[c]
            impulse[c] = 0.5 * h * load[c]
        for r in range(lam.shape[0]):
            lam[r] = 0.0
        last = 1e300
        for done in range(PASSES):
            for k in range(schur.rows.shape[0]):
                for s in range(2):
                    r = schur.rows[k, s]
                    side[k, s, 0] = (
                        times_jacobian(scratch.factors, schur, k, s, y[1]) - ws.right[1][r] if r >= 0 else 0.0
                    )
            change = abs(h) * _correct(dyn, scratch, y[1], lam)
            settled = dyn.passes == 1 or not change > CLOSED or not change < 0.3 * last
            if done >= dyn.passes and settled:  # once more than needed, for the rounding of nearly singular poses
                break
            last = change
        moved = 0.0
        for c in range(3, n3):
            size = abs(h * (y[1, c] - start[c])) * dyn.per_size[c]
            if not size <= moved:
                moved = size
        if dyn.loads.total == 0 or moved <= CLOSED:
            converged = moved < 1e300
            break
    work += 0.5 * h * power + _driver_work(dyn, scratch, lam)
    scratch.report[1] = power
    scratch.report[2] = work
    return converged


@apart
def march(dyn, scratch, state, out, settings, end, max_steps, parts):
    """Advance by RATTLE (1 part) or by its composition of order 4 (5 parts)."""
    y = state.y
    begin_run(dyn, scratch, state)
    power = _stand(dyn, scratch, state.clock[run_state.TIME], y)
    fresh = True
    accepted = 0
    while True:
        t = state.clock[run_state.TIME]
        due = state.count[run_state.NEXT] < out.t.shape[0] and out.t[state.count[run_state.NEXT]] <= t
        done = t >= end or accepted == max_steps
        if (due or done) and not fresh:
            state.clock[run_state.POWER] = derivative(dyn, scratch, t, y, state.dy, state.lam)
            state.count[run_state.EVALUATIONS] += 1
            fresh = True
        if due:
            margin = scratch.report[0]
            while state.count[run_state.NEXT] < out.t.shape[0] and out.t[state.count[run_state.NEXT]] <= t:
                record_here(scratch, state, out)
            if not done:
                power = _stand(dyn, scratch, t, y)
                scratch.report[0] = margin
        if t >= end:
            return run_state.REACHED
        if done:
            return run_state.PAUSED
        h, reached = fixed_step(state, out, settings, end)
        at = t
        for part in range(parts):
            ahead = h
            if parts == 5:
                ahead *= 1.0 - 4.0 * SUZUKI if part == 2 else SUZUKI
            if not rattle_step(dyn, scratch, at, ahead, y, power):
                return run_state.NO_CONVERGENCE
            at += ahead
            power = scratch.report[1]
            state.clock[run_state.WORK] += scratch.report[2]
        state.clock[run_state.TIME] = reached
        state.count[run_state.EVALUATIONS] += parts
        state.count[run_state.ACCEPTED] += 1
        accepted += 1
        fresh = False


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    return march(dyn, scratch, state, out, settings, end, max_steps, 1)


RATTLE = register(Integrator("rattle", advance, STAGES, order=2, fixed_step=True, refusal=without_sliding))


@kernel
def advance_symplectic(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    return march(dyn, scratch, state, out, settings, end, max_steps, 5)


SYMPLECTIC = register(
    Integrator("symplectic", advance_symplectic, STAGES, order=4, fixed_step=True, refusal=without_sliding)
)
