"""Reference coordinates in space as a formulation of the compiled loop (mbsd/dynamics/formulation.py).

    q = (r, e)    v = (r', w), w about principal axes    r' = r',  e' = e (0, w) / 2
    M a + J^T lam = Q,   J a = gamma,   M = diag(m, m, m, I1, I2, I3)
    Q = (m g, (I2 - I3) w2 w3, (I3 - I1) w3 w1, (I1 - I2) w1 w2)

Rows are evaluated in the world, as driven motions do, and their torques turned into body axes: tau_b = A^T tau. Stages
need no unit e; a projection makes it one, and moves q and v in the metric of the masses.

Where joints repeat each other some rows are in use. They are chosen anew after an accepted step in which the least part
of a row that is its own falls below a limit, never within a step.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.compiling.jit import apart, inlined, internal, lazy
from mbsd.dynamics.formulation import add_formulation, record_output
from mbsd.dynamics.state import NEXT, TIME, WORK
from mbsd.equations.laws import evaluate_laws
from mbsd.spatial.dynamics.envelope import factor, solve
from mbsd.spatial.equations.evaluation import evaluate_gamma, evaluate_nu, evaluate_position
from mbsd.spatial.equations.forces import along_row, apply_forces, push_row
from mbsd.spatial.equations.friction import (
    MOST_PASSES,
    ROW,
    add_change,
    begin_friction,
    correct_normals,
    end_friction,
    find_normals,
)
from mbsd.spatial.equations.turn import TURN, bend_turns
from mbsd.spatial.equations.vectors import add_turning, make_unit, turn_vectors


class Switches(NamedTuple):
    """Forces that switch; there are none in space yet."""

    switch: Any


class Table(NamedTuple):
    """Rows that events switch, of which there are none yet."""

    rows: Any
    table: Any


class SpaceDynamics(NamedTuple):
    """A mechanism in space as integrators read it. Entries: three idle ones, then 7 or 6 of each body."""

    system: Any
    """mbsd.spatial.equations.system.System"""
    laws: Any
    """mbsd.equations.laws.Laws: 1 .. drivers are the drivers' laws of time."""
    loads: Switches
    schur: Table
    sliding: Table
    envelope: Any
    """mbsd.spatial.dynamics.envelope.Envelope"""
    factors: Any
    inertia: Any
    """(3 + 7 n,) kg, kg m^2; zero for idle entries."""
    inverse: Any
    weight: Any
    """(3 + 7 n,) m g."""
    per_size: Any
    world: Any
    """(3 + 6 n,) scratch: velocities with w in the world."""
    pushed: Any
    """(m,) scratch: multipliers of forces."""
    limit: Any
    """(1,) part of a row below which other rows are looked for; 0: never."""
    turns: Any
    """(T, turns) counted angles at the outputs."""
    counted: Any
    """(1 + turns,) when turns were counted last (s), and their rates then (rad/s)."""


@inlined
def _turn_arm(ws, row, c, b):
    """Turn the torque at row[c] from the world into the axes of body b."""
    m = ws.rotation[b]
    x, y, z = row[c], row[c + 1], row[c + 2]
    for k in range(3):
        row[c + k] = m[0, k] * x + m[1, k] * y + m[2, k] * z


@internal
def _to_body_axes(dyn, ws):
    """Turn the torques of J, of rows in use, from the world into the axes of their bodies."""
    env = dyn.envelope
    for e in range(env.arm.shape[0]):
        _turn_arm(ws, ws.jac[env.rows[env.arm[e, 0]]], env.arm[e, 1] + 3, env.arm[e, 2])
    for n in range(dyn.system.friction.shape[0]):
        r = dyn.system.friction[n, ROW]
        for side in range(dyn.system.row_body.shape[1]):
            if dyn.system.row_body[r, side] > 0:
                _turn_arm(ws, ws.jac[r], 6 * side + 3, dyn.system.row_body[r, side])


@internal
def _to_world(dyn, ws, v):
    """Fill dyn.world with velocities v whose w are in the axes of their bodies."""
    out = dyn.world
    for b in range(1, dyn.system.mass.shape[0]):
        c = 6 * b - 3
        m = ws.rotation[b]
        for k in range(3):
            out[c + k] = v[c + k]
            out[c + 3 + k] = m[k, 0] * v[c + 3] + m[k, 1] * v[c + 4] + m[k, 2] * v[c + 5]


