"""Relative coordinates of a spanning tree as a formulation of the compiled loop (mbsd/dynamics/formulation.py).

    M z'' + J^T lam = Q,   J z'' = gamma        z: rates of the joints of the tree

Rows are those of cut joints and drivers, evaluated in the world by the kernels of reference coordinates; terms that are
coordinates of the tree, such as a driven turn, are numbers instead. Forces act on bodies in the world, as there. An
output is a pose, with velocities and accelerations in the world; multipliers of all joints are found afterwards.

A projection moves the tree in the metric of its masses. Its second pass keeps the factors of the first, whose change is
of the size of a step's error.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from mbsd.compiling.jit import apart, internal, kernel
from mbsd.dynamics.formulation import add_formulation
from mbsd.dynamics.state import NEXT, TIME, WORK
from mbsd.equations.laws import evaluate_laws
from mbsd.spatial.dynamics.envelope import OWN, solve
from mbsd.spatial.dynamics.tree.arrays import COUNT, FIRST_Q, FIRST_Z, FREE, KIND, LEFT, MOTION, SPHERICAL
from mbsd.spatial.dynamics.tree.bodies import factor_tree, release, weigh
from mbsd.spatial.dynamics.tree.places import at_centre, place_tree
from mbsd.spatial.dynamics.tree.rows import answer_rows, factor_rows, hold_rows, measure_rates, renew_rows
from mbsd.spatial.equations.evaluation import evaluate_gamma, evaluate_nu, evaluate_rows
from mbsd.spatial.equations.forces import apply_forces
from mbsd.spatial.equations.vectors import add_turning, make_unit


class TreeDynamics(NamedTuple):
    """A mechanism in space as a spanning tree. Entries: three idle ones, then those of each joint."""

    system: Any
    """mbsd.spatial.equations.system.System of cut joints, drivers and forces."""
    laws: Any
    """mbsd.equations.laws.Laws: 1 .. drivers are the drivers' laws of time."""
    loads: Any
    """Forces that switch, of which there are none yet."""
    tree: Any
    """mbsd.spatial.dynamics.tree.arrays.Tree"""
    work: Any
    """mbsd.spatial.dynamics.tree.arrays.Work"""
    envelope: Any
    """mbsd.spatial.dynamics.envelope.Envelope"""
    factors: Any
    chosen: Any
    """(n,) pivots of the rows in use when they were chosen."""
    per_size: Any
    """(3 + nq,) what makes rates dimensionless: 1 / size of slides, 1 of turns."""
    pushed: Any
    """(m,) scratch: multipliers of forces."""
    limit: Any
    """(1,) part of a row below which other rows are looked for; 0: never."""
    turns: Any
    """(T, turns) counted angles at the outputs."""


@internal
def _measure(dyn, ws, q, v, drive):
    """Fill poses, columns, phi and J at coordinates q (3 + nq,), and motions at rates v (3 + nz,)."""
    tree = dyn.tree
    place_tree(tree, dyn.work, q, v, ws)
    if ws.phi.shape[0] + dyn.system.call.shape[0] > 0:
        evaluate_rows(dyn.system, dyn.work.pose, drive, ws)
        for n in range(tree.linear.shape[0]):
            row = tree.linear[n, 0]
            ws.phi[row] += tree.factor[n] * q[tree.linear[n, 2]]


@apart
def accelerate(dyn, scratch, t, state, a, lam):
    """See formulation.py of the plane; returns the power of forces and drivers (W)."""
    ws = scratch.ws
    work = dyn.work
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    _measure(dyn, ws, state[0], state[1], scratch.drive)
    power = 0.0
    for c in range(ws.load.shape[0]):
        ws.load[c] = 0.0
    if dyn.system.force.shape[0] + dyn.system.call.shape[0] > 0:
        power = apply_forces(dyn.system, dyn.laws, t, work.pose, work.rate, ws, ws.load, dyn.pushed)
    weigh(dyn.tree, work, dyn.system, ws, ws.load)
    factor_tree(dyn.tree, work, dyn.system, ws)
    if dyn.system.held > 0:
        gamma = ws.right[0]
        evaluate_gamma(dyn.system, work.rate, scratch.drive, ws, gamma)
        scratch.report[0] = factor_rows(dyn, ws)
        hold_rows(dyn, ws, gamma, lam)
        for n in range(dyn.system.driven.shape[0]):
            power -= lam[dyn.system.driven[n, 0]] * scratch.drive[dyn.system.driven[n, 1], 1]
    release(dyn.tree, work, 0, a)
    return power


@internal
def rates(dyn, q, v, out):
    """See formulation.py of the plane."""
    index = dyn.tree.index
    for b in range(1, index.shape[0]):
        kind = index[b, KIND]
        c = index[b, FIRST_Q]
        d = index[b, FIRST_Z]
        single = index[b, COUNT] - 3 if kind <= SPHERICAL else index[b, COUNT]
        for k in range(single):
            out[c + k] = v[d + k]
        if kind <= SPHERICAL:
            c += single
            d += single
            for k in range(4):
                out[c + k] = 0.0
            add_turning(q[c], q[c + 1], q[c + 2], q[c + 3], v[d], v[d + 1], v[d + 2], out, c)


