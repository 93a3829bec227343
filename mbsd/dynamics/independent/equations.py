"""Accelerations of the independent coordinates, and what an integrator needs beside them.

    M_z = B^T M B,   M_z z'' = B^T (Q - M c)           by Cholesky's factors
    power of loads and drivers = v^T (M a - M g)       where drivers are; else that of the loads themselves

Where a group or block has no clear pose the power is not a number, and the step is taken again with another length.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, inlined, internal, kernel, lazy, merged
from mbsd.dynamics.independent.arrays import LIMIT, SENSITIVITY
from mbsd.dynamics.independent.bridge import bridge
from mbsd.dynamics.independent.groups import embed_groups
from mbsd.dynamics.independent.places import KEPT_Q, KEPT_SIZE, Q
from mbsd.equations.laws import evaluate_laws
from mbsd.equations.loads import apply_loads
from mbsd.kinematics.groups.carrying.branch import WIDE, angle_of
from mbsd.kinematics.groups.carrying.columns import BASE, BEND, COS, NEAR, SIN, SINE, SPEED, THETA, TURNS, VALUE, X, Y
from mbsd.kinematics.groups.carrying.rates import SOLVED

FLOOR = 1e-14
"""Part of its diagonal that elimination must leave of M_z."""


@inlined
def place_bodies(loaded, body, rate, base, coordinate, angles, q, v, cos_sin):
    """Poses and velocities of the loaded bodies as forces read them; angles only where ``angles`` says so."""
    columns = coordinate.shape[0] - 1
    for b in loaded:
        q[3 * b] = body[b, X]
        q[3 * b + 1] = body[b, Y]
        if angles:
            q[3 * b + 2] = angle_of(body, base, coordinate, b)
        cos_sin[b, 0] = body[b, COS]
        cos_sin[b, 1] = body[b, SIN]
        for c in range(3):
            speed = 0.0
            for j in range(columns):
                speed += rate[b, 3 * j + c] * coordinate[j, SPEED]
            v[3 * b + c] = speed


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
    status = embed_groups(
        dyn.group,
        dyn.number,
        dyn.block,
        dyn.block_number,
        dyn.numbers,
        scratch.block_work,
        scratch.body,
        rate,
        scratch.base,
        coordinate,
        drive,
        dyn.gravity,
        scratch.sums,
    )
    if status != SOLVED and dyn.block[KEPT_SIZE] == 0:
        status = bridge(
            dyn.laws,
            dyn.group,
            dyn.number,
            dyn.block,
            dyn.block_number,
            dyn.numbers,
            scratch.block_work,
            dyn.gravity,
            scratch.body,
            rate,
            scratch.base,
            coordinate,
            drive,
            scratch.sums,
            scratch.joined_body,
            scratch.joined_rate,
            t,
        )
    if status != SOLVED:
        power = math.nan
    elif forces:
        if dyn.loads.total > 0:
            for b in dyn.loaded:
                force[3 * b] = 0.0
                force[3 * b + 1] = 0.0
                force[3 * b + 2] = 0.0
            place_bodies(
                dyn.loaded,
                scratch.body,
                rate,
                scratch.base,
                coordinate,
                dyn.angles,
                scratch.q,
                scratch.v,
                scratch.cos_sin,
            )
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
    """out (2, 3 + f) = d(state)/dt; returns the power of loads and drivers (W)."""
    for c in range(3, state.shape[1]):
        out[0, c] = state[1, c]
    return accelerate(dyn, scratch, t, state, out[1], lam)


@apart
def keep(body, rate, base, coordinate, number, block, work, size, per_size, watch, t):
    """Predict from the pose evaluated last; watch[0] takes the largest rate of a body for one unit of a coordinate."""
    last = coordinate.shape[0] - 1
    largest = 0.0
    for b in range(1, body.shape[0]):
        base[b, THETA] = angle_of(body, base, coordinate, b)
    for b in range(1, body.shape[0]):
        base[b, BEND] = rate[b, 3 * last + 2]
        for j in range(last):
            base[b, TURNS + j] = rate[b, 3 * j + 2]
        for j in range(size.shape[0]):
            for c in range(3):
                largest = max(largest, abs(rate[b, 3 * j + c]) * per_size[3 * b + c] * size[j])
    for j in range(last):
        coordinate[j, BASE] = coordinate[j, VALUE]
    coordinate[last, BASE] = t
    for e in range(number.shape[0]):
        number[e, NEAR] = 1.0 if number[e, SINE] < WIDE else 0.0
    for i in range(block[KEPT_SIZE]):
        work[block[KEPT_Q] + i] = work[block[Q] + i]
    watch[SENSITIVITY] = largest


@inlined
def settle(dyn, scratch, t, state, fresh):
    """Take a state, ``fresh`` if it was the last to be evaluated, as the one to predict from.

    Returns whether another choice of coordinates may be better.
    """
    if not fresh:
        derivative(dyn, scratch, t, state, scratch.stages[0], scratch.multipliers)
    keep(
        scratch.body,
        scratch.rate,
        scratch.base,
        scratch.coordinate,
        dyn.number,
        dyn.block,
        scratch.block_work,
        dyn.size,
        dyn.per_size,
        scratch.watch,
        t,
    )
    return scratch.watch[SENSITIVITY] > scratch.watch[LIMIT]


@kernel
def look(dyn, scratch, t, state):
    """Evaluate a state, and predict from there; scratch.watch takes its sensitivity. Returns the power (W)."""
    power = derivative(dyn, scratch, t, state, scratch.stages[0], scratch.multipliers)
    settle(dyn, scratch, t, state, True)
    return power


@internal
def put(body, rate, base, coordinate, a, forces, poses, accelerations):
    """Poses and velocities (2, 3 nb) and, with ``forces``, accelerations (3 nb,) of the pose evaluated last.

    a (3 + f,) has its z''.
    """
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
    put(scratch.body, scratch.rate, scratch.base, scratch.coordinate, stage[1], True, out.y[k], out.a[k])
    return power


@kernel
def write_alone(dyn, scratch, t, state, stage, out, k):
    """``write`` for callers outside the compiled loops."""
    return write(dyn, scratch, t, state, stage, out, k)
