"""The compiled evaluation of all forces.

Elements and terms are those of mbsd/model/force.py. Interactions and forces of the user (model/forces/user_force.py)
are called by the address of a function, so that nobody compiles what his model does not use.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.codes import AXIS, CONSTANT, DAMPING, DRY, LAW_RATE, LAW_TIME, LINE, LINEAR, POWER, PUSH, TURN
from mbsd.compiling.callback import call
from mbsd.compiling.jit import inlined, kernel, lazy
from mbsd.equations.interactions.evaluation import apply_interactions
from mbsd.equations.interactions.switching import APPROACHED, REMEMBERS
from mbsd.equations.laws import law_at
from mbsd.equations.system import place


class Loads(NamedTuple):
    """All forces; ``number`` may be changed between runs."""

    element: Any
    """(e, 5) kind, body i, body j, first term, end of the terms."""
    place: Any
    """(e, 6) arm of i, axis of i, arm of j, in body axes from the centres of mass."""
    term: Any
    """(k, 2) kind, law."""
    number: Any
    """(k, 3) a, b, c."""
    law: Any
    """(3,) scratch of a law."""
    interaction: Any
    """(n, 9) body i, body j, law of time, first number, address of the function, that of the evaluation, crank, the
    first body that holds a state of the force, how many do."""
    given: Any
    """Numbers of each interaction: arm and axis of i, arm of j (body axes), angle of j less that of i, then its own."""
    state: Any
    """(29,) what the function of an interaction reads."""
    switch: Any
    """(1 + n, 12) sides of the interactions that switch, see interactions/switching.py."""
    user: Any
    """(u, 3) forces of the user: address, first of user_body, count."""
    user_body: Any
    """(b,)"""
    user_com: Any
    """(b, 2) centres of mass in the author's frames."""
    exchange: Any
    """(2, n) inputs and outputs of a user's force on k bodies, 6 k, or of an interaction."""
    friction: Any
    """(f, 7) joints with friction; columns in joint_friction.py."""
    friction_number: Any
    """(f, 8)"""
    normal: Any
    """(4, f) their normal forces now, and scratch of the iteration."""
    iteration: Any
    """(3,) weight of the iteration's steps, whether it failed, and the largest normal force that it began with."""
    total: int
    """Number of all elements, interactions and forces of the user; friction is not among them."""


@inlined
def arm_of(cos_sin, body, x, y):
    """Return the arm (x, y) in the axes of a body, turned into those of ground."""
    c = cos_sin[body, 0]
    s = cos_sin[body, 1]
    return c * x - s * y, s * x + c * y


@inlined
def between(kind, axis, arm_i, arm_j, i, j, t, q, v):
    """Return the direction of a force, the vector from marker i to j, its length x along it, and dx/dt.

    A push acts on body j alone: its x is the time, and its rate is the speed of marker j.
    """
    ux, uy = axis
    dx = q[3 * j] + arm_j[0] - q[3 * i] - arm_i[0]
    dy = q[3 * j + 1] + arm_j[1] - q[3 * i + 1] - arm_i[1]
    vx = v[3 * j] - v[3 * j + 2] * arm_j[1]
    vy = v[3 * j + 1] + v[3 * j + 2] * arm_j[0]
    if kind == PUSH:
        return (ux, uy), (dx, dy), t, ux * vx + uy * vy
    vx -= v[3 * i] - v[3 * i + 2] * arm_i[1]
    vy -= v[3 * i + 1] + v[3 * i + 2] * arm_i[0]
    if kind == LINE:
        x = math.sqrt(dx * dx + dy * dy)
        ux = dx / x if x > 0.0 else 0.0
        uy = dy / x if x > 0.0 else 0.0
        return (ux, uy), (dx, dy), x, ux * vx + uy * vy
    return (ux, uy), (dx, dy), ux * dx + uy * dy, ux * vx + uy * vy + v[3 * i + 2] * (-uy * dx + ux * dy)


@inlined
def effort(term, number, first, end, laws, law, t, x, rate):
    """Return the sum of the terms ``first`` to ``end`` at a length or angle x and its rate (N, N m)."""
    force = 0.0
    for k in range(first, end):
        what = term[k, 0]
        a = number[k, 0]
        b = number[k, 1]
        if what == CONSTANT:
            force += a
        elif what == LINEAR:
            force -= a * (x - b)
        elif what == DAMPING:
            force -= a * rate
        elif what == POWER:
            force += a * (x + b) ** number[k, 2]
        elif what == DRY:
            force -= a * math.tanh(rate / b)
        else:
            at = x
            if what == LAW_RATE:
                at = rate
            elif what == LAW_TIME:
                at = t
            law_at(laws, term[k, 1], at, law)
            force += a * law[0]
    return force


@inlined
def push_apart(kind, force, axis, gap, arm_i, arm_j, i, j, load):
    """Add a force along ``axis`` on body j and, unless it is a push, its reaction on body i."""
    fx = force * axis[0]
    fy = force * axis[1]
    load[3 * j] += fx
    load[3 * j + 1] += fy
    load[3 * j + 2] += fy * arm_j[0] - fx * arm_j[1]
    if kind != PUSH:
        load[3 * i] -= fx
        load[3 * i + 1] -= fy
        load[3 * i + 2] -= fy * arm_i[0] - fx * arm_i[1]
        if kind == AXIS:
            load[3 * i + 2] += force * (axis[0] * gap[1] - axis[1] * gap[0])


