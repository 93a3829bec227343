"""Steps of a row with contacts: one by one, back to the start of the step where one changes, and on from there.

EventSteps, compiled: the same steps, decided in the same way. What it cannot do it leaves to single simulations.
"""

from __future__ import annotations

import math

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, internal, lazy
from mbsd.dynamics.embedding.arrays import Embedding
from mbsd.dynamics.many.contacts.arrays import (
    AT_ONCE,
    BEGUN,
    CLOSED,
    FAILURE,
    GAP,
    HELD,
    KIND,
    LOAD,
    MET,
    ROW,
    SCALE,
    SHARING,
    WHEN,
)
from mbsd.dynamics.many.contacts.bare import any_held, without_contacts
from mbsd.dynamics.many.contacts.crossing import event_time, first_met
from mbsd.dynamics.many.contacts.events.happening import ENDED, HAPPENED, happen
from mbsd.dynamics.many.contacts.events.releases import hold_joints
from mbsd.dynamics.many.contacts.jumps import resolve
from mbsd.dynamics.many.contacts.rows import hold_rows
from mbsd.dynamics.many.contacts.sticking.jumps import resolve_friction
from mbsd.dynamics.many.contacts.sticking.ways import share_outputs
from mbsd.dynamics.many.contacts.wheels import advance_to
from mbsd.dynamics.many.contacts.within import fit
from mbsd.dynamics.many.events.sides import begin_sides, find_sides, first_reached
from mbsd.dynamics.many.repeated.exchange import hold_independent, look
from mbsd.dynamics.many.rows_at import measure
from mbsd.dynamics.many.through import NO_LIMIT, copy_state, cross
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.state import NEXT, PAUSED, REACHED, STARTED, STEP, TIME, begin, record_here

NOT_SOLVED = -7
"""Status of rows with an event that is left to single simulations."""
OVER = -8
"""Status of rows that an event of the user has ended."""
INSIDE = 1e-6
"""A contact that starts deeper than this part of the size (rad) inside is refused."""
AT_ONE_TIME, MOST = 500, 20_000
"""Events that may happen without time going on, and altogether."""


@internal
def _restart(dyn, scratch, contacts, state):
    """Forget the derivative, which belongs to the motion before."""
    state.count[STARTED] = 0
    state.clock[STEP] = 0.0
    begin(dyn, scratch, state)
    load = 1e-300
    for c in range(3, dyn.weight.shape[0]):
        load = max(load, abs(dyn.weight[c]))
    for r in range(state.lam.shape[0]):
        load = max(load, abs(state.lam[r]))
    contacts.clock[LOAD] = load
    if contacts.events.table.shape[0] > 0:
        find_sides(contacts.events, state)


@internal
def _resolve(dyn, scratch, contacts, state, met):
    if contacts.place.shape[0] == 0:
        return True
    if contacts.sticks.vector.shape[1] > 0:  # friction of joints, or contacts that lose some once they slide
        return resolve_friction(dyn, scratch, contacts, state, met)
    return resolve(dyn, scratch, contacts, state, met)


@internal
def _close_at_start(dyn, scratch, contacts, state):
    """What is closed at the start, and impacts of velocities that contacts forbid; whether that can be."""
    contacts.clock[BEGUN] = 1.0
    measure(dyn, scratch, state.clock[TIME], state.y[0])
    for k in range(contacts.place.shape[0]):
        contacts.number[k, CLOSED] = 0.0
        contacts.number[k, HELD] = 0.0
        gap = contacts.place[k, KIND] == GAP
        if gap and scratch.ws.phi[contacts.place[k, ROW]] * contacts.number[k, SCALE] < -INSIDE:
            return False
    if contacts.events.table.shape[0] > 0:
        begin_sides(contacts.events, state)
    if not _resolve(dyn, scratch, contacts, state, -1):
        return False
    _restart(dyn, scratch, contacts, state)
    return contacts.events.table.shape[0] == 0 or first_reached(contacts.events, state) < 0


@internal
def _counted(contacts, t):
    """Count an event at a time (s); whether there are not too many."""
    contacts.clock[AT_ONCE] = contacts.clock[AT_ONCE] + 1.0 if contacts.clock[WHEN] == t else 1.0
    contacts.clock[WHEN] = t
    contacts.clock[MET] += 1.0
    return contacts.clock[AT_ONCE] <= AT_ONE_TIME and contacts.clock[MET] <= MOST


