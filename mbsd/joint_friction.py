"""Friction of joints as arrays, and its evaluation at known multipliers; the law stands in forces/friction.py.

A friction acts along one rate: omega of a pin, or the speed of a slide. Its normal force N comes from the multipliers
of the joint's rows: of a pin the length of both, of a slide that of the slot and, by the guide, of the angle.

    amount = scale f N - c rate,   f = -mu(scale rate),   scale: radius of a pin, 1 of a slide
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mbsd.jit import internal, kernel
from mbsd.markers import move, place

if TYPE_CHECKING:
    from mbsd.packing import Packed

PIN, SLIDE, GUIDE = 0, 1, 2
"""Kinds: a pin, a slide without couple, a slide whose couple bears on a guide."""
KINETIC, STATIC, STRIBECK, SMOOTHING, SCALE, LENGTH, VISCOUS, PRELOAD = 0, 1, 2, 3, 4, 5, 6, 7
"""Columns of the numbers."""


class JointFriction(NamedTuple):
    """Friction of k joints; ``number`` may be changed between runs."""

    table: Any
    """(k, 4) kind, first row of the joint, marker i, marker j."""
    number: Any
    """(k, 8) see the columns above."""
    normal: Any
    """(k, 6) scratch: rate, factor f, normal force, its last value, the last two gaps of it."""


def pack_friction(packed: Packed) -> JointFriction:
    """Friction of a packed mechanism."""
    at = {joint.name: k for k, joint in enumerate(packed.joints) if not joint.kind.driven}
    table, number = [], []
    for force in packed.forces:
        if not force.kind.of_reaction:
            continue
        p, k = force.params, at[force.params["joint"]]
        pin = packed.joints[k].kind.constraints == ("point",)
        kind = PIN if pin else GUIDE if p["guide"] > 0.0 else SLIDE
        table.append((kind, packed.first_row[k], *packed.markers[k]))
        static = p["coefficient"] if p["static"] is None else p["static"]
        scale = p["radius"] if pin else 1.0
        law = p["coefficient"], static, p["stribeck_speed"], p["smoothing"]
        number.append((*law, scale, p["guide"], p["viscous"], p["preload"]))
    return JointFriction(
        np.array(table, np.int64).reshape(-1, 4), np.array(number, float).reshape(-1, 8), np.zeros((len(table), 6))
    )


@internal
def friction_rate(system, friction, k, v, ws):
    """What friction k works against: rad/s of a pin, m/s of a slide; after place and move."""
    i = friction.table[k, 2]
    j = friction.table[k, 3]
    omega = v[3 * system.marker_body[i] + 2]
    if friction.table[k, 0] == PIN:
        return v[3 * system.marker_body[j] + 2] - omega
    ux = ws.axis[i, 0]
    uy = ws.axis[i, 1]
    across = ux * (ws.position[j, 1] - ws.position[i, 1]) - uy * (ws.position[j, 0] - ws.position[i, 0])
    along = ux * (ws.velocity[j, 0] - ws.velocity[i, 0]) + uy * (ws.velocity[j, 1] - ws.velocity[i, 1])
    return along + omega * across


@internal
def friction_factor(friction, k, rate):
    """f: friction over normal force, against the rate."""
    number = friction.number[k]
    speed = number[SCALE] * rate
    slow = speed / number[STRIBECK]
    rise = (number[STATIC] - number[KINETIC]) * math.exp(-slow * slow)
    return -(number[KINETIC] + rise) * math.tanh(speed / number[SMOOTHING])


@internal
def normal_force(friction, k, lam):
    """N (N) of friction k by the multipliers."""
    kind = friction.table[k, 0]
    r = friction.table[k, 1]
    normal = abs(lam[r])
    if kind == PIN:
        normal = math.sqrt(lam[r] * lam[r] + lam[r + 1] * lam[r + 1])
    elif kind == GUIDE:
        normal = max(normal, 2.0 * abs(lam[r + 1]) / friction.number[k, LENGTH])
    return normal + friction.number[k, PRELOAD]


@internal
def push(system, friction, k, amount, ws, load):
    """Add the torque (pin) or force (slide) of friction k to load (3 nb,)."""
    i = friction.table[k, 2]
    j = friction.table[k, 3]
    bi = 3 * system.marker_body[i]
    bj = 3 * system.marker_body[j]
    if friction.table[k, 0] == PIN:
        load[bj + 2] += amount
        load[bi + 2] -= amount
        return
    fx = amount * ws.axis[i, 0]
    fy = amount * ws.axis[i, 1]
    dx = ws.position[j, 0] - ws.position[i, 0]
    dy = ws.position[j, 1] - ws.position[i, 1]
    load[bj] += fx
    load[bj + 1] += fy
    load[bj + 2] += fy * ws.arm[j, 0] - fx * ws.arm[j, 1]
    load[bi] -= fx
    load[bi + 1] -= fy
    load[bi + 2] -= fy * (ws.arm[i, 0] + dx) - fx * (ws.arm[i, 1] + dy)


@internal
def apply_friction(system, friction, v, ws, lam, load):
    """Add the friction of all joints at multipliers lam (m,) to load (3 nb,); returns its power (W)."""
    power = 0.0
    for k in range(friction.table.shape[0]):
        rate = friction_rate(system, friction, k, v, ws)
        amount = friction_factor(friction, k, rate) * normal_force(friction, k, lam)
        amount = friction.number[k, SCALE] * amount - friction.number[k, VISCOUS] * rate
        push(system, friction, k, amount, ws, load)
        power += amount * rate
    return power


@kernel
def tabulate_friction(system, friction, q, v, lam, ws, out, power):
    """out (T, 3 nb) and power (T,) of the friction of all joints along a motion; ground's entries mean nothing."""
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        move(system, v[k], ws)
        for c in range(q.shape[1]):
            out[k, c] = 0.0
        power[k] = apply_friction(system, friction, v[k], ws, lam[k], out[k])


def friction_along(
    packed: Packed, friction: JointFriction, q: np.ndarray, v: np.ndarray, lam: np.ndarray
) -> np.ndarray:
    """(T, 3 nb) generalised forces of friction along a motion q, v (T, 3 nb), lam (T, m); zero for ground."""
    out = np.zeros_like(q)
    if len(friction.table):
        lam = np.ascontiguousarray(lam)
        tabulate_friction(packed.system, friction, q, v, lam, packed.ws, out, np.zeros(len(q)))
        out[:, :3] = 0.0
    return out