@inlined
def apply_elements(element, place, term, number, laws, law, t, q, v, cos_sin, load):
    """Add the generalised forces of all elements to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    Returns their power (W).
    """
    power = 0.0
    for e in range(element.shape[0]):
        kind = element[e, 0]
        i = element[e, 1]
        j = element[e, 2]
        if kind == TURN:
            rate = v[3 * j + 2] - v[3 * i + 2]
            force = effort(term, number, element[e, 3], element[e, 4], laws, law, t, q[3 * j + 2] - q[3 * i + 2], rate)
            load[3 * j + 2] += force
            load[3 * i + 2] -= force
        else:
            arm_i = arm_of(cos_sin, i, place[e, 0], place[e, 1])
            arm_j = arm_of(cos_sin, j, place[e, 4], place[e, 5])
            axis = arm_of(cos_sin, i, place[e, 2], place[e, 3])
            axis, gap, x, rate = between(kind, axis, arm_i, arm_j, i, j, t, q, v)
            force = effort(term, number, element[e, 3], element[e, 4], laws, law, t, x, rate)
            push_apart(kind, force, axis, gap, arm_i, arm_j, i, j, load)
        power += force * rate
    return power


@inlined
def apply_loads(loads, laws, t, q, v, cos_sin, load):
    """Add the generalised forces of all loads but friction to load (3 nb,).

    cos_sin (nb, 2) turns the bodies.

    Returns their power (W).
    What falls on ground is added too and means nothing.
    """
    power = apply_elements(
        loads.element, loads.place, loads.term, loads.number, laws, loads.law, t, q, v, cos_sin, load
    )
    if loads.interaction.shape[0] > 0:
        power += apply_interactions(
            loads.interaction,
            loads.given,
            loads.state,
            loads.exchange,
            loads.switch,
            laws,
            loads.law,
            t,
            q,
            v,
            cos_sin,
            load,
        )
    if loads.user.shape[0] > 0:
        power += apply_user_forces(loads.user, loads.user_body, loads.user_com, loads.exchange, t, q, v, cos_sin, load)
    return power


@kernel
def tabulate_loads(system, loads, laws, times, q, v, ws, out, power):
    """Add all forces along a motion q, v (T, 3 nb) to out (T, 3 nb); power (T,) takes theirs.

    Ground's entries mean nothing.
    """
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        power[k] = apply_loads(loads, laws, times[k], q[k], v[k], ws.cos_sin, out[k])


@lazy(float)
def apply_user_forces(user, user_body, user_com, exchange, t, q, v, cos_sin, load):
    """Add the generalised forces of all functions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    The first four are those of Loads. Returns their power (W).
    """
    given = exchange[0]
    out = exchange[1]
    power = 0.0
    for k in range(user.shape[0]):
        first = user[k, 1]
        count = user[k, 2]
        for n in range(count):
            b = user_body[first + n]
            c = cos_sin[b, 0]
            s = cos_sin[b, 1]
            x = c * user_com[first + n, 0] - s * user_com[first + n, 1]
            y = s * user_com[first + n, 0] + c * user_com[first + n, 1]
            rate = 3 * (count + n)
            given[3 * n] = q[3 * b] - x
            given[3 * n + 1] = q[3 * b + 1] - y
            given[3 * n + 2] = q[3 * b + 2]
            given[rate] = v[3 * b] + v[3 * b + 2] * y
            given[rate + 1] = v[3 * b + 1] - v[3 * b + 2] * x
            given[rate + 2] = v[3 * b + 2]
        call(user[k, 0], t, given, out)  # pyright: ignore[reportCallIssue]
        for n in range(count):
            b = user_body[first + n]
            rate = 3 * (count + n)
            fx = out[3 * n]
            fy = out[3 * n + 1]
            load[3 * b] += fx
            load[3 * b + 1] += fy
            # the frame's origin against the centre of mass
            x = given[3 * n] - q[3 * b]
            y = given[3 * n + 1] - q[3 * b + 1]
            load[3 * b + 2] += out[3 * n + 2] + x * fy - y * fx
            power += fx * given[rate] + fy * given[rate + 1] + out[3 * n + 2] * given[rate + 2]
    return power


def remembers(loads: Loads) -> bool:
    """Return True if any contact asks for the speed at which it began."""
    return bool(loads.switch[0, REMEMBERS])


def stretches(loads: Loads, approached: np.ndarray | None, count: int) -> Iterator[slice]:
    """Yield stretches of rows 0 .. ``count`` with equal approach (T, n) (m/s), set in ``loads`` meanwhile.

    With None it stays as it is.
    """
    if approached is None or not remembers(loads):
        yield slice(0, count)
        return
    own = loads.switch[1:, APPROACHED].copy()
    same = (approached[1:] == approached[:-1]) | (np.isnan(approached[1:]) & np.isnan(approached[:-1]))
    edges = [0, *(np.flatnonzero(~same.all(axis=1)) + 1).tolist(), count]
    try:
        for first, last in pairwise(edges):
            loads.switch[1:, APPROACHED] = approached[first]
            yield slice(first, last)
    finally:
        loads.switch[1:, APPROACHED] = own
