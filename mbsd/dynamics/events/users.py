"""Events of the user in the compiled loop: their arrays, their values at a state, and their actions.

Functions get positions and rates of frames. An event is noted, ends the simulation, changes velocities, or releases
joints. Rows of J of a released joint hold no more, for good, and it has no friction;
rows that repeat them hold instead. What functions get is chosen by the class of the arrays, so that it costs nothing: a
formulation with other coordinates brings its own class, and adds its kernels by ``read_frames.add`` and
``move_frames.add``.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.callback import SIGNATURE, call
from mbsd.compiling.jit import apart, at_address, internal, lazy
from mbsd.dynamics import repeated_rows
from mbsd.dynamics.events.arrays import CLOSED, FRICTION, HELD, RELEASED, SIGN
from mbsd.dynamics.events.rows import release_rows
from mbsd.dynamics.formulation import bends, project
from mbsd.dynamics.repeated_rows import take_over
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import NONE, SENSE

AHEAD = (1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
"""Parts of the duration after which the side is looked for to which an event that is zero goes."""
BEYOND = (1e-6, 1e-5, 1e-4, 1e-3)
"""Times (s) after which it is looked for where a duration is too short to tell."""

VALUE, FIRST, FRAMES, DIRECTION, ENDS, ACTION, ACTION_FIRST, ACTION_FRAMES = range(8)
"""Columns of Events.table: address of the function; its first frame, and how many it has; rising 1, falling -1, both 0;
whether the simulation ends there; address of the action, 0 where there is none; its frames."""
WHOLE = -1
"""Number of frames of a function that gets all coordinates and velocities."""
BY_PYTHON = -1
"""Address of an action that Python lets act while the loop waits."""
SIDE, LEVEL, SHORTEST, UNKNOWN = range(4)
"""Columns of Events.number: sign of the value, 0 where that is zero; what is taken off the function's number; how long
the shortest thing in it lasts (s), 0 where nothing is said; how many values did not tell how it goes in a
step, 0 while all did."""
GROUP, ROW, BLOCK, SIDE_OF_BLOCK, OPEN_BLOCK, OPEN_SIDE, ITS_FRICTION = range(7)
"""Columns of Events.release: the event, or a number behind all events for a joint that actions in Python may release; a
row of J that is released; its block and its place there in Schur.rows, and
the same without contacts; the row of a friction of its joint in Loads.friction. -1: there is none."""


class Events(NamedTuple):
    """e events with f frames, of a mechanism of nb bodies."""

    table: Any
    """(e, 8) int"""
    number: Any
    """(e, 4)"""
    gone: Any
    """(g,) when (s) each group of rows was released, infinite before."""
    release: Any
    """(r, 7) int"""
    body: Any
    """(f,) int"""
    arm: Any
    """(f, 3) from the centre of mass in the body's axes (m), and angle (rad)."""
    inputs: Any
    """(i,) of a function: places of its frames, then their rates."""
    outputs: Any
    """(o,)"""
    near: Any
    """(4,) parts of the time by which it changes by what counts as nothing."""
    away: Any
    """(4, 3 nb) the same for coordinates and velocities, to be added."""
    span: Any
    """(1,) duration (s)."""
    pose: Any
    """(2, 3 nb)"""
    bend: Any
    """(3 nb,) q'' at a state."""
    parts: Any
    """(n,) parts of a step, rising, at which an event is looked at."""
    values: Any
    """(n,) its values there, with the sign of its side."""
    more: Any
    """(2, n) the same while more are put between them."""
    there: Any
    """(2, n) values in the middle of intervals, and by how much they are not those that neighbours let expect."""
    rough: Any
    """(2, n) int, flags of intervals that are not known well enough; now and next."""
    skipped: Any
    """(e,) int"""


@internal
def _read_frames(events, first, count, q, v):
    """Fill events.inputs with places and rates of frames at q, v (3 nb,), as events/moment.py gives them.

    With a count of WHOLE they are q and v themselves.
    """
    inputs = events.inputs
    if count == WHOLE:
        for c in range(q.shape[0]):
            inputs[c] = q[c]
            inputs[q.shape[0] + c] = v[c]
        return
    for i in range(count):
        b = 3 * events.body[first + i]
        arm = events.arm[first + i]
        c = math.cos(q[b + 2])
        s = math.sin(q[b + 2])
        x = c * arm[0] - s * arm[1]
        y = s * arm[0] + c * arm[1]
        at = 3 * i
        inputs[at] = q[b] + x
        inputs[at + 1] = q[b + 1] + y
        inputs[at + 2] = q[b + 2] + arm[2]
        at += 3 * count
        inputs[at] = v[b] - v[b + 2] * y
        inputs[at + 1] = v[b + 1] + v[b + 2] * x
        inputs[at + 2] = v[b + 2]


@internal
def _move_frames(events, first, count, q, v):
    """Let v (3 nb,) at q be such that frames move by events.outputs, where they stand at events.inputs."""
    for i in range(count):
        b = 3 * events.body[first + i]
        omega = events.outputs[3 * i + 2]
        v[b] = events.outputs[3 * i] + omega * (events.inputs[3 * i + 1] - q[b + 1])
        v[b + 1] = events.outputs[3 * i + 1] - omega * (events.inputs[3 * i] - q[b])
        v[b + 2] = omega


read_frames = alternatives({}, _read_frames)
move_frames = alternatives({}, _move_frames)


