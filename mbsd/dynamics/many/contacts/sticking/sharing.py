"""How joints at rest share a friction that several of them could carry (events/laws/sharing.py, resting.py, compiled).

Of one freedom alone, where each joint takes the same part s of its limit. With the row G_1k of the compliance

    T_k = s sign(G_1k) L_k,      s = sum_k G_1k T_k / sum_k |G_1k| L_k

for forces T of any division: virtual work of the one motion. A division with more freedoms is a linear programme, which
is left to single simulations.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.bounds import AGREED, PASSES
from mbsd.dynamics.events.laws.sharing import SINGULAR
from mbsd.dynamics.many.contacts.arrays import (
    CLOSED,
    FORCE,
    FOUND,
    FRICTION,
    KIND,
    LIMIT,
    PREVIOUS,
    RESTING,
    ROW,
    UNSHARED,
    WAY,
)
from mbsd.dynamics.many.contacts.rows import hold_rows
from mbsd.dynamics.many.contacts.sticking.answers import answer_resting
from mbsd.equations.joint_friction import PIN, PRELOAD, SHAPE, SIZE, STATIC, normal_forces

UNDECIDED = -1.0
"""A part where it takes a linear programme."""


@internal
def limit_of(dyn, k, normal):
    """The largest friction (N, N m) of joint k with friction, at rest under normal forces (f,)."""
    number = dyn.loads.friction_number[k]
    lever = number[SIZE] if dyn.loads.friction[k, SHAPE] == PIN else 1.0
    return number[STATIC] * lever * (normal[k] + number[PRELOAD])


@internal
def _rank(contacts, flags):
    """Rank of the compliance of the rows in ``flags`` (c,): pivoted Cholesky, scaled to a diagonal of ones."""
    count = flags.shape[0]
    g = contacts.sticks.small
    for i in range(count):
        for j in range(count):
            if flags[i] != 0 and flags[j] != 0:
                own = max(contacts.compliance[i, i], 1e-300) * max(contacts.compliance[j, j], 1e-300)
                g[i, j] = contacts.compliance[i, j] / math.sqrt(own)
    for rank in range(count):
        pivot = -1
        for i in range(count):
            if flags[i] != 0 and g[i, i] >= SINGULAR and (pivot < 0 or g[i, i] > g[pivot, pivot]):
                pivot = i
        if pivot < 0:
            return rank
        for i in range(count):
            part = g[i, pivot] / g[pivot, pivot]
            for j in range(count):
                if i != pivot and flags[i] != 0 and flags[j] != 0:
                    g[i, j] -= part * g[pivot, j]
        for i in range(count):
            g[i, pivot] = 0.0
            g[pivot, i] = 0.0
    return count


@internal
def share(contacts, flags):
    """Divide vector[FORCE] among the rows in ``flags`` (c,) with limits in vector[LIMIT]; returns s, or UNDECIDED."""
    count = flags.shape[0]
    force = contacts.sticks.vector[FORCE]
    limits = contacts.sticks.vector[LIMIT]
    first = -1
    resting = 0
    largest = 0.0
    for k in range(count):
        if flags[k] != 0:
            first = k if first < 0 else first
            resting += 1
            largest = max(largest, abs(limits[k]))
    least = 1e-12 * largest + 1e-300
    rank = _rank(contacts, flags)
    part = 0.0
    if rank == resting:
        for k in range(count):
            if flags[k] != 0:
                part = max(part, abs(force[k] / max(limits[k], least)))
        return part
    if rank != 1:
        return UNDECIDED
    whole = 0.0
    for k in range(count):
        if flags[k] != 0:
            part += contacts.compliance[first, k] * force[k]
            whole += abs(contacts.compliance[first, k]) * max(limits[k], least)
    part /= whole
    for k in range(count):
        if flags[k] != 0:
            sign = math.copysign(1.0, contacts.compliance[first, k]) if contacts.compliance[first, k] != 0.0 else 0.0
            force[k] = part * sign * max(limits[k], least)
    return abs(part)


@apart
def carry(dyn, scratch, contacts, lam):
    """Divide the friction in the multipliers lam (m,) among the joints at rest, at the pose of scratch.ws.

    Returns the part s of their limits that they need, or UNDECIDED.
    """
    count = contacts.place.shape[0]
    flags = contacts.chosen[RESTING]
    force = contacts.sticks.vector[FORCE]
    start = contacts.sticks.vector[UNSHARED]
    previous = contacts.sticks.vector[PREVIOUS]
    before = contacts.sticks.lam[0]
    normal = contacts.sticks.normal[FOUND]
    for k in range(count):
        flags[k] = 1 if contacts.place[k, KIND] == WAY and contacts.number[k, CLOSED] > 0.0 else 0
        start[k] = -lam[contacts.place[k, ROW]]
        force[k] = start[k]
    answer_resting(dyn, scratch, contacts, flags)
    hold_rows(dyn, contacts)
    for r in range(lam.shape[0]):
        before[r] = lam[r]
    part = 0.0
    for _ in range(PASSES):
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, normal)
        for k in range(count):
            if flags[k] != 0:
                contacts.sticks.vector[LIMIT, k] = limit_of(dyn, contacts.place[k, FRICTION], normal)
                previous[k] = force[k]
                force[k] = start[k]
        part = share(contacts, flags)
        if part == UNDECIDED:
            return part
        change = 0.0
        largest = 0.0
        for k in range(count):
            if flags[k] != 0:
                change = max(change, abs(force[k] - previous[k]))
                largest = max(largest, abs(force[k]))
        for r in range(lam.shape[0]):
            lam[r] = before[r]
            for k in range(count):
                if flags[k] != 0:
                    lam[r] += contacts.sticks.borne[k, r] * (force[k] - start[k])
        for k in range(count):
            if flags[k] != 0:
                lam[contacts.place[k, ROW]] = -force[k]
        if change <= AGREED * largest:
            break
    return part
