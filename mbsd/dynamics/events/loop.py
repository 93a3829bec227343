"""The loop of a run with events: step, look for an event within the step, step exactly to it, jump, and go on.

    step     one step of the integrator; does a scalar fall through zero within it?
    root     from the state before the step, integrate to shorter and shorter ends, until the scalar is zero
    jump     what changes there: an action of the user, impacts, what contacts and joints do from now on
    restart  from the new state

The integrator itself steps to the event, so that it is met as exactly as the motion is known. The loop returns before
and after each event where PAUSES asks for it: what a single simulation records is then in these arrays.
"""

from __future__ import annotations

import math

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, internal, kernel, lazy
from mbsd.dynamics.events import arrays, users
from mbsd.dynamics.events.following import advance_to
from mbsd.dynamics.events.guards import fit
from mbsd.dynamics.events.jumps import resolve
from mbsd.dynamics.events.outlines import forget_pairs
from mbsd.dynamics.events.rows import any_held, hold_rows
from mbsd.dynamics.events.search import event_time, first_met
from mbsd.dynamics.events.sticking.together import share_here, share_outputs
from mbsd.dynamics.formulation import begin_run, measure, without_contacts
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.integrators.advance import NO_LIMIT, copy_state, cross
from mbsd.dynamics.repeated_rows import hold_independent, look
from mbsd.dynamics.state import NEXT, PAUSED, REACHED, STARTED, STEP, TIME, record_here

NOT_SOLVED = -7
"""Status of rows with an event at which nothing is possible."""
OVER = -8
"""Status of rows that an event of the user has ended."""
FOUND, JUMPED, ACTING, TOO_MANY = 11, 12, 13, 14
"""Status of rows that stand right before an event, right after one, at one whose action is one of Python, and of those
with more events than are allowed."""
INSIDE = 1e-6
"""A contact that starts deeper than this part of the size (rad) inside is refused."""
AT_ONE_TIME, MOST = 500, 20_000
"""Events that may happen without time going on, and altogether where none looks at the pace meanwhile."""


@internal
def _restart(dyn, scratch, contacts, state):
    """Forget the derivative, which belongs to the motion before."""
    state.count[STARTED] = 0
    state.clock[STEP] = 0.0
    begin_run(dyn, scratch, state)
    load = 1e-300
    for c in range(3, dyn.weight.shape[0]):
        load = max(load, abs(dyn.weight[c]))
    for r in range(state.lam.shape[0]):
        load = max(load, abs(state.lam[r]))
    contacts.clock[arrays.LOAD] = load
    if contacts.events.table.shape[0] > 0:
        users.find_sides(dyn, contacts.events, state)


decide = alternatives({}, resolve)
"""Decides what contacts and joints do after an event; formulations without contacts bring one that does nothing."""


@internal
def _resolve(dyn, scratch, contacts, state, met):
    contacts.clock[arrays.LOGGED] = 0.0
    contacts.clock[arrays.ENERGY] = 0.0
    contacts.clock[arrays.FAILURE] = 0.0
    if contacts.place.shape[0] == 0:
        return True
    return decide(dyn, scratch, contacts, state, met)


@internal
def _find_reached(dyn, contacts, state):
    """Let the first event happen next whose value has come to zero and stays there."""
    if contacts.events.table.shape[0] > 0:
        reached = users.first_reached(dyn, contacts.events, state)
        if reached >= 0:
            contacts.clock[arrays.PENDING] = 1.0 + contacts.place.shape[0] + reached


@internal
def _begin(dyn, scratch, contacts, state):
    """Close contacts at the start and resolve velocities that they forbid; False if that is impossible."""
    contacts.clock[arrays.BEGUN] = arrays.BEGUN_NOW
    forget_pairs(dyn, scratch, contacts)
    measure(dyn, scratch, state.clock[TIME], state.y[0])
    for k in range(contacts.place.shape[0]):
        contacts.number[k, arrays.CLOSED] = 0.0
        contacts.number[k, arrays.HELD] = 0.0
        gap = contacts.place[k, arrays.KIND] == arrays.GAP
        if gap and scratch.ws.phi[contacts.place[k, arrays.ROW]] * contacts.number[k, arrays.SCALE] < -INSIDE:
            return False
    if contacts.events.table.shape[0] > 0:
        users.begin_sides(contacts.events, state)
    if not _resolve(dyn, scratch, contacts, state, -1):
        return False
    _restart(dyn, scratch, contacts, state)
    _find_reached(dyn, contacts, state)
    return True


@internal
def _has_room(contacts, t):
    """Count an event at a time (s); False if there are too many."""
    contacts.clock[arrays.AT_ONCE] = contacts.clock[arrays.AT_ONCE] + 1.0 if contacts.clock[arrays.WHEN] == t else 1.0
    contacts.clock[arrays.WHEN] = t
    contacts.clock[arrays.MET] += 1.0
    few = contacts.clock[arrays.MET] <= MOST or contacts.clock[arrays.PAUSES] != arrays.NEVER
    return contacts.clock[arrays.AT_ONCE] <= AT_ONE_TIME and few


@internal
def _go_to(own, scratch, state, contacts, stepping, t):
    """Bring the state to the time t (s) within its step, at which contacts.trial often stands already."""
    following = contacts.before.count[NEXT]
    t_out = stepping.out.t
    outputs = following < t_out.shape[0] and t_out[following] <= t
    if contacts.clock[arrays.FAILURE] == 0.0 and contacts.trial.clock[TIME] == t and not outputs:
        copy_state(state, contacts.trial)
        state.count[NEXT] = following
        return
    copy_state(state, contacts.before)
    if contacts.clock[arrays.FAILURE] == 0.0 and t > state.clock[TIME]:
        status = advance_to(own, scratch, state, contacts, stepping, t, NO_LIMIT)
        if status != REACHED and status != PAUSED:
            contacts.clock[arrays.FAILURE] = status


