"""Compiled: the equations of a motion without friction in joints differentiated node by node, near the processor.

    J q' = -dPhi/dp,  Z q' = s;   J v' = -d(J v - nu),  Z v' = s';   M a' + J^T lam' = d(Q - M a - J^T lam),
    J a' = -d(J a - gamma)      =>   s'' = A (s, s') + B

along each coordinate of the basis Z, each of their rates, and each number. What free_tangents.py says in numpy.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from mbsd.compiling.jit import internal, kernel
from mbsd.derivatives.driven.differences import (
    accelerate,
    close_state,
    couple,
    difference,
    difference_of_speeds,
    factor_mass,
    push_back,
    set_beside,
    spread_out,
)
from mbsd.equations.assembly import tabulate_all
from mbsd.equations.loads import tabulate_loads


class Nodes(NamedTuple):
    """A motion at T nodes, and the inverse of [J; Z] there."""

    t: Any
    q: Any
    """(T, 3 nb), as v and a."""
    v: Any
    a: Any
    lam: Any
    """(T, m)"""
    drives: Any
    """(T, motions + 1, 3)"""
    fixed: Any
    """(T, n, r) columns of the inverse that belong to J in ``rows`` (r,)."""
    free: Any
    """(T, n, f) those of Z."""
    rows: Any
    reach: Any
    """(T,) as in ``displace``."""
    slots: Any
    """(T,) places among the R nodes of which tangents are asked, -1 of others."""


class Own(NamedTuple):
    """How the equations change with P numbers at the held motion."""

    position: Any
    """(P, T, m), as velocity and acceleration."""
    velocity: Any
    acceleration: Any
    load: Any
    """(P, T, 3 nb)"""
    moving: Any
    """(S,) the numbers that change places or speeds."""


class Scratch(NamedTuple):
    """For D = 2 f + S directions at one node."""

    still: Any
    """(3 nb,) zeros."""
    steps: Any
    """(D,)"""
    way_q: Any
    """(D + 1, 3 nb), as way_v and load: the last is of numbers that change neither places nor speeds."""
    way_v: Any
    load: Any
    bend: Any
    """(D + 1, m)"""
    open: Any
    """(m,)"""
    a: Any
    """(n,)"""
    mass: Any
    """(f + 1, f)"""
    coupled: Any
    """(f, r)"""
    first_q: Any
    """(2 f + 2 S, 3 nb) states beside the motion at its own speeds."""
    q: Any
    """(2 D, 3 nb), as v and force."""
    v: Any
    force: Any
    t: Any
    """(2 D,), as power."""
    power: Any
    drives: Any
    """(2 D, motions + 1, 3)"""
    phi: Any
    """(2 D, m), as gamma."""
    gamma: Any
    compact: Any
    """(2 D, m, 6)"""


class Made(NamedTuple):
    """s'' = A (s, s') + B at T nodes; the motion's changes with coordinates of the basis, their rates, and numbers."""

    matrix: Any
    """(T, f, 2 f) A."""
    right: Any
    """(T, f, P) B."""
    q: Any
    """(2 f + P, R, 3 nb) at R nodes that are asked for, as v and a."""
    v: Any
    a: Any
    lam: Any
    """(2 f + P, R, m)"""


@internal
def _begin_node(nodes, k, own, scratch):
    """Fill the directions of places at node k, and what states beside it share."""
    f = nodes.free.shape[2]
    for i in range(f):
        for c in range(nodes.q.shape[1]):
            way = nodes.free[k, c - 3, i] if c > 2 else 0.0
            scratch.way_q[i, c] = way
            scratch.way_v[f + i, c] = way
    for i in range(own.moving.shape[0]):
        close_state(nodes.fixed[k], nodes.rows, own.position[own.moving[i], k], scratch.way_q[2 * f + i])
    for s in range(scratch.t.shape[0]):
        scratch.t[s] = nodes.t[k]
        for j in range(nodes.drives.shape[1]):
            for c in range(3):
                scratch.drives[s, j, c] = nodes.drives[k, j, c]


@kernel
def differentiate(system, loads, laws, ws, nodes, own, inertia, per_size, per_speed, scratch, made):
    """Fill ``made`` for a mechanism without friction.

    ``inertia`` (n,); ``per_size`` (3 nb,) and ``per_speed`` as in ``displace``.
    """
    reach = nodes.reach
    slots = nodes.slots
    way_q, way_v, bend, load, steps = scratch.way_q, scratch.way_v, scratch.bend, scratch.load, scratch.steps
    near_v, jac, gamma, force = scratch.v, scratch.compact, scratch.gamma, scratch.force
    f = nodes.free.shape[2]
    some = own.moving.shape[0]
    last = 2 * f + some
    width = nodes.q.shape[1]
    for k in range(nodes.q.shape[0]):
        q, v, a, lam, fixed, free = nodes.q[k], nodes.v[k], nodes.a[k], nodes.lam[k], nodes.fixed[k], nodes.free[k]
        _begin_node(nodes, k, own, scratch)
        # v' that goes with q', of coordinates and of numbers
        count = f + some
        for i in range(count):
            d = i if i < f else i + f
            steps[i] = set_beside(
                q, v, way_q[d], scratch.still, per_size, per_speed, reach[k],
                scratch.first_q[i], scratch.first_q[count + i], near_v[i], near_v[count + i],
            )  # fmt: skip
        tabulate_all(system, scratch.drives, scratch.first_q, near_v, ws, scratch.phi, jac, gamma)
        for i in range(count):
            d = i if i < f else i + f
            j = count + i
            difference_of_speeds(system.row_body, 0.5 / steps[i], v, jac[i], jac[j], scratch.open)
            if i >= f:
                for r in range(lam.shape[0]):
                    scratch.open[r] += own.velocity[own.moving[i - f], k, r]
            close_state(fixed, nodes.rows, scratch.open, way_v[d])
        # what J a - gamma and Q - J^T lam change by with both
        for d in range(last):
            steps[d] = set_beside(
                q, v, way_q[d], way_v[d], per_size, per_speed, reach[k],
                scratch.q[d], scratch.q[last + d], near_v[d], near_v[last + d],
            )  # fmt: skip
        tabulate_all(system, scratch.drives, scratch.q, near_v, ws, scratch.phi, jac, gamma)
        if loads.total > 0:
            for s in range(2 * last):
                for c in range(width):
                    force[s, c] = 0.0
            tabulate_loads(system, loads, laws, scratch.t, scratch.q, near_v, ws, force, scratch.power)
        for d in range(last):
            j = last + d
            half = 0.5 / steps[d]
            for c in range(width):
                load[d, c] = half * (force[d, c] - force[j, c])
            difference(
                system.row_body, half, (near_v[d], jac[d], gamma[d]), (near_v[j], jac[j], gamma[j]), a, lam,
                scratch.open, bend[d], load[d],
            )  # fmt: skip
        factor_mass(free, inertia, scratch.mass)
        couple(fixed, free, inertia, scratch.coupled)
        number = 0
        for d in range(2 * f + own.load.shape[0]):
            at = d
            if d >= 2 * f:
                p = d - 2 * f
                at = last
                if number < some and own.moving[number] == p:
                    at = 2 * f + number
                    number += 1
                for r in range(lam.shape[0]):
                    bend[at, r] = own.acceleration[p, k, r] + (bend[at, r] if at < last else 0.0)
                for c in range(width):
                    load[at, c] = own.load[p, k, c] + (load[at, c] if at < last else 0.0)
            accelerate(free, scratch.coupled, nodes.rows, bend[at], load[at], scratch.mass)
            for i in range(f):
                if d < 2 * f:
                    made.matrix[k, i, d] = scratch.mass[f, i]
                else:
                    made.right[k, i, d - 2 * f] = scratch.mass[f, i]
            if slots[k] >= 0:
                spread_out(fixed, free, nodes.rows, bend[at], scratch.mass, scratch.a)
                for c in range(3, width):
                    made.q[d, slots[k], c] = way_q[at, c]
                    made.v[d, slots[k], c] = way_v[at, c]
                    made.a[d, slots[k], c] = scratch.a[c - 3]
                push_back(fixed, inertia, nodes.rows, load[at], scratch.a, made.lam[d, slots[k]])
