"""What changes where contacts close or open: impacts, then which of them hold from now on.

events/jumps.py, events/laws/impact.py and stick_slip.py for contacts without friction, compiled; formulas stand there.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.bounds import CREEP, DEPENDENT, ROUNDS
from mbsd.dynamics.many.contacts.arrays import (
    BLOCK,
    CLOSED,
    FREE,
    GIVEN,
    HELD,
    KEPT,
    NEAR,
    NORMAL,
    PUSH,
    RATE,
    REST,
    RESTITUTION,
    ROW,
    SETTLE,
    SHIFT,
    SIDE,
    STAYING,
    TAKING,
    TOUCHING,
)
from mbsd.dynamics.many.contacts.pushes import find_compliance, solve_pushes
from mbsd.dynamics.many.contacts.within import along
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.state import TIME

CLOSE = 1e2
"""Gaps that are closed with another, in those that count as zero."""
FAINT = 1e-12
"""Part of the largest load below which a normal force is none."""


@internal
def hold_rows(dyn, contacts):
    """Let the rows of contacts hold that should."""
    for k in range(contacts.place.shape[0]):
        held = contacts.number[k, HELD] > 0.0
        dyn.schur.rows[contacts.place[k, BLOCK], contacts.place[k, SIDE]] = contacts.place[k, ROW] if held else -1


@internal
def _release_all(dyn, contacts):
    for k in range(contacts.place.shape[0]):
        dyn.schur.rows[contacts.place[k, BLOCK], contacts.place[k, SIDE]] = -1


@internal
def _find_rates(dyn, scratch, contacts, v):
    for k in range(contacts.place.shape[0]):
        contacts.vector[RATE, k] = along(dyn, scratch, contacts.place[k, ROW], v)


@internal
def _give(contacts, v, pushes):
    """Change velocities v (3 nb,) by impulses (c,) of the contacts in chosen[TAKING]."""
    for k in range(contacts.place.shape[0]):
        if contacts.chosen[TAKING, k] != 0 and pushes[k] != 0.0:
            for c in range(3, v.shape[0]):
                v[c] += contacts.answer[k, c] * pushes[k]


@apart
def _impacts(dyn, scratch, contacts, v):
    """Let the contacts in chosen[TOUCHING] that approach push, in rounds; returns False where none can."""
    count = contacts.place.shape[0]
    taking = contacts.chosen[TAKING]
    vector = contacts.vector
    for turn in range(ROUNDS + 1):
        _find_rates(dyn, scratch, contacts, v)
        approaching = False
        for k in range(count):
            fast = contacts.chosen[TOUCHING, k] != 0 and vector[RATE, k] < -contacts.number[k, REST]
            taking[k] = 1 if fast else 0
            approaching = approaching or fast
        if not approaching:
            return True
        last = turn == ROUNDS
        bounces = False
        for k in range(count):
            if last:
                taking[k] = contacts.chosen[TOUCHING, k]
            rebound = -vector[RATE, k] * contacts.number[k, RESTITUTION]
            none = last or rebound < contacts.number[k, SETTLE]
            vector[GIVEN, k] = 0.0 if none else contacts.number[k, RESTITUTION]
            bounces = bounces or (taking[k] != 0 and vector[GIVEN, k] != 0.0)
        if not solve_pushes(contacts, vector[RATE]):
            return False
        _give(contacts, v, vector[NORMAL])
        if not bounces:
            continue
        for k in range(count):
            vector[GIVEN, k] *= vector[NORMAL, k]
        _find_rates(dyn, scratch, contacts, v)
        for k in range(count):
            for j in range(count):
                if taking[k] != 0 and taking[j] != 0:
                    vector[RATE, k] += contacts.compliance[k, j] * vector[GIVEN, j]
        if not solve_pushes(contacts, vector[RATE]):
            return False
        for k in range(count):
            vector[PUSH, k] = vector[GIVEN, k] + vector[NORMAL, k]
        _give(contacts, v, vector[PUSH])
    return True


@apart
def _keep_independent(contacts, flags):
    """Fill chosen[KEPT] with those in ``flags`` (c,) whose rows do not follow from earlier ones, and their factor."""
    count = contacts.place.shape[0]
    kept = contacts.chosen[KEPT]
    factor = contacts.factor
    for k in range(count):
        kept[k] = 0
        own = contacts.compliance[k, k]
        if flags[k] == 0 or not own > 0.0:
            continue
        left = own
        for j in range(k):
            if kept[j] == 0:
                continue
            value = contacts.compliance[k, j]
            for i in range(j):
                if kept[i] != 0:
                    value -= factor[k, i] * factor[j, i]
            factor[k, j] = value / factor[j, j]
            left -= factor[k, j] ** 2
        if left > DEPENDENT * own:
            kept[k] = 1
            factor[k, k] = math.sqrt(left)


@apart
def _stop(dyn, scratch, contacts, v):
    """Take the rates of the contacts in chosen[KEPT] off velocities v (3 nb,) by impulses along them."""
    count = contacts.place.shape[0]
    kept = contacts.chosen[KEPT]
    factor = contacts.factor
    push = contacts.vector[SHIFT]
    _find_rates(dyn, scratch, contacts, v)
    for k in range(count):
        push[k] = 0.0
        if kept[k] != 0:
            push[k] = -contacts.vector[RATE, k]
            for j in range(k):
                if kept[j] != 0:
                    push[k] -= factor[k, j] * push[j]
            push[k] /= factor[k, k]
    for k in range(count - 1, -1, -1):
        if kept[k] != 0:
            for j in range(k + 1, count):
                if kept[j] != 0:
                    push[k] -= factor[j, k] * push[j]
            push[k] /= factor[k, k]
            for c in range(3, v.shape[0]):
                v[c] += contacts.answer[k, c] * push[k]


@apart
def _decide(dyn, scratch, contacts, t, y):
    """Fill vector[NORMAL] with the normal forces of the contacts in chosen[STAYING]; whether there are some.

    All contacts are released, and a state y (2, 3 nb) is what they begin with.
    """
    count = contacts.place.shape[0]
    schur = dyn.schur
    jac = scratch.ws.jac
    derivative(dyn, scratch, t, y, contacts.rates, contacts.lam)
    force = contacts.force
    for c in range(force.shape[0]):
        force[c] = scratch.force[c]
    for b in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[b, s]
            if r >= 0:
                for side in range(2):
                    at = 3 * dyn.system.row_body[r, side]
                    for c in range(3):
                        force[at + c] += jac[r, 3 * side + c] * contacts.lam[r]
    largest = 0.0
    for c in range(3, force.shape[0]):
        largest = max(largest, abs(force[c]))
    for k in range(count):
        contacts.chosen[TAKING, k] = contacts.chosen[STAYING, k]
        row = contacts.place[k, ROW]
        contacts.vector[FREE, k] = along(dyn, scratch, row, contacts.rates[1]) - scratch.ws.right[0, row]
    if not solve_pushes(contacts, contacts.vector[FREE]):
        return False
    for k in range(count):
        if not contacts.vector[NORMAL, k] > FAINT * largest:
            contacts.vector[NORMAL, k] = 0.0
    return True


@apart
def resolve(dyn, scratch, contacts, state, met):
    """Impacts, and what contacts do from now on, after contact ``met`` closed or opened; -1: at the start.

    Returns False where that is impossible: a single simulation says why.
    """
    count = contacts.place.shape[0]
    number = contacts.number
    chosen = contacts.chosen
    v = state.y[1]
    opens = met >= 0 and number[met, CLOSED] > 0.0
    t = state.clock[TIME]
    _release_all(dyn, contacts)
    derivative(dyn, scratch, t, state.y, contacts.rates, contacts.lam)
    touching = 0
    for k in range(count):
        near = scratch.ws.phi[contacts.place[k, ROW]] <= CLOSE * number[k, NEAR]
        chosen[TOUCHING, k] = 1 if near or k == met else 0
        touching += chosen[TOUCHING, k]
    find_compliance(dyn, scratch, contacts, chosen[TOUCHING])
    if touching > 0 and not _impacts(dyn, scratch, contacts, v):
        return False
    _find_rates(dyn, scratch, contacts, v)
    staying = 0
    for k in range(count):
        slow = contacts.vector[RATE, k] <= max(number[k, SETTLE], number[k, REST])
        chosen[STAYING, k] = 1 if chosen[TOUCHING, k] != 0 and slow and not (opens and k == met) else 0
        staying += chosen[STAYING, k]
        number[k, CLOSED] = 0.0
        number[k, HELD] = 0.0
    if staying > 0:
        if not _decide(dyn, scratch, contacts, t, state.y):
            return False
        for _ in range(staying):
            if not _moving(dyn, scratch, contacts, v):
                break
            _stop(dyn, scratch, contacts, v)
            if not _decide(dyn, scratch, contacts, t, state.y):
                return False
        for k in range(count):
            chosen[TAKING, k] = 1 if contacts.vector[NORMAL, k] > 0.0 else 0
            number[k, CLOSED] = 1.0 * chosen[TAKING, k]
        _keep_independent(contacts, chosen[TAKING])
        for k in range(count):
            number[k, HELD] = 1.0 * chosen[KEPT, k]
    hold_rows(dyn, contacts)
    return True


@internal
def _moving(dyn, scratch, contacts, v):
    """Whether contacts that hold still move, or others creep; then chosen[KEPT] are those that are to be stopped."""
    moving = False
    _find_rates(dyn, scratch, contacts, v)
    for k in range(contacts.place.shape[0]):
        holds = contacts.vector[NORMAL, k] > 0.0
        rate, rest = contacts.vector[RATE, k], contacts.number[k, REST]
        creeps = contacts.chosen[STAYING, k] != 0 and not holds and rate < -CREEP * rest
        contacts.chosen[TAKING, k] = 1 if holds or creeps else 0
        moving = moving or creeps or (holds and abs(rate) > rest)
    if moving:
        _keep_independent(contacts, contacts.chosen[TAKING])
    return moving
