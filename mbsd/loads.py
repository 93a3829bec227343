"""Forces as arrays, and the compiled evaluation of all of them.

Elements and terms as forces/kind.py defines them; interactions and forces of the user by the address of a function,
so that nobody compiles what his model does not use.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mbsd.forces.kind import AXIS, CONSTANT, DAMPING, DRY, LAW_RATE, LAW_TIME, LINE, LINEAR, POWER, PUSH, TURN
from mbsd.interaction_loads import apply_interactions, pack_interactions
from mbsd.interactions.law import STATE
from mbsd.jit import kernel
from mbsd.joint_friction import pack_friction
from mbsd.laws import Laws, evaluate_law, pack_laws
from mbsd.markers import move, place
from mbsd.motions import Motion
from mbsd.user_loads import apply_user_forces, pack_user_forces

if TYPE_CHECKING:
    from mbsd.packing import Packed


class Loads(NamedTuple):
    """All forces; ``number`` may be changed between runs."""

    element: Any
    """(e, 4) kind, marker i, marker j, 1 where the axis is turned by a right angle."""
    first_term: Any
    """(e + 1,)"""
    term: Any
    """(k, 2) kind, law."""
    number: Any
    """(k, 3) a, b, c."""
    law: Any
    """(3,) scratch of a law."""
    interaction: Any
    """(n, 5) body i, body j, law of time, first number, address of the function."""
    given: Any
    """Of each interaction: arm of i, axis of i, arm of j (body axes), angle of j less that of i, then its own."""
    state: Any
    """(24,) what the function of an interaction reads."""
    user: Any
    """(u, 3) forces of the user: address, first of user_body, count."""
    user_body: Any
    """(b,)"""
    user_com: Any
    """(b, 2) centres of mass in the author's frames."""
    exchange: Any
    """(2, 6 k) inputs and outputs of a user's force on k bodies, or of an interaction."""
    rub: Any
    """(f, 6) joints with friction; columns in joint_friction.py."""
    rub_number: Any
    """(f, 7)"""
    normal: Any
    """(4, f) their normal forces now, and scratch of the iteration."""
    rubbing: Any
    """(2,) weight of the iteration's steps, and whether it failed."""
    total: int
    """Of all elements, interactions and forces of the user; friction is not among them."""


def pack_loads(packed: Packed) -> Loads:
    """The loads of a packed mechanism; laws of forces are numbered after those of the drivers."""
    element, term, number, first_term = [], [], [], [0]
    law = len(packed.motions)
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        numbered = {name: law + 1 + k for k, name in enumerate(force.laws)}
        law += len(force.laws)
        for part in force.kind.elements(force):
            element.append((part.kind, i, j, int(part.turned)))
            for one in part.terms:
                term.append((one.kind, numbered[one.law] if one.law else 0))
                number.append((one.a, one.b, one.c))
            first_term.append(len(term))
    interaction, given = pack_interactions(packed)
    user, user_body, user_com = pack_user_forces(packed)
    friction, friction_number = pack_friction(packed)
    return Loads(
        np.array(element, np.int64).reshape(-1, 4),
        np.array(first_term, np.int64),
        np.array(term, np.int64).reshape(-1, 2),
        np.array(number, float).reshape(-1, 3),
        np.zeros(3),
        interaction,
        given,
        np.zeros(STATE),
        user,
        user_body,
        user_com,
        np.zeros((2, 6 * max(1, int(user[:, 2].max(initial=1))))),
        friction,
        friction_number,
        np.zeros((4, len(friction))),
        np.zeros(2),
        len(element) + len(interaction) + len(user),
    )


def compiled_laws(packed: Packed, start: float, end: float) -> Laws:
    """The laws of drivers, then those of forces, for times ``start`` .. ``end`` (s)."""
    laws = [law.compiled(start, end) for law in packed.motions]
    for force in packed.forces:
        for law in force.laws.values():
            ready = law.over(start, end) if isinstance(law, Motion) else law
            laws.append(ready.compiled(start, end))
    return pack_laws(laws)


