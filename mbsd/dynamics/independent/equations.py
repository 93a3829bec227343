"""Accelerations of the independent coordinates, and the outputs in reference coordinates that follow from them.

    M_z = B^T M B,   M_z z'' = B^T (Q - M c)           by Cholesky's factors
    power of loads and drivers = v^T (M a - M g)       where drivers are; else that of the loads themselves

Where a group or block has no clear pose the power is not a number, and the step is taken again with another length.
An output at such a pose is the middle of the quintic through q, q', q'' at two poses a little before and after it, H
seconds apart:

    q   = (q0 + q1) / 2 + 5/32 H (q0' - q1') + 1/64 H^2 (q0'' + q1'')
    q'  = 15/8 (q1 - q0) / H - 7/16 (q0' + q1') + 1/32 H (q1'' - q0'')
    q'' = 3/2 (q1' - q0') / H - (q0'' + q1'') / 4

Multipliers are found afterwards (reference/multipliers.py).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, inlined, internal, kernel, lazy, merged
from mbsd.dynamics.independent.arrays import LIMIT, SENSITIVITY
from mbsd.dynamics.independent.block import KEPT_Q, KEPT_SIZE, Q
from mbsd.dynamics.independent.groups import bridge, embed_groups
from mbsd.dynamics.state import NEXT, TIME, WORK
from mbsd.equations.laws import evaluate_laws
from mbsd.equations.loads import apply_loads
from mbsd.kinematics.groups.carried import BASE, BEND, COS, NEAR, SIN, SINE, SOLVED, SPEED, THETA, TURNS, VALUE, X, Y
from mbsd.kinematics.groups.cases import WIDE, angle_of

FLOOR = 1e-14
"""Part of its diagonal that elimination must leave of M_z."""


@inlined
def place_bodies(dyn, scratch):
    """Fill poses and velocities of the loaded bodies as forces read them; angles only where ``dyn.angles`` says so."""
    body = scratch.body
    coordinate = scratch.coordinate
    q = scratch.q
    columns = coordinate.shape[0] - 1
    for b in dyn.loaded:
        q[3 * b] = body[b, X]
        q[3 * b + 1] = body[b, Y]
        if dyn.angles:
            q[3 * b + 2] = angle_of(body, scratch.base, coordinate, b)
        scratch.cos_sin[b, 0] = body[b, COS]
        scratch.cos_sin[b, 1] = body[b, SIN]
        for c in range(3):
            speed = 0.0
            for j in range(columns):
                speed += scratch.rate[b, 3 * j + c] * coordinate[j, SPEED]
            scratch.v[3 * b + c] = speed


@lazy(bool)
def reduced(rate, inertia, weight, force, mass, a):
    """a (3 + f,) from 3 on takes z'' of several coordinates; returns whether M_z is positive."""
    count = mass.shape[0]
    last = rate.shape[1] - 3
    for i in range(count):
        a[3 + i] = 0.0
        for j in range(i + 1):
            mass[i, j] = 0.0
    for b in range(1, rate.shape[0]):
        for c in range(3):
            m = inertia[3 * b + c]
            push = weight[3 * b + c] + force[3 * b + c] - m * rate[b, last + c]
            for i in range(count):
                share = rate[b, 3 * i + c]
                a[3 + i] += share * push
                for j in range(i + 1):
                    mass[i, j] += m * share * rate[b, 3 * j + c]
    for i in range(count):
        for j in range(i + 1):
            value = mass[i, j]
            for k in range(j):
                value -= mass[i, k] * mass[j, k]
            if i == j:
                if not value > FLOOR * mass[i, i]:
                    return False
                mass[i, i] = math.sqrt(value)
            else:
                mass[i, j] = value / mass[j, j]
        for k in range(i):
            a[3 + i] -= mass[i, k] * a[3 + k]
        a[3 + i] /= mass[i, i]
    for i in range(count - 1, -1, -1):
        for k in range(i + 1, count):
            a[3 + i] -= mass[k, i] * a[3 + k]
        a[3 + i] /= mass[i, i]
    return True


@lazy(float)
def power_of_all(rate, inertia, weight, coordinate, a):
    """Power of loads and drivers (W), from what the bodies gain."""
    last = rate.shape[1] - 3
    power = 0.0
    for b in range(1, rate.shape[0]):
        for c in range(3):
            value = rate[b, last + c]
            for j in range(a.shape[0] - 3):
                value += rate[b, 3 * j + c] * a[3 + j]
            speed = 0.0
            for j in range(coordinate.shape[0] - 1):
                speed += rate[b, 3 * j + c] * coordinate[j, SPEED]
            power += speed * (inertia[3 * b + c] * value - weight[3 * b + c])
    return power


@merged
def accelerate(dyn, scratch, t, state, a, lam):
    """Fill a (3 + f,) at a state (2, 3 + f) and time (s); returns the power of loads and drivers (W)."""
    return evaluate(dyn, scratch, t, state, a, True)


@merged
def evaluate(dyn, scratch, t, state, a, forces):
    """Poses and rates at a state and time; a as ``accelerate`` fills it only where ``forces`` are asked for.

    Returns the power of loads and drivers (W), 0 without forces.
    """
    coordinate = scratch.coordinate
    rate = scratch.rate
    force = scratch.force
    drive = scratch.drive
    count = scratch.mass.shape[0]
    for j in range(count):
        coordinate[j, VALUE] = state[0, 3 + j]
        coordinate[j, SPEED] = state[1, 3 + j]
    last = coordinate.shape[0] - 1
    coordinate[last, VALUE] = t - coordinate[last, BASE]
    if last > count:
        coordinate[count, VALUE] = t
        evaluate_laws(dyn.laws, drive.shape[0], t, drive)
    power = 0.0
    status = embed_groups(dyn, scratch)
    if status != SOLVED and dyn.block[KEPT_SIZE] == 0:
        status = bridge(dyn, scratch, t)
    if status != SOLVED:
        power = math.nan
    elif forces:
        if dyn.loads.total > 0:
            for b in dyn.loaded:
                force[3 * b] = 0.0
                force[3 * b + 1] = 0.0
                force[3 * b + 2] = 0.0
            place_bodies(dyn, scratch)
            power = apply_loads(dyn.loads, dyn.laws, t, scratch.q, scratch.v, scratch.cos_sin, force)
        if count == 1 and last == 1:
            push = scratch.sums[1]
            for b in dyn.loaded:
                push += rate[b, 0] * force[3 * b] + rate[b, 1] * force[3 * b + 1] + rate[b, 2] * force[3 * b + 2]
            a[3] = push / scratch.sums[0]
            if not scratch.sums[0] > 0.0:
                power = math.nan
        elif not reduced(rate, dyn.inertia, dyn.weight, force, scratch.mass, a):
            power = math.nan
        if last > count:
            power = power_of_all(rate, dyn.inertia, dyn.weight, coordinate, a) + (power - power)  # keeps nan
    return power


@apart
def derivative(dyn, scratch, t, state, out, lam):
    """Fill out (2, 3 + f) with d(state)/dt; returns the power of loads and drivers (W)."""
    for c in range(3, state.shape[1]):
        out[0, c] = state[1, c]
    return accelerate(dyn, scratch, t, state, out[1], lam)


@apart
def keep(dyn, scratch, t):
    """Predict from the pose evaluated last; watch[0] takes the largest rate of a body for one unit of a coordinate."""
    body = scratch.body
    rate = scratch.rate
    base = scratch.base
    coordinate = scratch.coordinate
    number = dyn.number
    block = dyn.block
    work = scratch.block_work
    last = coordinate.shape[0] - 1
    largest = 0.0
    for b in range(1, body.shape[0]):
        base[b, THETA] = angle_of(body, base, coordinate, b)
    for b in range(1, body.shape[0]):
        base[b, BEND] = rate[b, 3 * last + 2]
        for j in range(last):
            base[b, TURNS + j] = rate[b, 3 * j + 2]
        for j in range(dyn.size.shape[0]):
            for c in range(3):
                largest = max(largest, abs(rate[b, 3 * j + c]) * dyn.per_size[3 * b + c] * dyn.size[j])
    for j in range(last):
        coordinate[j, BASE] = coordinate[j, VALUE]
    coordinate[last, BASE] = t
    for e in range(number.shape[0]):
        number[e, NEAR] = 1.0 if number[e, SINE] < WIDE else 0.0
    for i in range(block[KEPT_SIZE]):
        work[block[KEPT_Q] + i] = work[block[Q] + i]
    scratch.watch[SENSITIVITY] = largest


@inlined
def settle(dyn, scratch, t, state, fresh):
    """Take a state, ``fresh`` if it was the last to be evaluated, as the one to predict from.

    Returns whether another choice of coordinates may be better.
    """
    if not fresh:
        derivative(dyn, scratch, t, state, scratch.stages[0], scratch.multipliers)
    keep(dyn, scratch, t)
    return scratch.watch[SENSITIVITY] > scratch.watch[LIMIT]


@kernel
def look(dyn, scratch, t, state):
    """Evaluate a state, and predict from there; scratch.watch takes its sensitivity. Returns the power (W)."""
    power = derivative(dyn, scratch, t, state, scratch.stages[0], scratch.multipliers)
    settle(dyn, scratch, t, state, True)
    return power


@internal
def place_all(scratch, a, forces, poses, accelerations):
    """Fill poses and velocities (2, 3 nb) and, with ``forces``, accelerations (3 nb,) of the pose evaluated last.

    a (3 + f,) has its z''.
    """
    body = scratch.body
    rate = scratch.rate
    base = scratch.base
    coordinate = scratch.coordinate
    last = coordinate.shape[0] - 1
    for b in range(1, body.shape[0]):
        poses[0, 3 * b] = body[b, X]
        poses[0, 3 * b + 1] = body[b, Y]
        poses[0, 3 * b + 2] = angle_of(body, base, coordinate, b)
        for c in range(3):
            v = 0.0
            for j in range(last):
                v += rate[b, 3 * j + c] * coordinate[j, SPEED]
            poses[1, 3 * b + c] = v
            if forces:
                bend = rate[b, 3 * last + c]
                for j in range(a.shape[0] - 3):
                    bend += rate[b, 3 * j + c] * a[3 + j]
                accelerations[3 * b + c] = bend


@inlined
def write(dyn, scratch, t, state, stage, out, k):
    """Output k in reference coordinates from a state; stage (2, 3 + f) takes its derivative."""
    power = derivative(dyn, scratch, t, state, stage, scratch.multipliers)
    place_all(scratch, stage[1], True, out.y[k], out.a[k])
    return power


@kernel
def write_alone(dyn, scratch, t, state, stage, out, k):
    """``write`` for callers outside the compiled loops."""
    return write(dyn, scratch, t, state, stage, out, k)


@inlined
def record(dyn, scratch, out, k, t, work):
    """Write output k from scratch.state at t (s); returns whether its pose is clear."""
    out.work[k] = work
    power = write(dyn, scratch, t, scratch.state, scratch.stages[0], out, k)
    return power + work == power + work


@inlined
def record_all(dyn, scratch, out, k, t, work):
    """``record`` with the evaluation in it: no arrays are handed over for each of many outputs."""
    a = scratch.stages[0, 1]
    forces = out.lam.shape[0] > 0
    out.work[k] = work
    power = evaluate(dyn, scratch, t, scratch.state, a, forces)
    place_all(scratch, a, forces, out.y[k], out.a[k])
    return power + work == power + work


@inlined
def keep_row(dyn, scratch, out, k):
    """Keep output k as the pose before an unclear one."""
    for c in range(scratch.before.shape[1]):
        scratch.before[0, c] = out.y[k, 0, c]
        scratch.before[1, c] = out.y[k, 1, c]
        scratch.before[2, c] = out.a[k, c]


@inlined
def join_rows(dyn, scratch, out, k, between):
    """Put output k in the middle between the pose kept and its own, ``between`` seconds later."""
    before = scratch.before
    for c in range(before.shape[1]):
        q = out.y[k, 0, c]
        v = out.y[k, 1, c]
        a = out.a[k, c]
        out.y[k, 0, c] = (
            0.5 * (before[0, c] + q)
            + 5.0 / 32.0 * between * (before[1, c] - v)
            + between * between / 64.0 * (before[2, c] + a)
        )
        out.y[k, 1, c] = (
            15.0 / 8.0 * (q - before[0, c]) / between
            - 7.0 / 16.0 * (before[1, c] + v)
            + between / 32.0 * (a - before[2, c])
        )
        out.a[k, c] = 1.5 * (v - before[1, c]) / between - 0.25 * (before[2, c] + a)


@apart
def record_here(dyn, scratch, state, out):
    """Write the next output from the state itself, which stands at its time."""
    k = state.count[NEXT]
    write(dyn, scratch, state.clock[TIME], state.y, scratch.stages[0], out, k)
    out.work[k] = state.clock[WORK]
    state.count[NEXT] = k + 1
