"""What changes at an event where joints have friction: impacts, then which rows hold (events/jumps.py, compiled)."""

from __future__ import annotations

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.many.contacts.arrays import (
    CLOSED,
    CLUTCH,
    FRICTION,
    HELD,
    KEPT,
    KIND,
    NEAR,
    NORMAL,
    RATE,
    REST,
    ROW,
    SETTLE,
    SHARING,
    SIGN,
    STAYING,
    TAKING,
    TOUCHING,
    WAY,
)
from mbsd.dynamics.many.contacts.jumps import CLOSE, impacts, moving
from mbsd.dynamics.many.contacts.rows import find_rates, hold_rows, keep_independent, move_zero, release_rows, stop
from mbsd.dynamics.many.contacts.sticking.answers import find_answers, stand
from mbsd.dynamics.many.contacts.sticking.deciding import decide
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import SENSE


@internal
def _touching(scratch, contacts, met):
    """Fill chosen[TOUCHING] with the gaps that are closed; returns how many."""
    touching = 0
    for k in range(contacts.place.shape[0]):
        kind = contacts.place[k, KIND]
        near = scratch.ws.phi[contacts.place[k, ROW]] <= CLOSE * contacts.number[k, NEAR]
        contacts.chosen[TOUCHING, k] = 1 if kind != WAY and (near or k == met or kind == CLUTCH) else 0
        touching += contacts.chosen[TOUCHING, k]
    return touching


@internal
def _settled(dyn, scratch, contacts, state, halted, slipping):
    """Decide, and again once gaps that hold are at rest; returns False where nothing is possible."""
    if not decide(dyn, scratch, contacts, state, halted, slipping):
        return False
    staying = 0
    for k in range(contacts.place.shape[0]):
        staying += contacts.chosen[STAYING, k]
    for _ in range(staying):
        if not moving(dyn, scratch, contacts, state.y[1]):
            return True
        stop(dyn, scratch, contacts, state.y[1])
        if not decide(dyn, scratch, contacts, state, halted, slipping):
            return False
    return True


@internal
def _set(dyn, scratch, contacts):
    """Let rows hold as was decided."""
    count = contacts.place.shape[0]
    number = contacts.number
    taking = contacts.chosen[TAKING]
    for k in range(count):
        way = contacts.place[k, KIND] == WAY
        taking[k] = 1 if (number[k, SIGN] == 0.0 if way else contacts.vector[NORMAL, k] > 0.0) else 0
        if way:
            dyn.loads.friction_number[contacts.place[k, FRICTION], SENSE] = number[k, SIGN]
        clutch = contacts.place[k, KIND] == CLUTCH
        if taking[k] != 0 and (clutch or (way and number[k, CLOSED] == 0.0)):
            move_zero(scratch, contacts, k)
        number[k, CLOSED] = 1.0 * taking[k]
    keep_independent(contacts, taking)
    contacts.clock[SHARING] = 0.0
    for k in range(count):
        number[k, HELD] = 1.0 * contacts.chosen[KEPT, k]
        if contacts.place[k, KIND] == WAY and taking[k] != 0 and number[k, HELD] == 0.0:
            contacts.clock[SHARING] = 1.0
    hold_rows(dyn, contacts)


@lazy(bool)
def resolve_friction(dyn, scratch, contacts, state, met):
    """Impacts, and what gaps and joints do from now on, after row ``met`` came to an event; -1: at the start.

    Returns False where that is impossible, or not decided here: a single simulation says why.
    """
    count = contacts.place.shape[0]
    number = contacts.number
    chosen = contacts.chosen
    v = state.y[1]
    closed = met >= 0 and number[met, CLOSED] > 0.0
    joint = met >= 0 and contacts.place[met, KIND] == WAY
    release_rows(dyn, contacts)
    stand(dyn, scratch, state.clock[TIME], state.y)
    touching = _touching(scratch, contacts, met)
    for k in range(count):
        chosen[TAKING, k] = 1 if chosen[TOUCHING, k] != 0 or contacts.place[k, KIND] == WAY else 0
    find_answers(dyn, scratch, contacts, chosen[TAKING])
    if touching > 0 and not impacts(dyn, scratch, contacts, v):
        return False
    find_rates(dyn, scratch, contacts, v)
    for k in range(count):
        slow = contacts.vector[RATE, k] <= max(number[k, SETTLE], number[k, REST])
        opens = closed and k == met and not joint
        chosen[STAYING, k] = 1 if chosen[TOUCHING, k] != 0 and slow and not opens else 0
    halted = met if joint and not closed else -1
    if not _settled(dyn, scratch, contacts, state, halted, joint and closed):
        return False
    _set(dyn, scratch, contacts)
    return True