@apart
def value_of(events, e, t, q, v):
    """Return the value of event e at q, v (3 nb,) and t (s)."""
    read_frames(events, events.table[e, FIRST], events.table[e, FRAMES], q, v)
    call(events.table[e, VALUE], t, events.inputs, events.outputs)  # pyright: ignore[reportCallIssue]
    return events.outputs[0] - events.number[e, LEVEL]


@internal
def signed(events, e, t, y):
    """Return the value of event e at y (2, 3 nb) with the sign of its side: not negative now, it falls through zero."""
    side = -1.0 if events.number[e, SIDE] < 0.0 else 1.0
    return side * value_of(events, e, t, y[0], y[1])


@apart
def rounding_of(events, e, t, y, part):
    """Return how much the value of event e at t (s) and y (2, 3 nb) changes with ``part`` of what counts as nothing."""
    value = value_of(events, e, t, y[0], y[1])
    pose = events.pose
    most = 0.0
    for k in range(events.away.shape[0]):
        for side in range(2):
            for c in range(pose.shape[1]):
                pose[side, c] = y[side, c] + part * events.away[k, c]
        most = max(most, abs(value_of(events, e, t * (1.0 + part * events.near[k]), pose[0], pose[1]) - value))
    return most


@apart
def _side(events, e, t, y):
    value = value_of(events, e, t, y[0], y[1])
    if abs(value) <= rounding_of(events, e, t, y, 1.0) or value == 0.0:
        return 0.0
    return 1.0 if value > 0.0 else -1.0


@apart
def _side_ahead(dyn, events, e, t, y, dy):
    """Return the sign that an event whose value is zero has next; 0 if it stays zero. dy (2, n) is d(y)/dt."""
    side = _side(events, e, t, y)
    if side != 0.0:
        return side
    rounding = rounding_of(events, e, t, y, 1.0)
    pose = events.pose
    bend = events.bend
    bends(dyn, y, dy, bend)
    last = AHEAD[-1] * events.span[0]
    for k in range(len(AHEAD) + len(BEYOND)):
        s = AHEAD[k] * events.span[0] if k < len(AHEAD) else BEYOND[k - len(AHEAD)]
        if k >= len(AHEAD) and s <= last:
            continue
        for c in range(pose.shape[1]):
            pose[0, c] = y[0, c] + s * dy[0, c] + s * s / 2 * bend[c]
            pose[1, c] = y[1, c] + s * dy[1, c]
        ahead = value_of(events, e, t + s, pose[0], pose[1])
        if abs(ahead) > 10.0 * rounding:
            return 1.0 if ahead > 0.0 else -1.0
    return 0.0


@lazy(int)
def first_reached(dyn, events, state):
    """Return the first event that is watched and whose value has come to zero and stays there; -1: none."""
    for e in range(events.table.shape[0]):
        if events.number[e, SIDE] == 0.0:
            continue
        if _side_ahead(dyn, events, e, state.clock[TIME], state.y, state.dy) == 0.0:
            return e
    return -1


@internal
def turn_side(dyn, events, e, state):
    """Turn the side of an event that has just passed zero; none where its value stays there."""
    stays = _side_ahead(dyn, events, e, state.clock[TIME], state.y, state.dy) == 0.0
    events.number[e, SIDE] = 0.0 if stays else -events.number[e, SIDE]


@lazy(None)
def begin_sides(events, state):
    """Find on which side all events are at the start."""
    for e in range(events.table.shape[0]):
        events.number[e, SIDE] = _side(events, e, state.clock[TIME], state.y)


@lazy(None)
def find_sides(dyn, events, state):
    """Find to which side events go that are zero; none where they stay so."""
    for e in range(events.table.shape[0]):
        if events.number[e, SIDE] == 0.0:
            events.number[e, SIDE] = _side_ahead(dyn, events, e, state.clock[TIME], state.y, state.dy)


@at_address(SIGNATURE)
def turned(t, inputs, outputs):
    """Put out the angle of one frame (rad)."""
    outputs[0] = inputs[2]


@at_address(SIGNATURE)
def turning(t, inputs, outputs):
    """Put out the angular velocity of one frame (rad/s)."""
    outputs[0] = inputs[5]


@at_address(SIGNATURE)
def distance(t, inputs, outputs):
    """Put out the distance of two frames (m)."""
    outputs[0] = math.hypot(inputs[3] - inputs[0], inputs[4] - inputs[1])


REPEATED_HELD, UNTIL, NO_MORE = repeated_rows.HELD, repeated_rows.UNTIL, repeated_rows.GONE


@internal
def _set_row(dyn, contacts, k, row):
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
        _set_row(dyn, contacts, k, release[k, ROW])
    for k in range(release.shape[0]):  # afterwards, as several events may release one joint
        if events.gone[release[k, GROUP]] < math.inf:
            _set_row(dyn, contacts, k, -1)


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


@internal
def act(events, e, t, q, v):
    """Let the compiled action of event e change v (n,)."""
    first = events.table[e, ACTION_FIRST]
    count = events.table[e, ACTION_FRAMES]
    read_frames(events, first, count, q, v)
    call(events.table[e, ACTION], t, events.inputs, events.outputs)  # pyright: ignore[reportCallIssue]
    move_frames(events, first, count, q, v)


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
    if table[e, ACTION] != 0:
        act(events, e, state.clock[TIME], state.y[0], state.y[1])
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