@kernel
def _magnitude(loads, laws, e, t, x, rate):
    total = 0.0
    for k in range(loads.first_term[e], loads.first_term[e + 1]):
        kind = loads.term[k, 0]
        a = loads.number[k, 0]
        b = loads.number[k, 1]
        if kind == CONSTANT:
            total += a
        elif kind == LINEAR:
            total -= a * (x - b)
        elif kind == DAMPING:
            total -= a * rate
        elif kind == POWER:
            total += a * (x + b) ** loads.number[k, 2]
        elif kind == DRY:
            total -= a * math.tanh(rate / b)
        else:
            at = x
            if kind == LAW_RATE:
                at = rate
            elif kind == LAW_TIME:
                at = t
            evaluate_law(laws, loads.term[k, 1], at, loads.law)
            total += a * loads.law[0]
    return total


@kernel
def apply_loads(system, loads, laws, t, q, v, ws, load):
    """Add the generalised forces of all loads but friction to load (3 nb,), after place and move.

    Returns their power (W).
    What falls on ground is added too and means nothing.
    """
    power = 0.0
    for e in range(loads.element.shape[0]):
        kind = loads.element[e, 0]
        i = loads.element[e, 1]
        j = loads.element[e, 2]
        bi = 3 * system.marker_body[i]
        bj = 3 * system.marker_body[j]
        if kind == TURN:
            rate = v[bj + 2] - v[bi + 2]
            force = _magnitude(loads, laws, e, t, q[bj + 2] - q[bi + 2], rate)
            load[bj + 2] += force
            load[bi + 2] -= force
            power += force * rate
            continue
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        vx = ws.velocity[j, 0] - ws.velocity[i, 0]
        vy = ws.velocity[j, 1] - ws.velocity[i, 1]
        if kind == LINE:
            x = math.sqrt(dx * dx + dy * dy)
            ux = dx / x if x > 0.0 else 0.0
            uy = dy / x if x > 0.0 else 0.0
            rate = ux * vx + uy * vy
        else:
            ux = ws.axis[i, 0]
            uy = ws.axis[i, 1]
            if loads.element[e, 3] == 1:
                turned = ux
                ux = -uy
                uy = turned
            x = ux * dx + uy * dy
            rate = ux * vx + uy * vy + v[bi + 2] * (-uy * dx + ux * dy)
            if kind == PUSH:
                x = t
                rate = ux * ws.velocity[j, 0] + uy * ws.velocity[j, 1]
        force = _magnitude(loads, laws, e, t, x, rate)
        power += force * rate
        fx = force * ux
        fy = force * uy
        load[bj] += fx
        load[bj + 1] += fy
        load[bj + 2] += fy * ws.arm[j, 0] - fx * ws.arm[j, 1]
        if kind == PUSH:
            continue
        load[bi] -= fx
        load[bi + 1] -= fy
        load[bi + 2] -= fy * ws.arm[i, 0] - fx * ws.arm[i, 1]
        if kind == AXIS:
            load[bi + 2] += force * (-uy * dx + ux * dy)
    if loads.interaction.shape[0] > 0:
        power += apply_interactions(loads, laws, t, q, v, ws, load)
    if loads.user.shape[0] > 0:
        power += apply_user_forces(loads, t, q, v, ws, load)
    return power


@kernel
def tabulate_loads(system, loads, laws, times, q, v, ws, out, power):
    """out (T, 3 nb) and power (T,) of all forces along a motion q, v (T, 3 nb); ground's entries mean nothing."""
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        move(system, v[k], ws)
        for c in range(q.shape[1]):
            out[k, c] = 0.0
        power[k] = apply_loads(system, loads, laws, times[k], q[k], v[k], ws, out[k])


def loads_along(packed: Packed, loads: Loads, laws: Laws, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(T, 3 nb) generalised forces of all loads but friction along a motion q, v (T, 3 nb); zero for ground.

    Raises ModelError where a function of the user fails.
    """
    out = np.zeros_like(q)
    if loads.total:
        tabulate_loads(packed.system, loads, laws, t, q, v, packed.ws, out, np.zeros(len(t)))
        packed.specials.check()
        out[:, :3] = 0.0
    return out
