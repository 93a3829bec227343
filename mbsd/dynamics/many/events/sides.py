"""The side of zero on which events are: their value, what of it is rounding, where it goes next.

A value is zero if it changes by no less where the state changes by what counts as no distance. The side of a value that
is zero is that of its next values, along the motion's own acceleration; none where it stays zero.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.events.bounds import AHEAD, BEYOND
from mbsd.dynamics.many.events.arrays import SIDE
from mbsd.dynamics.many.events.values import value_of
from mbsd.dynamics.state import TIME


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
def _side_ahead(events, e, t, y, a):
    """The sign that an event whose value is zero has next; 0 if it stays zero. a: accelerations (3 nb,)."""
    side = _side(events, e, t, y)
    if side != 0.0:
        return side
    rounding = rounding_of(events, e, t, y, 1.0)
    pose = events.pose
    last = AHEAD[-1] * events.span[0]
    for k in range(len(AHEAD) + len(BEYOND)):
        s = AHEAD[k] * events.span[0] if k < len(AHEAD) else BEYOND[k - len(AHEAD)]
        if k >= len(AHEAD) and s <= last:
            continue
        for c in range(pose.shape[1]):
            pose[0, c] = y[0, c] + s * y[1, c] + s * s / 2 * a[c]
            pose[1, c] = y[1, c] + s * a[c]
        ahead = value_of(events, e, t + s, pose[0], pose[1])
        if abs(ahead) > 10.0 * rounding:
            return 1.0 if ahead > 0.0 else -1.0
    return 0.0


@lazy(int)
def first_reached(events, state):
    """The first event that is watched and whose value has come to zero and stays there, as _meet_reached; -1: none."""
    for e in range(events.table.shape[0]):
        if events.number[e, SIDE] == 0.0:
            continue
        if _side_ahead(events, e, state.clock[TIME], state.y, state.dy[1]) == 0.0:
            return e
    return -1


@internal
def turn_side(events, e, state):
    """The side of an event that has just passed zero: none where its value stays there."""
    stays = _side_ahead(events, e, state.clock[TIME], state.y, state.dy[1]) == 0.0
    events.number[e, SIDE] = 0.0 if stays else -events.number[e, SIDE]


@lazy(None)
def begin_sides(events, state):
    """On which side all events are at the start."""
    for e in range(events.table.shape[0]):
        events.number[e, SIDE] = _side(events, e, state.clock[TIME], state.y)


@lazy(None)
def find_sides(events, state):
    """To which side those go that are zero; none of those that stay so."""
    for e in range(events.table.shape[0]):
        if events.number[e, SIDE] == 0.0:
            events.number[e, SIDE] = _side_ahead(events, e, state.clock[TIME], state.y, state.dy[1])
