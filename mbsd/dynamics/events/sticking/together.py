"""Loads that contacts that stick and joints at rest carry together, and how near these are to giving way.

One set of rows holds them, which says nothing of what each carries: where a ball lies between floor and face of a
slider that sticks in its guide, any of the three may stick less. Of all forces that keep them at rest those are found
that need the smallest part s of what Coulomb's law allows (events/laws/least_part.py); limits of joints depend on
reactions, so it is done again until both agree. They hold while s <= 1, whatever rows hold them.

Guards of joints that stick:

slides    its speed, sign kept
sticks    its limit less |T|; where what is at rest shares its forces  1 - s  of all of it, times the largest load
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.events import arrays
from mbsd.dynamics.events.friction import holds
from mbsd.dynamics.events.laws import least_part as least
from mbsd.dynamics.events.laws.division import divide
from mbsd.dynamics.events.laws.least_part import AGREED_TOGETHER, PULLED, least_part
from mbsd.dynamics.events.rows import find_answers, gaps_of, hold_rows, release_rows
from mbsd.dynamics.events.sticking.sharing import (
    add_beside,
    add_beside_lam,
    answer_resting,
    factor,
    find_changes,
    find_moved,
    limit_of,
    note_beside,
    press_beside,
)
from mbsd.dynamics.formulation import along, measure
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import normal_forces

RAW, UNIT, OWN, FORCE = least.RAW, least.UNIT, least.OWN, least.FORCE
PASSES = 100
"""Passes in which all that is at rest agrees on how it shares its friction, at most."""
AGREED = 1e-12
"""Part of the largest friction that may still change, of joints alone."""
ROUNDING = 1e-10
"""Rounding of forces, as part of the largest."""


@internal
def list_rows(contacts, flags, coefficient):
    """List the rows in ``flags`` (c,) in sticks.together, with what friction of contacts may be.

    ``coefficient``: column of Friction.number. Returns numbers of gaps and of ways.
    """
    work = contacts.sticks.together
    gaps = gaps_of(contacts)
    gap = contacts.friction.gap
    n = 0
    first = 0
    for k in range(flags.shape[0]):
        if flags[k] != 0:
            work.row[n] = k
            work.number[UNIT, n] = 1.0 / math.sqrt(contacts.vector[arrays.ALONE, k])
            n += 1
            if k < gaps:
                first = n
    for i in range(first, n):
        w = work.row[i] - gaps
        work.number[OWN, i - first] = 0.0
        for j in range(first):
            own = w < gap.shape[0] and gap[w] == work.row[j]
            work.pick[i - first, j] = contacts.friction.number[w, coefficient] if own else 0.0
    return first, n - first


@internal
def _begin_together(dyn, scratch, contacts, flags):
    """Fill ``flags`` (c,) with closed gaps and ways at rest, with answers, also of ways that slide."""
    friction = contacts.friction
    gaps = gaps_of(contacts)
    for k in range(flags.shape[0]):
        flags[k] = 1 if contacts.number[k, arrays.CLOSED] > 0.0 else 0
    for w in range(friction.gap.shape[0]):
        if flags[friction.gap[w]] != 0:
            flags[gaps + w] = 1
    release_rows(dyn, contacts)
    factor(dyn, scratch)
    find_answers(dyn, scratch, contacts, flags)
    for w in range(friction.gap.shape[0]):
        if contacts.number[gaps + w, arrays.CLOSED] == 0.0:
            flags[gaps + w] = 0


@internal
def _begin_joints(dyn, scratch, contacts, flags):
    """Fill ``flags`` (c,) with joints at rest, with answers where contacts hold and react."""
    for k in range(flags.shape[0]):
        flags[k] = 1 if contacts.place[k, arrays.KIND] == arrays.WAY and contacts.number[k, arrays.CLOSED] > 0.0 else 0
    answer_resting(dyn, scratch, contacts, flags)


@internal
def _pushes(contacts, k):
    """Return the way along which the friction of gap k pushes as well, -1 if there is none, and how much of it."""
    gap = contacts.friction.gap
    gaps = gaps_of(contacts)
    for w in range(gap.shape[0]):
        sign = contacts.number[gaps + w, arrays.SIGN]
        if gap[w] == k and sign != 0.0 and contacts.number[gaps + w, arrays.CLOSED] == 0.0:
            return gaps + w, contacts.friction.number[w, arrays.KINETIC] * sign
    return -1, 0.0


@internal
def _fill(contacts, lam, n):
    """Fill compliance, sticks.vector[UNSHARED] and held of the n rows that are listed."""
    work = contacts.sticks.together
    for i in range(n):
        k = work.row[i]
        work.held[i] = 1 if contacts.number[k, arrays.HELD] > 0.0 else 0
        contacts.sticks.vector[arrays.UNSHARED, i] = -lam[contacts.place[k, arrays.ROW]] if work.held[i] != 0 else 0.0
        way, part = _pushes(contacts, k)
        for j in range(n):
            value = contacts.compliance[work.row[j], k]
            if way >= 0:
                value -= part * contacts.compliance[work.row[j], way]
            work.compliance[j, i] = value


@internal
def _fill_multipliers(contacts, lam, before, n, beside):
    """Fill lam (m,) with what multipliers ``before`` (m,) become under number[FORCE] of the n rows.

    ``beside``: and under the friction of joints that slide.
    """
    work = contacts.sticks.together
    borne = contacts.sticks.borne
    for r in range(lam.shape[0]):
        lam[r] = before[r]
    if beside:
        add_beside_lam(contacts, lam)
    for i in range(n):
        way, part = _pushes(contacts, work.row[i])
        change = work.number[FORCE, i] - contacts.sticks.vector[arrays.UNSHARED, i]
        for r in range(lam.shape[0]):
            lam[r] += borne[work.row[i], r] * change
            if way >= 0:
                lam[r] -= part * borne[way, r] * change
    for i in range(n):
        lam[contacts.place[work.row[i], arrays.ROW]] = -work.number[FORCE, i]
        way, part = _pushes(contacts, work.row[i])
        if way >= 0:
            lam[contacts.place[way, arrays.ROW]] = part * work.number[FORCE, i]


@internal
def _divide(contacts, c, k, together, slides):
    """Fill number[FORCE] with what becomes of number[RAW]; returns the part s of their limits that all need.

    ``together``: contacts and joints; else joints alone, which contacts press while some of these slide if ``slides``.
    """
    work = contacts.sticks.together
    if together:
        return least_part(work, c, k, 1.0)
    flags = contacts.chosen[arrays.RESTING]
    shared = contacts.sticks.vector[arrays.SHARED]
    held = contacts.sticks.vector[arrays.LEFT]
    limit = contacts.sticks.vector[arrays.LIMIT]
    for i in range(k):
        shared[work.row[i]] = work.number[RAW, i]
        held[work.row[i]] = work.number[RAW, i]
        limit[work.row[i]] = work.number[OWN, i]
    moved = contacts.friction.compliance if slides else contacts.compliance
    part = divide(moved, flags, shared, limit, contacts.sticks.division)
    if slides:
        part = divide(contacts.compliance, flags, held, limit, contacts.sticks.division)
    for i in range(k):
        work.number[FORCE, i] = shared[work.row[i]]
    return part


@internal
def _agree(dyn, scratch, contacts, c, k, together, slides, beside, lam):
    """Divide again until limits agree, under the friction ``beside`` of joints that slide; returns s.

    lam (m,) begins with what presses joints at first.
    """
    work = contacts.sticks.together
    normal = contacts.sticks.normal[arrays.FOUND]
    before = contacts.sticks.lam[0]
    part = 1.0
    for _ in range(PASSES):
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, normal)
        for i in range(c + k):
            raw = contacts.sticks.vector[arrays.UNSHARED, i]
            work.number[RAW, i] = add_beside(contacts, i, raw) if beside else raw
        for i in range(c, c + k):
            row = work.row[i]
            if contacts.place[row, arrays.KIND] == arrays.WAY:
                work.number[OWN, i - c] = limit_of(dyn, contacts.place[row, arrays.FRICTION], normal)
        part = _divide(contacts, c, k, together, slides)
        change = 0.0
        largest = 0.0
        for i in range(c + k):
            change = max(change, abs(work.number[FORCE, i] + lam[contacts.place[work.row[i], arrays.ROW]]))
            largest = max(largest, abs(work.number[FORCE, i]))
        _fill_multipliers(contacts, lam, before, c + k, beside)
        if part == PULLED or change <= (AGREED_TOGETHER if together else AGREED) * largest:
            break
    return part


@apart
def carry(dyn, scratch, contacts, v, lam, asked):
    """Divide the multipliers lam (m,) among what is at rest, as SHARING says, at the pose of scratch.ws.

    Returns the part s of their limits that they need, PULLED where contacts would have to pull; if it is ``asked`` for,
    under the friction of joints that slide at velocities v (3 nb,).
    """
    flags = contacts.chosen[arrays.RESTING]
    work = contacts.sticks.together
    before = contacts.sticks.lam[0]
    together = contacts.clock[arrays.SHARING] == arrays.TOGETHER
    if together:
        _begin_together(dyn, scratch, contacts, flags)
    else:
        _begin_joints(dyn, scratch, contacts, flags)
    c, k = list_rows(contacts, flags, arrays.STATIC)
    hold_rows(dyn, contacts)
    slides = not together and find_moved(dyn, contacts, flags)
    _fill(contacts, lam, c + k)
    for r in range(lam.shape[0]):
        before[r] = lam[r]
    part = _agree(dyn, scratch, contacts, c, k, together, slides, False, lam)
    if not asked or not press_beside(dyn, scratch, contacts, v, before, not together):
        return part
    for i in range(c + k):
        if work.held[i] != 0:
            note_beside(dyn, scratch, contacts, i, contacts.place[work.row[i], arrays.ROW])
    find_changes(contacts, work.compliance, work.held, c + k)
    other = contacts.sticks.lam[1]
    for r in range(lam.shape[0]):
        other[r] = lam[r]
    return _agree(dyn, scratch, contacts, c, k, together, slides, True, other)


@internal
def divide_together(contacts, flags, force, limit, coefficient):
    """Divide N and T in ``force`` (c,) among the rows in ``flags`` (c,) that stay at rest; ``limit`` (c,) of joints."""
    work = contacts.sticks.together
    pressed = contacts.friction.compliance
    c, k = list_rows(contacts, flags, coefficient)
    for i in range(c + k):
        work.held[i] = 1
        work.number[RAW, i] = force[work.row[i]]
        if i >= c and contacts.place[work.row[i], arrays.KIND] == arrays.WAY:
            work.number[OWN, i - c] = limit[work.row[i]]
        for j in range(c + k):
            work.compliance[i, j] = pressed[work.row[i], work.row[j]]
    if least_part(work, c, k, 1.0) != PULLED:
        for i in range(c + k):
            force[work.row[i]] = work.number[FORCE, i]


@lazy(None)
def read_ways(dyn, scratch, contacts, y, forces):
    """Fill vector[VALUE] of ways at a state y (2, 3 nb) at which contacts.lam are the multipliers, if ``forces``."""
    normal = contacts.sticks.normal[arrays.FOUND]
    resting = -1
    sharing = contacts.clock[arrays.SHARING]
    if forces:
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, contacts.lam, normal)
    for k in range(contacts.place.shape[0]):
        if (
            contacts.place[k, arrays.KIND] == arrays.SLIDE
            and sharing == arrays.TOGETHER
            and contacts.number[k, arrays.CLOSED] > 0.0
        ):
            contacts.vector[arrays.VALUE, k] = contacts.clock[arrays.LOAD]
        if contacts.place[k, arrays.KIND] != arrays.WAY:
            continue
        row = contacts.place[k, arrays.ROW]
        if not holds(dyn, contacts, k):
            contacts.vector[arrays.VALUE, k] = contacts.clock[arrays.LOAD]
            continue
        if contacts.number[k, arrays.CLOSED] == 0.0:
            contacts.vector[arrays.VALUE, k] = contacts.number[k, arrays.SIGN] * along(dyn, scratch, row, y[1])
            continue
        contacts.vector[arrays.VALUE, k] = contacts.clock[arrays.LOAD]
        if forces and sharing == arrays.APART:
            limit = limit_of(dyn, contacts.place[k, arrays.FRICTION], normal)
            contacts.vector[arrays.VALUE, k] = limit - abs(contacts.lam[row])
        if resting < 0:
            resting = k
    if forces and sharing != arrays.APART:
        part = carry(dyn, scratch, contacts, y[1], contacts.lam, True)
        for k in range(contacts.place.shape[0]):
            if (
                resting < 0
                and contacts.place[k, arrays.KIND] == arrays.SLIDE
                and contacts.number[k, arrays.CLOSED] > 0.0
            ):
                resting = k
            if k < gaps_of(contacts) and contacts.number[k, arrays.CLOSED] > 0.0:
                push = -contacts.lam[contacts.place[k, arrays.ROW]]
                pulls = part == PULLED and push < ROUNDING * contacts.clock[arrays.LOAD]
                contacts.vector[arrays.VALUE, k] = -contacts.clock[arrays.LOAD] if pulls else push
        contacts.vector[arrays.VALUE, resting] = (1.0 - min(part, 2.0)) * contacts.clock[arrays.LOAD]


@lazy(None)
def share_outputs(dyn, scratch, contacts, out, first, end):
    """Divide the friction of joints at rest in outputs ``first`` to ``end`` (left out)."""
    for k in range(first, end):
        measure(dyn, scratch, out.t[k], out.y[k, 0])
        carry(dyn, scratch, contacts, out.y[k, 1], out.lam[k], False)


@internal
def share_here(dyn, scratch, contacts, state):
    """Put the multipliers of a state whose derivative is valid in contacts.lam, divided among what is at rest."""
    for r in range(state.lam.shape[0]):
        contacts.lam[r] = state.lam[r]
    if contacts.clock[arrays.SHARING] != arrays.APART:
        share_state(dyn, scratch, contacts, state)


@lazy(None)
def share_state(dyn, scratch, contacts, state):
    """Divide contacts.lam, the multipliers of a state."""
    measure(dyn, scratch, state.clock[TIME], state.y[0])
    carry(dyn, scratch, contacts, state.y[1], contacts.lam, False)