@internal
def _respond(dyn, ws, force, gamma, a, lam):
    """Fill a, lam (m,) of M a + J^T lam = force, J a = gamma, by factors of this pose; force is spent."""
    env = dyn.envelope
    side = dyn.factors.side
    for r in range(lam.shape[0]):
        lam[r] = 0.0
    for r in range(env.rows.shape[0]):
        side[0, r] = -gamma[env.rows[r]]
    for e in range(env.arm.shape[0]):
        r = env.arm[e, 0]
        c = env.arm[e, 1]
        d = 6 * env.arm[e, 2] - 3
        for k in range(6):
            side[0, r] += ws.jac[env.rows[r], c + k] * dyn.inverse[d + k] * force[d + k]
    solve(env, dyn.factors, 1)
    for e in range(env.arm.shape[0]):
        r = env.arm[e, 0]
        c = env.arm[e, 1]
        d = 6 * env.arm[e, 2] - 3
        for k in range(6):
            force[d + k] -= side[0, r] * ws.jac[env.rows[r], c + k]
    for r in range(env.rows.shape[0]):
        lam[env.rows[r]] = side[0, r]
    for c in range(3, a.shape[0]):
        a[c] = dyn.inverse[c] * force[c]


@lazy(float)
def _add_friction(dyn, ws, v, force, a, lam):
    """Add friction of joints to a and lam (m,), found together with the reactions; returns its power (W)."""
    system = dyn.system
    more, borne, none = ws.pose, dyn.pushed, ws.right[1]
    begin_friction(system, ws, v)
    weight = 1.0
    for step in range(MOST_PASSES):
        for c in range(force.shape[0]):
            force[c] = 0.0
        add_change(system, ws, force)
        for r in range(none.shape[0]):
            none[r] = 0.0
        _respond(dyn, ws, force, none, more, borne)
        for c in range(3, a.shape[0]):
            a[c] += more[c]
        for r in range(system.held):
            lam[r] += borne[r]
        find_normals(system, ws, lam, True)
        weight = correct_normals(ws, step, weight)
        if weight == 0.0:
            return end_friction(system, ws, lam)
    return math.nan


@apart
def accelerate(dyn, scratch, t, state, a, lam):
    """See formulation.py of the plane; returns the power of forces and drivers (W)."""
    ws = scratch.ws
    v = state[1]
    force = scratch.force
    gamma = ws.right[0]
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    evaluate_position(dyn.system, state[0], scratch.drive, ws)
    _to_world(dyn, ws, v)
    evaluate_gamma(dyn.system, dyn.world, scratch.drive, ws, gamma)
    power = 0.0
    for c in range(ws.load.shape[0]):
        ws.load[c] = 0.0
    if dyn.system.force.shape[0] + dyn.system.call.shape[0] > 0:
        power = apply_forces(dyn.system, dyn.laws, t, state[0], dyn.world, ws, ws.load, dyn.pushed)
    _to_body_axes(dyn, ws)
    scratch.report[0] = factor(dyn.envelope, dyn.factors, ws.jac, dyn.inverse)
    for c in range(force.shape[0]):
        force[c] = dyn.weight[c]
    for b in range(1, dyn.system.mass.shape[0]):
        c = 6 * b
        i = dyn.system.inertia[b]
        force[c] = (i[1] - i[2]) * v[c + 1] * v[c + 2]
        force[c + 1] = (i[2] - i[0]) * v[c + 2] * v[c]
        force[c + 2] = (i[0] - i[1]) * v[c] * v[c + 1]
        m = ws.rotation[b]
        for k in range(3):
            force[c - 3 + k] += ws.load[c - 3 + k]
            force[c + k] += m[0, k] * ws.load[c] + m[1, k] * ws.load[c + 1] + m[2, k] * ws.load[c + 2]
    _respond(dyn, ws, force, gamma, a, lam)
    for r in range(dyn.system.held, lam.shape[0]):
        lam[r] = dyn.pushed[r]
    if dyn.system.friction.shape[0] > 0:
        power += _add_friction(dyn, ws, v, force, a, lam)
    for n in range(dyn.system.driven.shape[0]):
        power -= lam[dyn.system.driven[n, 0]] * scratch.drive[dyn.system.driven[n, 1], 1]
    return power