@internal
def _shift(dyn, q, way, spare):
    """Move q (3 + nq,) by way (3 + nz,); Euler parameters stay units. ``spare`` (3 + nq,) is overwritten."""
    rates(dyn, q, way, spare)
    for c in range(3, q.shape[0]):
        q[c] += spare[c]


@internal
def _normalise_all(dyn, q):
    """Make all Euler parameters units; returns by how much one was none at most."""
    index = dyn.tree.index
    largest = 0.0
    for b in range(1, index.shape[0]):
        if index[b, KIND] <= SPHERICAL:
            c = index[b, FIRST_Q] + (3 if index[b, KIND] == FREE else 0)
            largest = max(largest, make_unit(q, c))
    return largest


@apart
def project(dyn, scratch, t, state, passes):
    """See formulation.py of the plane."""
    ws = scratch.ws
    work = dyn.work
    env = dyn.envelope
    change = scratch.change
    nu = ws.right[1]
    scratch.report[1] = _normalise_all(dyn, state[0])
    scratch.report[2] = 0.0
    if env.rows.shape[0] == 0:
        return
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    evaluate_nu(dyn.system, scratch.drive, nu)
    for step in range(passes):
        _measure(dyn, ws, state[0], state[1], scratch.drive)
        measure_rates(dyn, ws, state[1], nu, work.own[0])
        if step == 0:
            factor_tree(dyn.tree, work, dyn.system, ws)
            factor_rows(dyn, ws)
        for r in range(env.rows.shape[0]):
            dyn.factors.side[0, r] = ws.phi[env.rows[r]]
            dyn.factors.side[1, r] = work.own[0, env.rows[r]]
        solve(env, dyn.factors, 2)
        for side in range(2):
            for k in range(work.column.shape[0]):
                work.column[k, LEFT + side] = 0.0
            answer_rows(dyn, side, work.own[1])
            release(dyn.tree, work, side, change[side])
        largest = 0.0
        for c in range(3, change.shape[1]):
            state[1, c] += change[1, c]
            part = abs(change[0, c]) * dyn.per_size[c]
            if not part <= largest:
                largest = part
        _shift(dyn, state[0], change[0], change[1])
        _normalise_all(dyn, state[0])
        scratch.report[2] = largest
        if step == 0:
            scratch.report[1] = max(scratch.report[1], largest)


@apart
def settle(dyn, scratch, t, state, fresh):
    """Count turns from the accepted state on, and choose the rows in use anew where they come near to depend."""
    ws = scratch.ws
    narrow = scratch.report[0] < dyn.limit[0]
    if narrow or ws.turn.shape[0] > 0:
        _measure(dyn, ws, state[0], state[1], scratch.drive)
    for n in range(ws.guess.shape[0]):
        ws.guess[n] = ws.turn[n]
    if narrow:
        factor_tree(dyn.tree, dyn.work, dyn.system, ws)
        if renew_rows(dyn, ws):
            dyn.limit[0] = OWN
        else:
            dyn.limit[0] *= 0.1
    return False


@internal
def _write(dyn, scratch, state, out, k):
    """Write output k at a state whose accelerations were evaluated last."""
    work = dyn.work
    for c in range(3, work.pose.shape[0]):
        out.y[k, 0, c] = work.pose[c]
    for b in range(1, dyn.tree.index.shape[0]):
        c = 6 * b - 3
        at_centre(work.body, b, MOTION, out.a[k], c)
        for j in range(6):
            out.y[k, 1, c + j] = work.rate[c + j]
            out.a[k, c + j] += work.bend[c + j]
    for n in range(dyn.turns.shape[1]):
        at = dyn.tree.turns[n, 0]
        dyn.turns[k, n] = scratch.ws.turn[at] if dyn.tree.turns[n, 1] == 1 else state[0, at]
    out.margin[k] = scratch.report[0]


@apart
def record_all(dyn, scratch, out, k, t, work):
    """Write output k from scratch.state, projected first."""
    project(dyn, scratch, t, scratch.state, 2)
    power = accelerate(dyn, scratch, t, scratch.state, scratch.change[0], scratch.multipliers)
    _write(dyn, scratch, scratch.state, out, k)
    out.work[k] = work
    return power == power


@apart
def record_here(dyn, scratch, state, out):
    """Write the next output from the state itself."""
    k = state.count[NEXT]
    accelerate(dyn, scratch, state.clock[TIME], state.y, scratch.change[0], scratch.multipliers)
    _write(dyn, scratch, state.y, out, k)
    out.work[k] = state.clock[WORK]
    state.count[NEXT] = k + 1


@kernel
def begin(dyn, ws, q, v, drive):
    """Fill poses and columns at coordinates q (3 + nq,), and choose the rows in use; for callers in Python."""
    _measure(dyn, ws, q, v, drive)
    factor_tree(dyn.tree, dyn.work, dyn.system, ws)
    renew_rows(dyn, ws)


add_formulation(
    TreeDynamics,
    accelerate=accelerate,
    project=project,
    rates=rates,
    settle=settle,
    record=record_all,
    record_all=record_all,
    record_here=record_here,
)
