"""Values of events at a state: their functions get positions and rates of frames; ready-made functions are below."""

from __future__ import annotations

import math

from mbsd.compiling.callback import SIGNATURE, call
from mbsd.compiling.jit import apart, at_address, internal, lazy
from mbsd.dynamics.events.bounds import AHEAD, BEYOND
from mbsd.dynamics.events.users.arrays import FIRST, FRAMES, LEVEL, SIDE, VALUE, WHOLE
from mbsd.dynamics.formulation import bends
from mbsd.dynamics.state import TIME


@internal
def read_frames(events, first, count, q, v):
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
