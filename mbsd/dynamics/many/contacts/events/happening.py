"""What an event of the user does: it is noted, ends the simulation, changes velocities, or releases joints."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.compiling.jit import lazy
from mbsd.dynamics.many.contacts.events.releases import release_joints
from mbsd.dynamics.many.contacts.rows import release_rows
from mbsd.dynamics.many.events.arrays import (
    ACTION,
    ACTION_FIRST,
    ACTION_FRAMES,
    BY_PYTHON,
    DIRECTION,
    ENDS,
    GROUP,
    SIDE,
)
from mbsd.dynamics.many.events.sides import turn_side
from mbsd.dynamics.many.events.values import read_frames
from mbsd.dynamics.reference.projection import project
from mbsd.dynamics.state import TIME

PASSED, HAPPENED, ENDED, ACTS = range(4)
"""It passed zero the other way; it happened; the simulation ends there; it happens once its Python action has acted."""


@lazy(int)
def happen(dyn, scratch, contacts, state, e):
    """Let event e happen at a state, whose function has just passed zero there."""
    events = contacts.events
    table = events.table
    side = -1 if events.number[e, SIDE] < 0.0 else 1
    turn_side(events, e, state)
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
    """Release the joints that the Python action of event e has let go, and bring velocities onto the others."""
    events = contacts.events
    t = state.clock[TIME]
    for group in range(events.gone.shape[0]):
        if events.gone[group] == t:
            release_joints(dyn, scratch, contacts, group, t, state.y[0])
    release_rows(dyn, contacts)
    project(dyn, scratch, t, state.y, 2)
    events.number[e, SIDE] = 0.0  # it may go back to where it came from