@internal
def _go_to(own, scratch, state, settings, contacts, out, t, before, after):
    """Bring the state to the time t (s) within its step, at which contacts.trial often stands already."""
    following = contacts.before.count[NEXT]
    outputs = following < out.t.shape[0] and out.t[following] <= t
    if contacts.clock[FAILURE] == 0.0 and contacts.trial.clock[TIME] == t and not outputs:
        copy_state(state, contacts.trial)
        state.count[NEXT] = following
        return
    copy_state(state, contacts.before)
    if contacts.clock[FAILURE] == 0.0 and t > state.clock[TIME]:
        contacts.clock[FAILURE] = advance_to(own, scratch, state, out, settings, contacts, t, NO_LIMIT, before, after)


@internal
def _jump(dyn, scratch, contacts, state, met):
    """What changes at an event; whether that is decided here, and there are not too many."""
    return _counted(contacts, state.clock[TIME]) and _resolve(dyn, scratch, contacts, state, met)


@internal
def _end(scratch, state, out):
    """Make the outputs that are left the state itself, at which an event of the user ends the simulation."""
    while state.count[NEXT] < out.t.shape[0]:
        record_here(scratch, state, out)


@lazy(int)
def _go_on(dyn, scratch, state, settings, contacts, out, end, steps, before, after):
    hold_rows(dyn, contacts)
    repeated = contacts.repeated
    hold_independent(dyn, repeated)
    if contacts.events.release.shape[0] > 0:
        hold_joints(dyn, contacts)
    if contacts.clock[BEGUN] == 0.0 and not _close_at_start(dyn, scratch, contacts, state):
        return NOT_SOLVED
    for _ in range(steps):
        if repeated.place.shape[0] > 0:
            look(dyn, scratch, repeated, state, 1)
        own = dyn if any_held(contacts) else without_contacts(dyn, contacts)
        cross(state, before, after)
        begin(own, scratch, state)
        if contacts.events.table.shape[0] > 0:
            find_sides(contacts.events, state)
        copy_state(contacts.before, state)
        status = advance_to(own, scratch, state, out, settings, contacts, end, 1, before, after)
        if status != REACHED and status != PAUSED:
            return status
        met = -1
        contacts.clock[FAILURE] = 0.0
        if state.clock[TIME] > contacts.before.clock[TIME]:
            fit(contacts, state)
            contacts.trial.clock[TIME] = -math.inf
            met = first_met(dyn, scratch, state, settings, contacts, out, before, after)
        if met >= 0:
            t = event_time(dyn, scratch, settings, contacts, out, before, after, met)
            _go_to(own, scratch, state, settings, contacts, out, t, before, after)
        if contacts.clock[SHARING] > 0.0:
            share_outputs(dyn, scratch, contacts, out, contacts.before.count[NEXT], state.count[NEXT])
        if contacts.clock[FAILURE] != 0.0:
            return NOT_SOLVED
        if met < 0:
            if status == REACHED and state.clock[TIME] >= end:
                return REACHED
            continue
        begin(own, scratch, state)
        count = contacts.place.shape[0]
        while met >= 0:
            passed = HAPPENED
            if met >= count:
                passed = happen(dyn, scratch, contacts, state, met - count)
                if passed == ENDED:
                    if contacts.clock[SHARING] > 0.0:
                        return NOT_SOLVED
                    _end(scratch, state, out)
                    return OVER
                met = -1
            if passed == HAPPENED and not _jump(dyn, scratch, contacts, state, met):
                return NOT_SOLVED
            _restart(dyn, scratch, contacts, state)
            met = -1
            if contacts.events.table.shape[0] > 0:
                reached = first_reached(contacts.events, state)
                met = -1 if reached < 0 else count + reached
    return PAUSED


@inlined
def _meet(dyn, scratch, state, settings, contacts, out, end, steps, before, after):
    return _go_on(dyn, scratch, state, settings, contacts, out, end, steps, before, after)


@inlined
def _none(dyn, scratch, state, settings, contacts, out, end, steps, before, after):
    return NOT_SOLVED


go_on = alternatives({Dynamics: _meet, Embedding: _none})
"""Go on to ``end`` (s), ``steps`` steps at most, meeting events; returns a status of ``advance``, or one of these."""
