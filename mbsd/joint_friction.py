"""Friction of joints as arrays, and the iteration that finds it together with the reactions it comes from.

The friction of a joint is linear in its normal force N, which comes from the multipliers, which the friction changes:

    r = N(lam(x)) - x = 0        x: the normal forces that the friction was computed from
    x += w r,   w <- -w r_old . (r - r_old) / |r - r_old|^2,   w = 1 at first

For one joint this is the secant method, which also converges where plain repetition diverges (long levers, jamming).
It begins with the normal forces of the last evaluation. Where friction presses a joint harder than it was pressed there
may be no solution, which is an error, or two, of which one is found (Painleve 1895).

Source: Irons, Tuck 1969, Int. J. Num. Meth. Eng. 1.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.forces.friction import JOINTS
from mbsd.jit import internal, kernel
from mbsd.markers import move, place

if TYPE_CHECKING:
    from mbsd.packing import Packed

PIN, GUIDE = 0, 1
"""Places in JOINTS; the third is a pin in a slot."""
SHAPE, MARKER_I, MARKER_J, FIRST, END, SECOND = range(6)
"""Of a row: shape, markers, rows of the joint, 1 where body j moves (else the reaction on body i is read)."""
COEFFICIENT, STATIC, STRIBECK, VISCOUS, SLIP_SPEED, PRELOAD, SIZE = range(7)
"""Of its numbers; SIZE: radius of a pin, length of a guide."""
X, LAST, FOUND, CHANGE = range(4)
"""Of ``normal``: used now, last residual, what the multipliers give, change to be applied."""
WEIGHT, FAILED = 0, 1
"""Of ``rubbing``."""
SETTLED = 1e-12
"""Part of the largest normal force that may be left."""
MOST_PASSES = 100


def pack_friction(packed: Packed) -> tuple[np.ndarray, np.ndarray]:
    """The table (f, 6) and the numbers (f, 7), for Loads."""
    rows, numbers = [], []
    names = [joint.name for joint in packed.joints]
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.name == "friction":
            p, k = force.params, names.index(force.params["joint"])
            shape = JOINTS.index(packed.joints[k].kind.name)
            second = int(packed.system.marker_body[j] > 0)
            rows.append((shape, i, j, packed.first_row[k], packed.first_row[k + 1], second))
            own = (p["coefficient"], p["static"], p["stribeck"], p["viscous"], p["slip_speed"], p["preload"])
            numbers.append((*own, p["radius"] if shape == PIN else p["length"]))
    return np.array(rows, np.int64).reshape(-1, 6), np.array(numbers, float).reshape(-1, 7)


@internal
def normal_forces(loads, ws, jac, lam, out):
    """out (f,) normal forces (N) at the multipliers lam (m,) and compact J (m, 6), after place."""
    for k in range(loads.rub.shape[0]):
        i = loads.rub[k, MARKER_I]
        j = loads.rub[k, MARKER_J]
        side = 3 * loads.rub[k, SECOND]
        fx = 0.0
        fy = 0.0
        torque = 0.0
        for r in range(loads.rub[k, FIRST], loads.rub[k, END]):
            fx += jac[r, side] * lam[r]
            fy += jac[r, side + 1] * lam[r]
            torque += jac[r, side + 2] * lam[r]
        shape = loads.rub[k, SHAPE]
        if shape == PIN:
            out[k] = math.sqrt(fx * fx + fy * fy)
            continue
        across = ws.axis[i, 0] * fy - ws.axis[i, 1] * fx
        out[k] = abs(across)
        length = loads.rub_number[k, SIZE]
        if shape == GUIDE and length > 0.0:
            own = j if side == 3 else i
            x = ws.position[j, 0] - ws.position[own, 0] + ws.arm[own, 0]
            y = ws.position[j, 1] - ws.position[own, 1] + ws.arm[own, 1]
            tilt = torque - x * fy + y * fx
            out[k] = max(out[k], 2.0 * abs(tilt) / length)


@internal
def rub(system, loads, v, ws, normal, whole, load):
    """Add the friction under normal forces (f,) to load (3 nb,), after place and move; returns its power (W).

    ``whole`` is 1, or 0 for a change of normal forces: then preload and viscous part are left out.
    """
    power = 0.0
    for k in range(loads.rub.shape[0]):
        i = loads.rub[k, MARKER_I]
        j = loads.rub[k, MARKER_J]
        bi = 3 * system.marker_body[i]
        bj = 3 * system.marker_body[j]
        number = loads.rub_number[k]
        pin = loads.rub[k, SHAPE] == PIN
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        lever = 1.0
        if pin:
            lever = number[SIZE]
            rate = v[bj + 2] - v[bi + 2]
        else:
            vx = ws.velocity[j, 0] - ws.velocity[i, 0]
            vy = ws.velocity[j, 1] - ws.velocity[i, 1]
            rate = ux * vx + uy * vy + v[bi + 2] * (ux * dy - uy * dx)
        slip = lever * rate
        over = slip / number[STRIBECK]
        coefficient = number[COEFFICIENT] + (number[STATIC] - number[COEFFICIENT]) * math.exp(-over * over)
        force = -coefficient * math.tanh(slip / number[SLIP_SPEED]) * (normal[k] + whole * number[PRELOAD]) * lever
        force -= whole * number[VISCOUS] * rate
        power += force * rate
        if pin:
            load[bj + 2] += force
            load[bi + 2] -= force
            continue
        fx = force * ux
        fy = force * uy
        load[bj] += fx
        load[bj + 1] += fy
        load[bj + 2] += ws.arm[j, 0] * fy - ws.arm[j, 1] * fx
        load[bi] -= fx
        load[bi + 1] -= fy
        load[bi + 2] -= (ws.arm[i, 0] + dx) * fy - (ws.arm[i, 1] + dy) * fx
    return power


@internal
def begin_rubbing(system, loads, v, ws, load):
    """Add the friction under the normal forces of the last evaluation; returns its power (W)."""
    x = loads.normal[X]
    for k in range(x.shape[0]):
        if not math.isfinite(x[k]):
            x[k] = 0.0
    loads.rubbing[WEIGHT] = 0.0
    return rub(system, loads, v, ws, x, 1.0, load)


@internal
def settle(loads, ws, lam):
    """Compare with the normal forces at lam: True if they agree; else the change to apply stands in normal[CHANGE]."""
    x = loads.normal[X]
    last = loads.normal[LAST]
    found = loads.normal[FOUND]
    change = loads.normal[CHANGE]
    normal_forces(loads, ws, ws.jac, lam, found)
    largest = 0.0
    worst = 0.0
    product = 0.0
    square = 0.0
    for k in range(x.shape[0]):
        gap = found[k] - x[k]
        if not math.isfinite(gap):
            return True
        largest = max(largest, found[k])
        worst = max(worst, abs(gap))
        product += last[k] * (gap - last[k])
        square += (gap - last[k]) ** 2
    if worst <= SETTLED * largest:
        loads.rubbing[FAILED] = 0.0
        return True
    weight = loads.rubbing[WEIGHT]
    if weight == 0.0 or square == 0.0:
        weight = 1.0
    else:
        weight = min(max(-weight * product / square, -10.0), 10.0)
    loads.rubbing[WEIGHT] = weight
    for k in range(x.shape[0]):
        gap = found[k] - x[k]
        last[k] = gap
        moved = max(x[k] + weight * gap, 0.0)
        change[k] = moved - x[k]
        x[k] = moved
    return False


@kernel
def tabulate_normals(system, loads, q, compact, lam, ws, out):
    """out (T, f) normal forces along poses q (T, 3 nb) with compact J (T, m, 6) and multipliers lam (T, m)."""
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        normal_forces(loads, ws, compact[k], lam[k], out[k])


@kernel
def tabulate_friction(system, loads, q, v, normal, ws, out, power):
    """Add the friction under normal forces (T, f) to out (T, 3 nb) and its power to power (T,)."""
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        move(system, v[k], ws)
        power[k] += rub(system, loads, v[k], ws, normal[k], 1.0, out[k])
