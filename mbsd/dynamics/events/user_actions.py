"""Actions of the user's events: one is noted, ends the simulation, changes velocities, or releases joints.

Rows of J of a released joint hold no more, for good, and it has no friction. Rows that repeat them hold instead.
"""

from __future__ import annotations

import math

from mbsd.compiling.callback import call
from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.arrays import CLOSED, FRICTION, HELD, RELEASED, SIGN
from mbsd.dynamics.events.rows import release_rows
from mbsd.dynamics.events.users.arrays import (
    ACTION,
    ACTION_FIRST,
    ACTION_FRAMES,
    BLOCK,
    BY_PYTHON,
    DIRECTION,
    ENDS,
    GROUP,
    ITS_FRICTION,
    OPEN_BLOCK,
    OPEN_SIDE,
    ROW,
    SIDE,
    SIDE_OF_BLOCK,
)
from mbsd.dynamics.events.users.values import read_frames, turn_side
from mbsd.dynamics.formulation import project
from mbsd.dynamics.repeated_rows import arrays as repeated_arrays
from mbsd.dynamics.repeated_rows.exchange import take_over
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import NONE, SENSE

REPEATED_HELD, UNTIL, NO_MORE = repeated_arrays.HELD, repeated_arrays.UNTIL, repeated_arrays.GONE


@internal
def _put(dyn, contacts, k, row):
    """Put a row, or -1, where the k-th that may be released stands."""
    release = contacts.events.release
    if release[k, BLOCK] >= 0:
        dyn.schur.rows[release[k, BLOCK], release[k, SIDE_OF_BLOCK]] = row
    if release[k, OPEN_BLOCK] >= 0:
        contacts.schur.rows[release[k, OPEN_BLOCK], release[k, OPEN_SIDE]] = row


@internal
def _end_friction(dyn, contacts, at):
    """Let friction ``at`` be none; nothing more happens to a joint that sticks."""
    dyn.loads.friction_number[at, SENSE] = NONE
    for k in range(contacts.place.shape[0]):
        if contacts.place[k, FRICTION] == at:
            contacts.number[k, CLOSED] = 0.0
            contacts.number[k, HELD] = 0.0
            contacts.number[k, SIGN] = 0.0
            contacts.number[k, RELEASED] = 1.0


@lazy(None)
def hold_joints(dyn, contacts):
    """Let the rows of joints hold that no event has released, where none repeat others."""
    events = contacts.events
    release = events.release
    if contacts.repeated.place.shape[0] > 0:
        return
    for k in range(release.shape[0]):
        _put(dyn, contacts, k, release[k, ROW])
    for k in range(release.shape[0]):  # afterwards, as several events may release one joint
        if events.gone[release[k, GROUP]] < math.inf:
            _put(dyn, contacts, k, -1)


@lazy(None)
def release_joints(dyn, scratch, contacts, group, t, q):
    """Release the joints of a group at t (s) and q (3 nb,); rows that repeat theirs hold from then on."""
    events = contacts.events
    repeated = contacts.repeated
    events.gone[group] = min(events.gone[group], t)
    for k in range(events.release.shape[0]):
        if events.release[k, GROUP] != group:
            continue
        if events.release[k, ITS_FRICTION] >= 0:
            _end_friction(dyn, contacts, events.release[k, ITS_FRICTION])
        if repeated.place.shape[0] > 0:
            row = events.release[k, ROW]
            repeated.number[row, REPEATED_HELD] = NO_MORE
            repeated.number[row, UNTIL] = min(repeated.number[row, UNTIL], t)
    if repeated.place.shape[0] > 0:
        take_over(dyn, scratch, repeated, t, q)
    else:
        hold_joints(dyn, contacts)


PASSED, HAPPENED, ENDED, ACTS = range(4)
"""It passed zero the other way; it happened; the simulation ends there; it happens once its Python action has acted."""


@lazy(int)
def happen(dyn, scratch, contacts, state, e):
    """Let event e happen at a state, whose function has just passed zero there."""
    events = contacts.events
    table = events.table
    side = -1 if events.number[e, SIDE] < 0.0 else 1
    turn_side(dyn, events, e, state)
    if table[e, DIRECTION] != 0 and table[e, DIRECTION] != -side:
        return PASSED
    if table[e, ENDS] != 0:
        return ENDED
    if table[e, ACTION] == BY_PYTHON:
        return ACTS
    releases = False
    for k in range(events.release.shape[0]):
        releases = releases or events.release[k, GROUP] == e
    v = state.y[1]
    if table[e, ACTION] != 0:
        first = table[e, ACTION_FIRST]
        count = table[e, ACTION_FRAMES]
        read_frames(events, first, count, state.y[0], v)
        call(table[e, ACTION], state.clock[TIME], events.inputs, events.outputs)  # pyright: ignore[reportCallIssue]
        for i in range(count):
            b = 3 * events.body[first + i]
            x = events.inputs[3 * i] - state.y[0, b]
            y = events.inputs[3 * i + 1] - state.y[0, b + 1]
            omega = events.outputs[3 * i + 2]
            v[b] = events.outputs[3 * i] + omega * y
            v[b + 1] = events.outputs[3 * i + 1] - omega * x
            v[b + 2] = omega
    if releases:
        release_joints(dyn, scratch, contacts, e, state.clock[TIME], state.y[0])
    if releases or table[e, ACTION] != 0:
        release_rows(dyn, contacts)
        project(dyn, scratch, state.clock[TIME], state.y, 2)
        events.number[e, SIDE] = 0.0  # it may go back to where it came from
    return HAPPENED


@lazy(None)
def finish_action(dyn, scratch, contacts, state, e):
    """Release the joints that the Python action of event e released, and bring velocities onto the others."""
    events = contacts.events
    t = state.clock[TIME]
    for group in range(events.gone.shape[0]):
        if events.gone[group] == t:
            release_joints(dyn, scratch, contacts, group, t, state.y[0])
    release_rows(dyn, contacts)
    project(dyn, scratch, t, state.y, 2)
    events.number[e, SIDE] = 0.0  # it may go back to where it came from