@internal
def _end(dyn, scratch, state, contacts, out):
    """Make the outputs that are left the state itself, at which an event of the user ends the simulation."""
    first = state.count[NEXT]
    while state.count[NEXT] < out.t.shape[0]:
        record_here(scratch, state, out)
    if contacts.clock[arrays.SHARING] > 0.0:
        share_outputs(dyn, scratch, contacts, out, first, state.count[NEXT])


@internal
def _step(dyn, scratch, state, contacts, stepping, end):
    """Take one step, or part of one up to an event, which then is PENDING; returns a status."""
    if contacts.repeated.place.shape[0] > 0:
        look(dyn, scratch, contacts.repeated, state, 1)
    own = dyn if any_held(contacts) else without_contacts(dyn, contacts)
    cross(state, stepping.before, stepping.after)
    begin_run(own, scratch, state)
    if contacts.events.table.shape[0] > 0:
        users.find_sides(dyn, contacts.events, state)
    copy_state(contacts.before, state)
    status = advance_to(own, scratch, state, contacts, stepping, end, 1)
    if status != REACHED and status != PAUSED:
        return status
    met = -1
    contacts.clock[arrays.FAILURE] = 0.0
    if state.clock[TIME] > contacts.before.clock[TIME]:
        fit(dyn, contacts, state)
        contacts.trial.clock[TIME] = -math.inf
        met = first_met(dyn, scratch, state, contacts, stepping)
    if met >= 0:
        t = event_time(dyn, scratch, contacts, stepping, met)
        _go_to(own, scratch, state, contacts, stepping, t)
    if contacts.clock[arrays.SHARING] > 0.0:
        share_outputs(dyn, scratch, contacts, stepping.out, contacts.before.count[NEXT], state.count[NEXT])
    if contacts.clock[arrays.FAILURE] != 0.0:
        return int(contacts.clock[arrays.FAILURE])
    if met < 0:
        return REACHED if status == REACHED and state.clock[TIME] >= end else PAUSED
    begin_run(own, scratch, state)
    contacts.clock[arrays.PENDING] = 1.0 + met
    return FOUND


@internal
def _jump(dyn, scratch, state, contacts, out):
    """Let what is PENDING happen at the state; returns a status."""
    clock = contacts.clock
    count = contacts.place.shape[0]
    met = int(clock[arrays.PENDING]) - 1
    passed = users.HAPPENED
    if met >= count and clock[arrays.ACTED] != 0.0:
        users.finish_action(dyn, scratch, contacts, state, met - count)
    elif met >= count:
        passed = users.happen(dyn, scratch, contacts, state, met - count)
        if passed == users.ACTS:
            return ACTING
    clock[arrays.WHICH] = 0.0 if passed == users.PASSED else 1.0 + met
    clock[arrays.PENDING] = 0.0
    clock[arrays.ACTED] = 0.0
    if passed == users.ENDED:
        if clock[arrays.PAUSES] == arrays.NEVER:
            _end(dyn, scratch, state, contacts, out)
        else:
            share_here(dyn, scratch, contacts, state)
        return OVER
    if passed != users.PASSED:
        if not _has_room(contacts, state.clock[TIME]):
            return TOO_MANY
        if not _resolve(dyn, scratch, contacts, state, met if met < count else -1):
            return NOT_SOLVED
    _restart(dyn, scratch, contacts, state)
    _find_reached(dyn, contacts, state)
    return JUMPED


@lazy(int)
def _go_on(dyn, scratch, state, settings, contacts, out, end, steps, before, after):
    clock = contacts.clock
    stepping = arrays.Stepping(settings, out, before, after)
    hold_rows(dyn, contacts)
    hold_independent(dyn, contacts.repeated)
    if contacts.events.release.shape[0] > 0:
        users.hold_joints(dyn, contacts)
    if clock[arrays.BEGUN] == arrays.RESUMED:
        clock[arrays.BEGUN] = arrays.BEGUN_NOW
        _restart(dyn, scratch, contacts, state)
    if clock[arrays.BEGUN] == arrays.NOT_BEGUN:
        if not _begin(dyn, scratch, contacts, state):
            return NOT_SOLVED
        if clock[arrays.PAUSES] != arrays.NEVER:
            return JUMPED
    taken = 0
    while True:
        if clock[arrays.PENDING] == 0.0:
            if taken >= steps:
                return PAUSED
            taken += 1
            status = _step(dyn, scratch, state, contacts, stepping, end)
            if status == PAUSED:
                continue
            if status != FOUND:
                return status
            if clock[arrays.PAUSES] == arrays.BEFORE_AND_AFTER:
                share_here(dyn, scratch, contacts, state)
                return FOUND
        status = _jump(dyn, scratch, state, contacts, out)
        if status != JUMPED:
            return status
        if clock[arrays.PAUSES] != arrays.NEVER:
            share_here(dyn, scratch, contacts, state)
            return JUMPED


@inlined
def _none(dyn, scratch, state, settings, contacts, out, end, steps, before, after):
    return NOT_SOLVED


go_on = alternatives({Embedding: _none}, _go_on)
"""Go on to ``end`` (s), ``steps`` steps at most, meeting events; returns a status of ``advance``, or one of these."""


@kernel
def run_events(dyn, scratch, state, settings, contacts, out, end, steps, before, after):
    """Call ``go_on`` in reference coordinates, from Python."""
    return _go_on(dyn, scratch, state, settings, contacts, out, end, steps, before, after)
