"""Jumps where joints have friction, or contacts lose some: impacts, then which rows hold.

The impacts are those of contacts (events/jumps.py); what holds from now on is decided with the friction of joints.
"""

from __future__ import annotations

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.arrays import (
    APART,
    CLOSED,
    CLUTCH,
    FRICTION,
    GAP,
    HELD,
    JOINTS,
    KEPT,
    KIND,
    NORMAL,
    RELEASED,
    SHARING,
    SIGN,
    SLIDE,
    TAKING,
    TOGETHER,
    TOUCHING,
    WAY,
)
from mbsd.dynamics.events.friction import note_met, one_by_one, slide_or_stick
from mbsd.dynamics.events.jumps import find_staying, find_touching, impacts, moving
from mbsd.dynamics.events.rows import (
    find_rates,
    gaps_of,
    hold_rows,
    keep_independent,
    move_zero,
    release_rows,
    stop,
)
from mbsd.dynamics.events.sticking.deciding import decide
from mbsd.dynamics.events.sticking.sharing import find_answers, stand
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import SENSE


@internal
def _any_joint(contacts):
    """Return True if there is a joint that may stick and that no event has released."""
    there = False
    for k in range(contacts.place.shape[0] - contacts.sticks.joint.shape[0], contacts.place.shape[0]):
        there = there or contacts.number[k, RELEASED] == 0.0
    return there


@internal
def _settled(dyn, scratch, contacts, state, staying, halted, slipping, touched):
    """Decide, and again once the ``staying`` gaps that hold are at rest; returns False where nothing is possible."""
    if staying == 0 and not _any_joint(contacts):
        for k in range(contacts.place.shape[0]):
            contacts.vector[NORMAL, k] = 0.0
        return True
    if not decide(dyn, scratch, contacts, state, halted, slipping, touched):
        return False
    for _ in range(staying):
        if not moving(dyn, scratch, contacts, state.y[1]):
            return True
        stop(dyn, scratch, contacts, state.y[1])
        if not decide(dyn, scratch, contacts, state, halted, slipping, touched):
            return False
    return True


@internal
def _set(dyn, scratch, contacts):
    """Let rows hold as was decided."""
    count = contacts.place.shape[0]
    number = contacts.number
    taking = contacts.chosen[TAKING]
    joints = count - contacts.sticks.joint.shape[0]
    for k in range(gaps_of(contacts)):
        taking[k] = 1 if contacts.vector[NORMAL, k] > 0.0 else 0
        number[k, CLOSED] = 1.0 * taking[k]
        if taking[k] != 0 and contacts.place[k, KIND] == CLUTCH:
            move_zero(scratch, contacts, k)
    slide_or_stick(scratch, contacts)
    for k in range(joints, count):
        taking[k] = 0
        if number[k, RELEASED] != 0.0:
            continue
        taking[k] = 1 if number[k, SIGN] == 0.0 else 0
        dyn.loads.friction_number[contacts.place[k, FRICTION], SENSE] = number[k, SIGN]
        if taking[k] != 0 and number[k, CLOSED] == 0.0:
            move_zero(scratch, contacts, k)
        number[k, CLOSED] = 1.0 * taking[k]
    keep_independent(contacts, taking)
    sharing = False
    mixed = False
    plain = one_by_one(contacts)
    gaps = gaps_of(contacts)
    for k in range(count):
        number[k, HELD] = 1.0 * contacts.chosen[KEPT, k]
        if k >= gaps and taking[k] != 0:
            sharing = sharing or (number[k, HELD] == 0.0 and (k >= joints or not plain))
            mixed = mixed or k < joints
    contacts.clock[SHARING] = (TOGETHER if mixed else JOINTS) if sharing else APART
    hold_rows(dyn, contacts)


@lazy(bool)
def resolve_friction(dyn, scratch, contacts, state, met):
    """Resolve impacts, and decide what contacts and joints do after row ``met`` came to an event; -1: at the start.

    Returns False where that is impossible; refusals.py says why.
    """
    chosen = contacts.chosen
    v = state.y[1]
    closed = met >= 0 and contacts.number[met, CLOSED] > 0.0
    joint = met >= 0 and contacts.place[met, KIND] == WAY
    together = closed and contacts.place[met, KIND] == SLIDE and contacts.clock[SHARING] == TOGETHER
    note_met(contacts, -1 if together else met, state.lam)
    release_rows(dyn, contacts)
    stand(dyn, scratch, state.clock[TIME], state.y)
    touching = find_touching(scratch, contacts, met)
    for k in range(contacts.place.shape[0]):
        way = contacts.place[k, KIND] == WAY and contacts.number[k, RELEASED] == 0.0
        chosen[TAKING, k] = 1 if chosen[TOUCHING, k] != 0 or way else 0
    find_answers(dyn, scratch, contacts, chosen[TAKING])
    if touching > 0 and not impacts(dyn, scratch, contacts, v):
        return False
    find_rates(dyn, scratch, contacts, v)
    staying = find_staying(contacts, met if closed else -1)
    halted = met if joint and not closed else -1
    slipping = (joint and closed) or together
    touched = met if met >= 0 and contacts.place[met, KIND] == GAP and not closed else -1
    if not _settled(dyn, scratch, contacts, state, staying, halted, slipping, touched):
        return False
    _set(dyn, scratch, contacts)
    return True
