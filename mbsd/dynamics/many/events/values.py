"""Values of events at a state: their functions get places and rates of frames."""

from __future__ import annotations

import math

from mbsd.compiling.callback import call
from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.many.events.arrays import FIRST, FRAMES, LEVEL, SIDE, VALUE, WHOLE


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
    """The value of event e at q, v (3 nb,) and t (s)."""
    read_frames(events, events.table[e, FIRST], events.table[e, FRAMES], q, v)
    call(events.table[e, VALUE], t, events.inputs, events.outputs)  # pyright: ignore[reportCallIssue]
    return events.outputs[0] - events.number[e, LEVEL]


@internal
def signed(events, e, t, y):
    """The same at y (2, 3 nb), with the sign of its side: it is not negative now, and falls through zero."""
    side = -1.0 if events.number[e, SIDE] < 0.0 else 1.0
    return side * value_of(events, e, t, y[0], y[1])
