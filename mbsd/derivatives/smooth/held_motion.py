"""Compiled: accelerations and motions at states near a held motion, in independent coordinates.

    M_z dz'' = B^T (dQ + d(M g) - dM (B z'' + c)),   M_z = B^T M B        d: by a number of masses and forces alone

dQ is the central difference of forces at two values of their numbers. Source: Haug 1989, ch. 3.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.compiling.jit import internal, kernel
from mbsd.dynamics.independent.equations import accelerate, evaluate, place_all, settle
from mbsd.equations.loads import apply_elements
from mbsd.kinematics.groups.carried import BASE, NEAR, THETA, X, Y
from mbsd.kinematics.groups.cases import angle_of

FIRST = 3
"""Entries of a state before its coordinates."""


class Held(NamedTuple):
    """A motion at T times as its forces see it."""

    rate: Any
    """(T, nb, 3 (C + 1)) as EmbeddingScratch has it; so is cos_sin."""
    cos_sin: Any
    pose: Any
    """(T, 2, 3 nb) places and velocities."""


@internal
def hold(scratch, rates, held, k):
    """Keep what was evaluated last."""
    place_all(scratch, rates, False, held.pose[k], scratch.force)
    for b in range(scratch.rate.shape[0]):
        for c in range(scratch.rate.shape[1]):
            held.rate[k, b, c] = scratch.rate[b, c]
        for c in range(2):
            held.cos_sin[k, b, c] = scratch.cos_sin[b, c]


@kernel
def rates_beside(dyn, scratch, t, states, held, sensitivity, out):
    """Fill out (T, S, f) with z'' at states (T, S, 2, 3 + f) and t (T,), the first of each time that of the motion.

    Poses are predicted from there, time by time; ``held`` keeps them. sensitivity (1,) takes the largest rate of a body
    for one unit of a coordinate. Returns at how many times all states had a clear pose.
    """
    rates = scratch.stages[0, 1]
    for k in range(states.shape[0]):
        for s in range(states.shape[1]):
            power = accelerate(dyn, scratch, t[k], states[k, s], rates, scratch.multipliers)
            if power != power:
                return k
            for i in range(out.shape[2]):
                out[k, s, i] = rates[FIRST + i]
            if s == 0:
                hold(scratch, rates, held, k)
                settle(dyn, scratch, t[k], states[k, s], True)
                sensitivity[0] = max(sensitivity[0], scratch.watch[0])
    return states.shape[0]


@internal
def stand_beside(dyn, scratch, t, q, z):
    """Predict poses from q (3 nb,), whose coordinates are z (3 + f,), at t (s)."""
    for b in range(scratch.base.shape[0]):
        for c in range(scratch.base.shape[1]):
            scratch.base[b, c] = 0.0
        scratch.base[b, THETA] = q[3 * b + 2]
    last = scratch.coordinate.shape[0] - 1
    for j in range(last + 1):
        scratch.coordinate[j, BASE] = z[FIRST + j] if j < z.shape[0] - FIRST else t
    for e in range(dyn.number.shape[0]):
        dyn.number[e, NEAR] = 1.0


@kernel
def motions_beside(dyn, scratch, t, q, z, states, forces, y, a):
    """Fill y (R, 2, 3 nb), and with ``forces`` a (R, 3 nb), with motions of bodies at states (R, 2, 3 + f) and t (R,).

    They are near poses q (R, 3 nb) of the motion, whose coordinates are z (R, 3 + f). Returns at how many times they
    had a clear pose.
    """
    rates = scratch.stages[0, 1]
    for k in range(states.shape[0]):
        stand_beside(dyn, scratch, t[k], q[k], z[k])
        power = evaluate(dyn, scratch, t[k], states[k], rates, forces)
        if power != power:
            return k
        place_all(scratch, rates, forces, y[k], a[k])
    return states.shape[0]


@kernel
def bends_beside(dyn, scratch, t, q, z, states, scale, far, out):
    """Fill out (R, f) with z'' at states (R, 2, 3 + f) and t (R,) near poses q (R, 3 nb), as motions_beside.

    far (1,) takes how far bodies go from there at most, in sizes ``scale`` (3 nb,).
    """
    rates = scratch.stages[0, 1]
    body = scratch.body
    for k in range(states.shape[0]):
        stand_beside(dyn, scratch, t[k], q[k], z[k])
        power = evaluate(dyn, scratch, t[k], states[k], rates, True)
        if power != power:
            return k
        for i in range(out.shape[1]):
            out[k, i] = rates[FIRST + i]
        for b in range(1, body.shape[0]):
            c = 3 * b
            angle = angle_of(body, scratch.base, scratch.coordinate, b)
            far[0] = max(far[0], abs(body[b, X] - q[k, c]) / scale[c], abs(body[b, Y] - q[k, c + 1]) / scale[c + 1])
            far[0] = max(far[0], abs(angle - q[k, c + 2]) / scale[c + 2])
    return states.shape[0]


class ForcesBeside(NamedTuple):
    """L numbers, of which F change forces."""

    inertia: Any
    """(L, 3 nb) by how much M changes with each, as ``weight``."""
    weight: Any
    which: Any
    """(F,) numbers that change forces."""
    per: Any
    """(F,) 1 / (2 h) of their differences."""
    place: Any
    """(F, 2, e, 6) Loads.place on both sides, as ``number``."""
    number: Any


@internal
def factor(rate, inertia, mass):
    """Fill mass (f, f), lower, with the Cholesky factor of M_z; returns whether it is positive."""
    for i in range(mass.shape[0]):
        for j in range(i + 1):
            value = 0.0
            for b in range(1, rate.shape[0]):
                for c in range(3):
                    value += inertia[3 * b + c] * rate[b, 3 * i + c] * rate[b, 3 * j + c]
            for g in range(j):
                value -= mass[i, g] * mass[j, g]
            if i != j:
                mass[i, j] = value / mass[j, j]
            elif value > 0.0:
                mass[i, i] = math.sqrt(value)
            else:
                return False
    return True


@internal
def accelerate_by(rate, load, mass, out):
    """Fill out (f,) with M_z^-1 B^T load, ``mass`` as ``factor`` leaves it."""
    count = mass.shape[0]
    for i in range(count):
        value = 0.0
        for b in range(1, rate.shape[0]):
            for c in range(3):
                value += rate[b, 3 * i + c] * load[3 * b + c]
        for g in range(i):
            value -= mass[i, g] * out[g]
        out[i] = value / mass[i, i]
    for i in range(count - 1, -1, -1):
        for g in range(i + 1, count):
            out[i] -= mass[g, i] * out[g]
        out[i] /= mass[i, i]


@internal
def slope_of_force(loads, laws, per, place, number, t, q, v, cos_sin, load, force):
    """Fill force (3 nb,) with the difference of forces on both sides of a number, by ``per``; load is scratch."""
    for c in range(load.shape[0]):
        force[c] = 0.0
    for side in range(2):
        for c in range(load.shape[0]):
            load[c] = 0.0
        apply_elements(loads.element, place[side], loads.term, number[side], laws, loads.law, t, q, v, cos_sin, load)
        weight = per if side == 1 else -per
        for c in range(load.shape[0]):
            force[c] += weight * load[c]


@kernel
def slopes_of_forces(loads, laws, inertia, beside, t, held, rates, force, load, a, mass, out):
    """Fill out (L, T, f) with how z'' changes at t (T,) of a motion with z'' ``rates`` (T, S, f).

    It is ``held`` as rates_beside does; ``inertia`` (3 nb,) is its own. force, load, a (3 nb,) and mass (f, f) are
    scratch. Returns at how many times M_z was positive.
    """
    last = held.rate.shape[2] - 3
    for k in range(t.shape[0]):
        rate = held.rate[k]
        if not factor(rate, inertia, mass):
            return k
        for b in range(rate.shape[0]):
            for c in range(3):
                value = rate[b, last + c]
                for j in range(out.shape[2]):
                    value += rate[b, 3 * j + c] * rates[k, 0, j]
                a[3 * b + c] = value
        pushing = 0
        for p in range(out.shape[0]):
            if pushing < beside.which.shape[0] and beside.which[pushing] == p:
                slope_of_force(
                    loads, laws, beside.per[pushing], beside.place[pushing], beside.number[pushing], t[k],
                    held.pose[k, 0], held.pose[k, 1], held.cos_sin[k], load, force,
                )  # fmt: skip
                pushing += 1
            else:
                for c in range(load.shape[0]):
                    force[c] = 0.0
            for c in range(load.shape[0]):
                force[c] += beside.weight[p, c] - beside.inertia[p, c] * a[c]
            accelerate_by(rate, force, mass, out[p, k])
    return t.shape[0]
