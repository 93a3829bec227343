"""Joints at rest that hold each other: what each carries, and how near they are to giving way.

One set of rows holds them, and its multipliers carry all. The friction is shared among all joints at rest
(events/laws/division.py);
their limits depend on reactions, which change with the shares, so it is shared again until both agree. Contacts that
are closed react, so that their gaps stay closed, and with them the friction of those that slide:

    V = V_t - V_h G_h^-1 G_ht,   G = J_t V     h: rows of contacts that hold; the gap of one that slides pushes along
                                               its way too

V (n, k) are accelerations by unit friction T. What contacts hold by themselves no joint needs to. Where contacts slide,
G is not symmetric, and two questions part:

    V d = 0     T may change by d: nothing moves differently. As  V^T M V d = 0  it is one of a symmetric compliance
    G d = 0     joints stay at rest, though what else moves may move differently, as the contacts press more or less

The first is how friction is shared, the second how near joints are to giving way: Coulomb's law asks no more of them.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import (
    CLOSED,
    FORCE,
    FOUND,
    FRICTION,
    HELD,
    KIND,
    LEFT,
    LIMIT,
    PREVIOUS,
    RESTING,
    ROW,
    UNSHARED,
    WAY,
)
from mbsd.dynamics.events.bounds import AGREED, PASSES
from mbsd.dynamics.events.laws.division import divide
from mbsd.dynamics.events.rows import hold_rows
from mbsd.dynamics.events.sticking.answers import answer_resting
from mbsd.dynamics.events.sticking.sliding import (
    add_beside,
    add_beside_lam,
    find_changes,
    note_beside,
    press_beside,
)
from mbsd.equations.joint_friction import PIN, PRELOAD, SHAPE, SIZE, STATIC, normal_forces


@internal
def limit_of(dyn, k, normal):
    """Return the largest friction (N, N m) of joint k with friction, at rest under normal forces (f,)."""
    number = dyn.loads.friction_number[k]
    lever = number[SIZE] if dyn.loads.friction[k, SHAPE] == PIN else 1.0
    return number[STATIC] * lever * (normal[k] + number[PRELOAD])


@internal
def _find_moved(dyn, contacts, flags):
    """Fill friction.compliance of the joints in ``flags`` (c,) with V^T M V where contacts slide; whether any does."""
    sliding = False
    for w in range(dyn.sliding.table.shape[0]):
        sliding = sliding or dyn.sliding.table[w, 0] != 0.0
    if not sliding:
        return False
    answer = contacts.answer
    for k in range(flags.shape[0]):
        for j in range(k + 1):
            if flags[k] == 0 or flags[j] == 0:
                continue
            both = 0.0
            for c in range(3, answer.shape[1]):
                both += answer[k, c] * answer[j, c] / dyn.inverse[c]
            contacts.friction.compliance[k, j] = both
            contacts.friction.compliance[j, k] = both
    return True


@internal
def _agree(dyn, scratch, contacts, sliding, beside, lam):
    """Divide the friction again until limits agree, under the friction ``beside`` of joints that slide; returns s.

    lam (m,) begins with what presses joints at first.
    """
    count = contacts.place.shape[0]
    flags = contacts.chosen[RESTING]
    force = contacts.sticks.vector[FORCE]
    start = contacts.sticks.vector[UNSHARED]
    previous = contacts.sticks.vector[PREVIOUS]
    held = contacts.sticks.vector[LEFT]
    limit = contacts.sticks.vector[LIMIT]
    before = contacts.sticks.lam[0]
    normal = contacts.sticks.normal[FOUND]
    moved = contacts.friction.compliance if sliding else contacts.compliance
    part = 0.0
    for k in range(count):
        force[k] = start[k]
    for _ in range(PASSES):
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, normal)
        for k in range(count):
            if flags[k] != 0:
                limit[k] = limit_of(dyn, contacts.place[k, FRICTION], normal)
                previous[k] = force[k]
                force[k] = add_beside(contacts, k, start[k]) if beside else start[k]
                held[k] = force[k]
        part = divide(moved, flags, force, limit, contacts.sticks.division)
        if sliding:
            part = divide(contacts.compliance, flags, held, limit, contacts.sticks.division)
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
        if beside:
            add_beside_lam(contacts, lam)
        for k in range(count):
            if flags[k] != 0:
                lam[contacts.place[k, ROW]] = -force[k]
        if change <= AGREED * largest:
            break
    return part


@apart
def carry(dyn, scratch, contacts, v, lam, asked):
    """Divide the friction in the multipliers lam (m,) among the joints at rest, at the pose of scratch.ws.

    Returns the part s of their limits that they need, if it is ``asked`` for under the friction of joints that slide at
    velocities v (3 nb,).
    """
    count = contacts.place.shape[0]
    flags = contacts.chosen[RESTING]
    start = contacts.sticks.vector[UNSHARED]
    before = contacts.sticks.lam[0]
    held = contacts.sticks.together.held
    for k in range(count):
        flags[k] = 1 if contacts.place[k, KIND] == WAY and contacts.number[k, CLOSED] > 0.0 else 0
        start[k] = -lam[contacts.place[k, ROW]]
    answer_resting(dyn, scratch, contacts, flags)
    hold_rows(dyn, contacts)
    sliding = _find_moved(dyn, contacts, flags)
    for r in range(lam.shape[0]):
        before[r] = lam[r]
    part = _agree(dyn, scratch, contacts, sliding, False, lam)
    if not asked or not press_beside(dyn, scratch, contacts, v, before, True):
        return part
    for k in range(count):
        held[k] = 1 if flags[k] != 0 and contacts.number[k, HELD] > 0.0 else 0
        if held[k] != 0:
            note_beside(dyn, scratch, contacts, k, contacts.place[k, ROW])
    find_changes(contacts, contacts.compliance, held, count)
    other = contacts.sticks.lam[1]
    for r in range(lam.shape[0]):
        other[r] = lam[r]
    return _agree(dyn, scratch, contacts, sliding, True, other)
