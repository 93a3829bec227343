"""The compiled evaluation of all forces.

Elements and terms as mbsd/model/force.py defines them; interactions and forces of the user by the address of a
function, so that nobody compiles what his model does not use.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.base.codes import AXIS, CONSTANT, DAMPING, DRY, LAW_RATE, LAW_TIME, LINE, LINEAR, POWER, PUSH, TURN
from mbsd.compiling.jit import inlined, kernel
from mbsd.equations.interactions.call import apply_interactions
from mbsd.equations.laws import law_at
from mbsd.equations.markers import place
from mbsd.equations.user_forces import apply_user_forces


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
    """(n, 9) body i, body j, law of time, first number, addresses of the function and of apply.py, crank, the first
    body that holds a state of the force, how many do."""
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
    """(2,) weight of the iteration's steps, and whether it failed."""
    total: int
    """Number of all elements, interactions and forces of the user; friction is not among them."""


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
        bi = 3 * i
        bj = 3 * j
        ux = uy = dx = dy = 0.0
        arm_ix = arm_iy = arm_jx = arm_jy = 0.0
        if kind == TURN:
            x = q[bj + 2] - q[bi + 2]
            rate = v[bj + 2] - v[bi + 2]
        else:
            c = cos_sin[i, 0]
            s = cos_sin[i, 1]
            arm_ix = c * place[e, 0] - s * place[e, 1]
            arm_iy = s * place[e, 0] + c * place[e, 1]
            ux = c * place[e, 2] - s * place[e, 3]
            uy = s * place[e, 2] + c * place[e, 3]
            c = cos_sin[j, 0]
            s = cos_sin[j, 1]
            arm_jx = c * place[e, 4] - s * place[e, 5]
            arm_jy = s * place[e, 4] + c * place[e, 5]
            dx = q[bj] + arm_jx - q[bi] - arm_ix
            dy = q[bj + 1] + arm_jy - q[bi + 1] - arm_iy
            vx = v[bj] - v[bj + 2] * arm_jy
            vy = v[bj + 1] + v[bj + 2] * arm_jx
            if kind == PUSH:
                x = t
                rate = ux * vx + uy * vy
            else:
                vx -= v[bi] - v[bi + 2] * arm_iy
                vy -= v[bi + 1] + v[bi + 2] * arm_ix
                if kind == LINE:
                    x = math.sqrt(dx * dx + dy * dy)
                    ux = dx / x if x > 0.0 else 0.0
                    uy = dy / x if x > 0.0 else 0.0
                    rate = ux * vx + uy * vy
                else:
                    x = ux * dx + uy * dy
                    rate = ux * vx + uy * vy + v[bi + 2] * (-uy * dx + ux * dy)
        force = 0.0
        for k in range(element[e, 3], element[e, 4]):
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
        power += force * rate
        if kind == TURN:
            load[bj + 2] += force
            load[bi + 2] -= force
            continue
        fx = force * ux
        fy = force * uy
        load[bj] += fx
        load[bj + 1] += fy
        load[bj + 2] += fy * arm_jx - fx * arm_jy
        if kind == PUSH:
            continue
        load[bi] -= fx
        load[bi + 1] -= fy
        load[bi + 2] -= fy * arm_ix - fx * arm_iy
        if kind == AXIS:
            load[bi + 2] += force * (-uy * dx + ux * dy)
    return power


@inlined
def apply_loads(loads, laws, t, q, v, cos_sin, load):
    """Add the generalised forces of all loads but friction to load (3 nb,); cos_sin (nb, 2) turns the bodies.

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