@internal
def move(q, way):
    """Move q (3 + 7 n,) by way (3 + 6 n,): places, and small rotations in body axes; e stays a unit."""
    for b in range(1, (q.shape[0] + 4) // 7):
        c = 7 * b - 4
        d = 6 * b - 3
        e0, e1, e2, e3 = q[c + 3], q[c + 4], q[c + 5], q[c + 6]
        x, y, z = 0.5 * way[d + 3], 0.5 * way[d + 4], 0.5 * way[d + 5]
        for k in range(3):
            q[c + k] += way[d + k]
        q[c + 3] = e0 - e1 * x - e2 * y - e3 * z
        q[c + 4] = e1 + e0 * x + e2 * z - e3 * y
        q[c + 5] = e2 + e0 * y + e3 * x - e1 * z
        q[c + 6] = e3 + e0 * z + e1 * y - e2 * x
        make_unit(q, c + 3)


@apart
def project(dyn, scratch, t, state, passes):
    """See formulation.py of the plane."""
    ws = scratch.ws
    env = dyn.envelope
    side = dyn.factors.side
    change = scratch.change
    nu = ws.right[1]
    largest = 0.0
    for b in range(1, dyn.system.mass.shape[0]):
        largest = max(largest, make_unit(state[0], 7 * b - 1))
    scratch.report[1] = largest
    scratch.report[2] = 0.0
    if env.rows.shape[0] == 0:
        return
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    evaluate_nu(dyn.system, scratch.drive, nu)
    for step in range(passes):
        evaluate_position(dyn.system, state[0], scratch.drive, ws)
        _to_body_axes(dyn, ws)
        factor(env, dyn.factors, ws.jac, dyn.inverse)
        for r in range(env.rows.shape[0]):
            side[0, r] = ws.phi[env.rows[r]]
            side[1, r] = -nu[env.rows[r]]
        for c in range(change.shape[1]):
            change[0, c] = 0.0
            change[1, c] = 0.0
        for e in range(env.arm.shape[0]):
            d = 6 * env.arm[e, 2] - 3
            for k in range(6):
                side[1, env.arm[e, 0]] += ws.jac[env.rows[env.arm[e, 0]], env.arm[e, 1] + k] * state[1, d + k]
        solve(env, dyn.factors, 2)
        for e in range(env.arm.shape[0]):
            r = env.arm[e, 0]
            d = 6 * env.arm[e, 2] - 3
            for k in range(6):
                push = dyn.inverse[d + k] * ws.jac[env.rows[r], env.arm[e, 1] + k]
                change[0, d + k] -= push * side[0, r]
                change[1, d + k] -= push * side[1, r]
        largest = 0.0
        for c in range(3, change.shape[1]):
            state[1, c] += change[1, c]
            part = abs(change[0, c]) * dyn.per_size[c]
            if not part <= largest:
                largest = part
        move(state[0], change[0])
        scratch.report[2] = largest
        if step == 0:
            scratch.report[1] = max(scratch.report[1], largest)


@internal
def rates(dyn, q, v, out):
    """See formulation.py of the plane."""
    for b in range(1, dyn.system.mass.shape[0]):
        c = 7 * b - 4
        d = 6 * b - 3
        for k in range(3):
            out[c + k] = v[d + k]
        for k in range(3, 7):
            out[c + k] = 0.0
        add_turning(q[c + 3], q[c + 4], q[c + 5], q[c + 6], v[d + 3], v[d + 4], v[d + 5], out, c + 3)


@internal
def bends(dyn, state, dy, out):
    """See formulation.py of the plane: e'' = e (0, w') / 2 + e' (0, w) / 2."""
    rates(dyn, state[0], dy[1], out)
    for b in range(1, dyn.system.mass.shape[0]):
        c = 7 * b - 1
        d = 6 * b
        w = state[1]
        add_turning(dy[0, c], dy[0, c + 1], dy[0, c + 2], dy[0, c + 3], w[d], w[d + 1], w[d + 2], out, c)


@internal
def speeds(dyn, q, rate):
    """See formulation.py of the plane: w = 2 e^-1 e', less what lengthens e."""
    for b in range(1, dyn.system.mass.shape[0]):
        c = 7 * b - 4
        d = 6 * b - 3
        e0, e1, e2, e3 = q[c + 3], q[c + 4], q[c + 5], q[c + 6]
        x, y, z = rate[c], rate[c + 1], rate[c + 2]
        r0, r1, r2, r3 = rate[c + 3], rate[c + 4], rate[c + 5], rate[c + 6]
        twice = 2.0 / (e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3)
        rate[d], rate[d + 1], rate[d + 2] = x, y, z
        rate[d + 3] = twice * (e0 * r1 - e1 * r0 - e2 * r3 + e3 * r2)
        rate[d + 4] = twice * (e0 * r2 - e2 * r0 - e3 * r1 + e1 * r3)
        rate[d + 5] = twice * (e0 * r3 - e3 * r0 - e1 * r2 + e2 * r1)
    for c in range(6 * dyn.system.mass.shape[0] - 3, rate.shape[0]):
        rate[c] = 0.0


@internal
def _count_turns(dyn, scratch, t, state):
    """Fill scratch.ws.turn at a state (2, 3 + 7 n), with whole turns nearest to the last count led on by both rates."""
    ws = scratch.ws
    if ws.turn.shape[0] == 0:
        return
    evaluate_position(dyn.system, state[0], scratch.drive, ws)
    _to_world(dyn, ws, state[1])
    turn_vectors(dyn.system, dyn.world, ws)
    bend_turns(dyn.system, ws, ws.right[1])
    for n in range(ws.turn.shape[0]):
        led = ws.guess[n] + 0.5 * (t - dyn.counted[0]) * (dyn.counted[1 + n] + ws.turn_rate[n])
        ws.turn[n] += TURN * math.floor((led - ws.turn[n]) / TURN + 0.5)


@internal
def settle(dyn, scratch, t, state, fresh):
    """Count turns from the accepted state on; returns whether other rows should be looked for."""
    _count_turns(dyn, scratch, t, state)
    dyn.counted[0] = t
    for n in range(scratch.ws.guess.shape[0]):
        scratch.ws.guess[n] = scratch.ws.turn[n]
        dyn.counted[1 + n] = scratch.ws.turn_rate[n]
    return scratch.report[0] < dyn.limit[0]


@internal
def record_all(dyn, scratch, out, k, t, work):
    """Write output k from scratch.state, with its turns."""
    record_output(dyn, scratch, out, k, work)
    _count_turns(dyn, scratch, t, scratch.state)
    for n in range(scratch.ws.turn.shape[0]):
        dyn.turns[k, n] = scratch.ws.turn[n]
    return True


@internal
def record_here(dyn, scratch, state, out):
    """Write the next output from the state itself, with its turns."""
    k = state.count[NEXT]
    _count_turns(dyn, scratch, state.clock[TIME], state.y)
    for n in range(scratch.ws.turn.shape[0]):
        dyn.turns[k, n] = scratch.ws.turn[n]
    for c in range(state.y.shape[1]):
        out.y[k, 0, c] = state.y[0, c]
        out.y[k, 1, c] = state.y[1, c]
        out.a[k, c] = state.dy[1, c]
    for r in range(state.lam.shape[0]):
        out.lam[k, r] = state.lam[r]
    out.work[k] = state.clock[WORK]
    out.margin[k] = scratch.report[0]
    state.count[NEXT] = k + 1


@internal
def measure(dyn, scratch, t, q):
    """Fill scratch.ws.phi, and J in body axes, at q (3 + 7 n,) and t (s)."""
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    evaluate_position(dyn.system, q, scratch.drive, scratch.ws)
    _to_body_axes(dyn, scratch.ws)


@internal
def along(dyn, scratch, row, u):
    """See formulation.py of the plane."""
    return along_row(dyn.system, scratch.ws, row, u)


@internal
def push(dyn, scratch, row, size, force):
    """See formulation.py of the plane."""
    push_row(dyn.system, scratch.ws, row, size, force)


@internal
def respond(dyn, scratch, force, moving, a, lam):
    """See formulation.py of the plane; gamma is spent."""
    gamma = scratch.ws.right[0]
    for r in range(gamma.shape[0]):
        gamma[r] *= moving
    _respond(dyn, scratch.ws, force, gamma, a, lam)


@inlined
def _without_contacts(dyn, contacts):
    return dyn


add_formulation(
    SpaceDynamics,
    measure=measure,
    measure_gaps=measure,
    along=along,
    push=push,
    respond=respond,
    without_contacts=_without_contacts,
    accelerate=accelerate,
    project=project,
    rates=rates,
    bends=bends,
    speeds=speeds,
    settle=settle,
    record=record_all,
    record_all=record_all,
    record_here=record_here,
)
