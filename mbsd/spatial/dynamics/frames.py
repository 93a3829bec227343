"""Frames as compiled functions of events read and change them: events of the user in space.

Of f frames a function gets

    q (7 f,)    place (m) and Euler parameters (w, x, y, z) of each frame in turn
    v (6 f,)    velocity (m/s) and angular velocity (rad/s) of each, in the world

and an action gives new velocities, 6 numbers a frame: r' = v - w x s, w in body axes.
"""

from __future__ import annotations

from collections import namedtuple

from mbsd.compiling.jit import inlined, internal
from mbsd.dynamics.events.loop import decide
from mbsd.dynamics.events.outlines import end_at_corners, forget_pairs
from mbsd.dynamics.events.users import WHOLE, Events, move_frames, read_frames
from mbsd.spatial.dynamics.formulation import SpaceDynamics

SpaceEvents = namedtuple("SpaceEvents", Events._fields)
"""Events of the user with frames in space. ``arm`` (f, 7): place from the centre of mass in principal axes (m), and
Euler parameters from the frame to principal axes."""


@internal
def turn(e, s, out):
    """Fill out (3,) with a vector s (3,) turned by Euler parameters e (4,) of any length."""
    n = 2.0 / (e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3])
    x = e[2] * s[2] - e[3] * s[1] + e[0] * s[0]
    y = e[3] * s[0] - e[1] * s[2] + e[0] * s[1]
    z = e[1] * s[1] - e[2] * s[0] + e[0] * s[2]
    out[0] = s[0] + n * (e[2] * z - e[3] * y)
    out[1] = s[1] + n * (e[3] * x - e[1] * z)
    out[2] = s[2] + n * (e[1] * y - e[2] * x)


@internal
def _read_frames(events, first, count, q, v):
    inputs = events.inputs
    if count == WHOLE:
        for c in range(q.shape[0]):
            inputs[c] = q[c]
            inputs[q.shape[0] + c] = v[c]
        return
    for i in range(count):
        b = events.body[first + i]
        own = events.arm[first + i]
        at = 7 * i
        rate = 7 * count + 6 * i
        if b == 0:
            for k in range(7):
                inputs[at + k] = own[k]
            for k in range(6):
                inputs[rate + k] = 0.0
            continue
        c = 7 * b - 4
        d = 6 * b - 3
        e = q[c + 3 : c + 7]
        turn(e, own[:3], inputs[at : at + 3])
        turn(e, v[d + 3 : d + 6], inputs[rate + 3 : rate + 6])
        s = inputs[at : at + 3]
        w = inputs[rate + 3 : rate + 6]
        inputs[rate] = v[d] + w[1] * s[2] - w[2] * s[1]
        inputs[rate + 1] = v[d + 1] + w[2] * s[0] - w[0] * s[2]
        inputs[rate + 2] = v[d + 2] + w[0] * s[1] - w[1] * s[0]
        for k in range(3):
            inputs[at + k] += q[c + k]
        o = own[3:]
        inputs[at + 3] = e[0] * o[0] - e[1] * o[1] - e[2] * o[2] - e[3] * o[3]
        inputs[at + 4] = e[0] * o[1] + e[1] * o[0] + e[2] * o[3] - e[3] * o[2]
        inputs[at + 5] = e[0] * o[2] + e[2] * o[0] + e[3] * o[1] - e[1] * o[3]
        inputs[at + 6] = e[0] * o[3] + e[3] * o[0] + e[1] * o[2] - e[2] * o[1]


@internal
def _move_frames(events, first, count, q, v):
    for i in range(count):
        b = events.body[first + i]
        c = 7 * b - 4
        d = 6 * b - 3
        given = events.outputs[6 * i : 6 * i + 6]
        w = given[3:]
        x = events.inputs[7 * i] - q[c]
        y = events.inputs[7 * i + 1] - q[c + 1]
        z = events.inputs[7 * i + 2] - q[c + 2]
        v[d] = given[0] - w[1] * z + w[2] * y
        v[d + 1] = given[1] - w[2] * x + w[0] * z
        v[d + 2] = given[2] - w[0] * y + w[1] * x
        e = q[c + 3 : c + 7]
        for k in range(1, 4):  # the inverse rotation
            e[k] = -e[k]
        turn(e, w, v[d + 3 : d + 6])
        for k in range(1, 4):
            e[k] = -e[k]


@inlined
def _decide_nothing(dyn, scratch, contacts, state, met):
    return True


@inlined
def _without_outlines(dyn, scratch, contacts):
    pass


decide.add(SpaceDynamics, _decide_nothing)
end_at_corners.add(SpaceDynamics, _without_outlines)
forget_pairs.add(SpaceDynamics, _without_outlines)
read_frames.add(SpaceEvents, _read_frames)
move_frames.add(SpaceEvents, _move_frames)
