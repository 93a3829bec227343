"""Friction of joints, found by iteration together with the reactions it comes from.

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

from mbsd.compiling.jit import internal, kernel, lazy
from mbsd.equations.system import move, place

PIN, GUIDE, SLOT, CAPSTAN = range(4)
"""Shapes. Of a capstan the rows FIRST and END - 1 are the spans before and after it; see model/cables.py."""
SHAPE, MARKER_I, MARKER_J, FIRST, END, SECOND, WAY = range(7)
"""Columns of a row: shape, markers, rows of the joint, 1 where body j moves (else the reaction on body i is read), the
row that holds the joint while it sticks, -1 where there is none."""
COEFFICIENT, STATIC, STRIBECK, VISCOUS, SLIP_SPEED, PRELOAD, SIZE, SENSE, WRAPPED, TURNS = range(10)
"""Columns of its numbers; SIZE: radius of a pin, length of a guide; SENSE: see BY_RATE. Of a capstan, WRAPPED is the
friction of the cable, negative where it turns clockwise, and TURNS are whole ones beyond the angle between its spans
(rad)."""
BY_RATE, NONE = 2.0, 0.0
"""Senses beside 1 and -1, the sign of a sliding that an event ends: friction by the rate alone; none (it sticks, or its
joint is released)."""
X, LAST, FOUND, CHANGE = range(4)
"""Columns of ``normal``: the one used now, last residual, what the multipliers give, change to be applied."""
WEIGHT, FAILED, BEGAN = 0, 1, 2
"""Columns of ``Loads.iteration``; the largest normal force that it began with."""
SPOILT = 1e-6
"""Part of that below which all forces are where its rounding is more than may be left, as after a trial stage far away:
it begins again without normal forces."""
OVERFLOWS = 1e100
"""Normal forces whose squares may be no number."""
GOES_ON, AGREES, BEGINS_AGAIN = range(3)
"""Codes of what follows a pass."""
SETTLED, FAINT = 1e-12, 0.1
"""Part of the largest normal force that may be left; no less than this part of the largest weight counts as largest."""
MOST_PASSES = 100


@internal
def turns_about(shape):
    """Return True if the friction of this shape is a torque about a point."""
    return shape in (PIN, CAPSTAN)


@internal
def _capstan(loads, jac, lam, k):
    """Return (T_1 + T_2) tanh(mu wrap / 2) of joint k (N), which is the largest |T_2 - T_1|."""
    before = loads.friction[k, FIRST]
    after = loads.friction[k, END] - 1
    bx = jac[before, 3]
    by = jac[before, 4]
    ax = -jac[after, 0]
    ay = -jac[after, 1]
    friction = loads.friction_number[k, WRAPPED]
    turned = math.atan2(bx * ay - by * ax, bx * ax + by * ay)
    if friction < 0.0:
        turned = -turned
    if turned < 0.0:
        turned += 2.0 * math.pi
    wrap = turned + loads.friction_number[k, TURNS]
    return abs(lam[before] + lam[after]) * math.tanh(0.5 * abs(friction) * wrap)


@internal
def normal_forces(loads, ws, jac, lam, out):
    """Fill out (f,) with normal forces (N) at multipliers lam (m,) and compact J (m, 6), after place."""
    for k in range(loads.friction.shape[0]):
        i = loads.friction[k, MARKER_I]
        j = loads.friction[k, MARKER_J]
        side = 3 * loads.friction[k, SECOND]
        fx = 0.0
        fy = 0.0
        torque = 0.0
        for r in range(loads.friction[k, FIRST], loads.friction[k, END]):
            fx += jac[r, side] * lam[r]
            fy += jac[r, side + 1] * lam[r]
            torque += jac[r, side + 2] * lam[r]
        shape = loads.friction[k, SHAPE]
        if shape == CAPSTAN:
            out[k] = _capstan(loads, jac, lam, k)
            continue
        if shape == PIN:
            out[k] = math.sqrt(fx * fx + fy * fy)
            continue
        across = ws.axis[i, 0] * fy - ws.axis[i, 1] * fx
        out[k] = abs(across)
        length = loads.friction_number[k, SIZE]
        if shape == GUIDE and length > 0.0:
            own = j if side == 3 else i
            x = ws.position[j, 0] - ws.position[own, 0] + ws.arm[own, 0]
            y = ws.position[j, 1] - ws.position[own, 1] + ws.arm[own, 1]
            tilt = torque - x * fy + y * fx
            out[k] = max(out[k], 2.0 * abs(tilt) / length)


@internal
def rate_of(system, loads, v, ws, k):
    """Return rate (rad/s or m/s) at which joint k with friction turns or slides, after place and move."""
    i = loads.friction[k, MARKER_I]
    j = loads.friction[k, MARKER_J]
    bi = 3 * system.marker_body[i]
    bj = 3 * system.marker_body[j]
    if turns_about(loads.friction[k, SHAPE]):
        return v[bj + 2] - v[bi + 2]
    dx = ws.position[j, 0] - ws.position[i, 0]
    dy = ws.position[j, 1] - ws.position[i, 1]
    vx = ws.velocity[j, 0] - ws.velocity[i, 0]
    vy = ws.velocity[j, 1] - ws.velocity[i, 1]
    ux = ws.axis[i, 0]
    uy = ws.axis[i, 1]
    return ux * vx + uy * vy + v[bi + 2] * (ux * dy - uy * dx)


@internal
def friction_of(loads, k, rate, normal, whole):
    """Return friction (N m of a pin, else N) on body j of joint k; see apply_friction."""
    number = loads.friction_number[k]
    sense = number[SENSE]
    if sense == NONE:
        return 0.0
    lever = number[SIZE] if turns_about(loads.friction[k, SHAPE]) else 1.0
    slip = lever * rate
    if sense == BY_RATE:
        sense = math.tanh(slip / number[SLIP_SPEED])
    over = slip / number[STRIBECK]
    coefficient = number[COEFFICIENT] + (number[STATIC] - number[COEFFICIENT]) * math.exp(-over * over)
    return -coefficient * sense * (normal + whole * number[PRELOAD]) * lever - whole * number[VISCOUS] * rate


@lazy(float)
def apply_friction(system, loads, v, ws, normal, whole, load):
    """Add friction under normal forces (f,) to load (3 nb,), after place and move; return its power (W).

    ``whole`` is 1, or 0 for a change of normal forces: then preload and viscous part are left out.
    """
    power = 0.0
    for k in range(loads.friction.shape[0]):
        rate = rate_of(system, loads, v, ws, k)
        force = friction_of(loads, k, rate, normal[k], whole)
        power += force * rate
        i = loads.friction[k, MARKER_I]
        j = loads.friction[k, MARKER_J]
        bi = 3 * system.marker_body[i]
        bj = 3 * system.marker_body[j]
        if turns_about(loads.friction[k, SHAPE]):
            load[bj + 2] += force
            load[bi + 2] -= force
            continue
        fx = force * ws.axis[i, 0]
        fy = force * ws.axis[i, 1]
        load[bj] += fx
        load[bj + 1] += fy
        load[bj + 2] += ws.arm[j, 0] * fy - ws.arm[j, 1] * fx
        load[bi] -= fx
        load[bi + 1] -= fy
        x = ws.arm[i, 0] + ws.position[j, 0] - ws.position[i, 0]
        y = ws.arm[i, 1] + ws.position[j, 1] - ws.position[i, 1]
        load[bi + 2] -= x * fy - y * fx
    return power


@lazy(None)
def note_friction(system, loads, v, ws, lam):
    """Set lam of the rows of joints that may stick: J^T lam is their friction, as in sticking."""
    for k in range(loads.friction.shape[0]):
        way = loads.friction[k, WAY]
        if way >= 0 and loads.friction_number[k, SENSE] != NONE:
            lam[way] = -friction_of(loads, k, rate_of(system, loads, v, ws, k), loads.normal[X, k], 1.0)


@lazy(float)
def begin_friction(system, loads, v, ws, load):
    """Add the friction under the normal forces of the last evaluation; returns its power (W)."""
    x = loads.normal[X]
    largest = 0.0
    for k in range(x.shape[0]):
        if not x[k] < OVERFLOWS:
            x[k] = 0.0
        largest = max(largest, x[k])
    loads.iteration[WEIGHT] = 0.0
    loads.iteration[BEGAN] = largest
    return apply_friction(system, loads, v, ws, x, 1.0, load)


@lazy(int)
def settle(dyn, ws, a, lam):
    """Compare with the normal forces at a (3 nb,) and lam (m,): whether they agree, or what follows.

    Where it goes on, the change to apply stands in normal[CHANGE].
    """
    loads = dyn.loads
    x = loads.normal[X]
    last = loads.normal[LAST]
    settled = loads.normal[FOUND]
    change = loads.normal[CHANGE]
    normal_forces(loads, ws, ws.jac, lam, settled)
    largest = 0.0
    for c in range(3, a.shape[0]):  # joints that carry nothing, as in free flight, have normal forces of rounding
        if c % 3 != 2:
            largest = max(largest, FAINT * max(abs(dyn.weight[c]), abs(dyn.inertia[c] * a[c])))
    worst = 0.0
    product = 0.0
    square = 0.0
    for k in range(x.shape[0]):
        if loads.friction_number[k, SENSE] == NONE:
            x[k] = settled[k]
        gap = settled[k] - x[k]
        if not math.isfinite(gap):
            return AGREES
        largest = max(largest, settled[k])
        worst = max(worst, abs(gap))
        product += last[k] * (gap - last[k])
        square += (gap - last[k]) ** 2
    if largest < SPOILT * loads.iteration[BEGAN]:
        for k in range(x.shape[0]):
            x[k] = 0.0
        return BEGINS_AGAIN
    if worst <= SETTLED * largest:
        loads.iteration[FAILED] = 0.0
        return AGREES
    weight = loads.iteration[WEIGHT]
    if weight == 0.0 or square == 0.0:
        weight = 1.0
    else:
        weight = min(max(-weight * product / square, -10.0), 10.0)
    loads.iteration[WEIGHT] = weight
    for k in range(x.shape[0]):
        gap = settled[k] - x[k]
        last[k] = gap
        moved = max(x[k] + weight * gap, 0.0)
        change[k] = moved - x[k]
        x[k] = moved
    return GOES_ON


@kernel
def tabulate_normals(system, loads, q, compact, lam, ws, out):
    """Fill out (T, f) with normal forces along q (T, 3 nb) for compact J (T, m, 6) and lam (T, m)."""
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        normal_forces(loads, ws, compact[k], lam[k], out[k])


@kernel
def tabulate_friction(system, loads, q, v, normal, ws, out, power):
    """Add the friction under normal forces (T, f) to out (T, 3 nb) and its power to power (T,)."""
    for k in range(q.shape[0]):
        place(system, q[k], ws)
        move(system, v[k], ws)
        power[k] += apply_friction(system, loads, v[k], ws, normal[k], 1.0, out[k])


@kernel
def tabulate_rates(system, loads, k, q, v, normal, ws, rate, force):
    """Fill rate (T,) of joint k with friction along a motion, and its friction (T,) at ``normal`` (T,)."""
    for i in range(q.shape[0]):
        place(system, q[i], ws)
        move(system, v[i], ws)
        rate[i] = rate_of(system, loads, v[i], ws, k)
        force[i] = friction_of(loads, k, rate[i], normal[i], 1.0)
