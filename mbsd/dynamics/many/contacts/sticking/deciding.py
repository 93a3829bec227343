"""What gaps that stay closed and joints that may stick do from now on: events/laws/stick_slip.py, compiled."""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.bounds import AT_LIMIT, HAIR, PATIENCE, ROUNDING
from mbsd.dynamics.events.laws.division import divide
from mbsd.dynamics.many.contacts.arrays import (
    ALONE,
    FORCE,
    FOUND,
    FREE,
    FRICTION,
    KIND,
    LAST,
    LEFT,
    LIMIT,
    NORMAL,
    NOW,
    REST,
    RESTING,
    ROW,
    SIGN,
    STAYING,
    TAKING,
    TOUCHING,
    WAY,
)
from mbsd.dynamics.many.contacts.jumps import FAINT
from mbsd.dynamics.many.contacts.pushes import STIFF
from mbsd.dynamics.many.contacts.rows import along, find_rates, keep_independent, stop
from mbsd.dynamics.many.contacts.sticking.answers import respond, stand
from mbsd.dynamics.many.contacts.sticking.complementarity import solve_forces
from mbsd.dynamics.many.contacts.sticking.sharing import limit_of
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import FAINT as FAINT_LOAD
from mbsd.equations.joint_friction import MOST_PASSES, SENSE, SETTLED, X, apply_friction, normal_forces
from mbsd.equations.loads import apply_loads


@internal
def _gives(contacts, k):
    """Whether a force along way k moves anything: none does at a turning point, or where drivers alone move it."""
    return contacts.compliance[k, k] > STIFF * contacts.vector[ALONE, k]


@internal
def _rests(dyn, scratch, contacts, k, u, halted):
    """Whether way k is at rest at velocities u (3 nb,), or has just come to rest."""
    rate = along(dyn, scratch, contacts.place[k, ROW], u)
    return _gives(contacts, k) and (k == halted or abs(rate) <= contacts.number[k, REST])


@apart
def _find_signs(dyn, scratch, contacts, v, halted):
    """Signs of sliding of joints at velocities v (3 nb,), those at rest taken to be so exactly: others may be, too.

    chosen[RESTING] are those at rest, whose forces are to decide.
    """
    count = contacts.place.shape[0]
    resting = contacts.chosen[RESTING]
    u = contacts.rates[0]
    for c in range(v.shape[0]):
        u[c] = v[c]
    for k in range(count):
        resting[k] = 1 if contacts.place[k, KIND] == WAY and _rests(dyn, scratch, contacts, k, u, halted) else 0
    known = -1
    more = 0
    for k in range(count):
        more += resting[k]
    while more > max(known, 0):
        known = more
        for c in range(v.shape[0]):
            u[c] = v[c]
        keep_independent(contacts, resting)
        stop(dyn, scratch, contacts, u)
        more = 0
        for k in range(count):
            if contacts.place[k, KIND] == WAY and _rests(dyn, scratch, contacts, k, u, halted):
                resting[k] = 1
            more += resting[k]
    for k in range(count):
        if contacts.place[k, KIND] != WAY:
            continue
        rate = 0.0 if k == halted else along(dyn, scratch, contacts.place[k, ROW], u)
        sign = contacts.number[k, SIGN]
        resting[k] = 0
        if abs(rate) > contacts.number[k, REST]:
            sign = math.copysign(1.0, rate)
        elif _gives(contacts, k):
            sign = 0.0
            resting[k] = 1
        elif k == halted:
            sign = -sign
        elif sign == 0.0:
            sign = 1.0
        contacts.number[k, SIGN] = sign
        dyn.loads.friction_number[contacts.place[k, FRICTION], SENSE] = sign


@internal
def _share_rest(contacts):
    """Share friction among the joints that stay at rest."""
    vector = contacts.sticks.vector
    find_left(contacts)
    within = 0
    for k in range(contacts.place.shape[0]):
        stays = contacts.chosen[RESTING, k] != 0 and vector[LEFT, k] == 0.0
        contacts.chosen[TOUCHING, k] = 1 if stays else 0
        within += contacts.chosen[TOUCHING, k]
    if within > 1:
        sticks = contacts.sticks
        divide(contacts.compliance, contacts.chosen[TOUCHING], vector[FORCE], vector[LIMIT], sticks.division)


@internal
def find_left(contacts):
    """Fill sticks.vector[LEFT] with accelerations of ways at rest under forces, zero where friction holds them."""
    count = contacts.place.shape[0]
    vector = contacts.sticks.vector
    for k in range(count):
        vector[LEFT, k] = 0.0
        if contacts.chosen[RESTING, k] == 0:
            continue
        free = contacts.vector[FREE, k]
        left = free
        for j in range(count):
            if contacts.chosen[TAKING, j] != 0:
                left += contacts.compliance[k, j] * vector[FORCE, j]
        by_limit = contacts.compliance[k, k] * vector[LIMIT, k]
        if abs(left) > AT_LIMIT * max(by_limit, abs(free)):
            vector[LEFT, k] = left


@internal
def _loads(dyn, scratch, contacts, t, y):
    """Fill sticks.load[0] with all loads but friction of joints, after stand."""
    load = contacts.sticks.load[0]
    for c in range(load.shape[0]):
        load[c] = dyn.weight[c]
    if dyn.loads.total > 0:
        apply_loads(dyn.loads, dyn.laws, t, y[0], y[1], scratch.ws.cos_sin, load)


@internal
def _try(dyn, scratch, contacts, v, hair):
    """N and T under the normal forces normal[NOW], and those that they give; returns the largest load, -1 if none."""
    sticks = contacts.sticks
    load = sticks.load[1]
    lam = sticks.lam[1]
    for c in range(load.shape[0]):
        load[c] = sticks.load[0, c]
    apply_friction(dyn.system, dyn.loads, v, scratch.ws, sticks.normal[NOW], 1.0, load)
    largest = 0.0
    for c in range(3, load.shape[0]):
        largest = max(largest, abs(load[c]))
    respond(dyn, scratch, load, 1.0, contacts.rates[1], lam)
    for k in range(contacts.place.shape[0]):
        row = contacts.place[k, ROW]
        sticks.vector[LIMIT, k] = 0.0
        if contacts.chosen[RESTING, k] != 0:
            sticks.vector[LIMIT, k] = hair * limit_of(dyn, contacts.place[k, FRICTION], sticks.normal[NOW])
        if contacts.chosen[TAKING, k] != 0:
            contacts.vector[FREE, k] = along(dyn, scratch, row, contacts.rates[1]) - scratch.ws.right[0, row]
    if not solve_forces(contacts):
        return -1.0
    _share_rest(contacts)
    for k in range(contacts.place.shape[0]):
        if contacts.chosen[TAKING, k] != 0:
            for r in range(lam.shape[0]):
                lam[r] += sticks.borne[k, r] * sticks.vector[FORCE, k]
    normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, sticks.normal[FOUND])
    return largest


@apart
def _agree(dyn, scratch, contacts, v, hair):
    """Repeat that until the normal forces of the joints agree; returns the largest load, -1 if they do not."""
    normal = contacts.sticks.normal
    count = normal.shape[1]
    weight = 1.0
    for k in range(count):
        before = dyn.loads.normal[X, k]
        normal[NOW, k] = before if math.isfinite(before) else 0.0
        normal[LAST, k] = 0.0
    for turn in range(MOST_PASSES):
        largest = _try(dyn, scratch, contacts, v, hair)
        if largest < 0.0:
            return largest
        worst = 0.0
        most = FAINT_LOAD * largest
        product = 0.0
        square = 0.0
        for k in range(count):
            gap = normal[FOUND, k] - normal[NOW, k]
            if not math.isfinite(gap):
                return -1.0
            worst = max(worst, abs(gap))
            most = max(most, normal[FOUND, k])
            product += normal[LAST, k] * (gap - normal[LAST, k])
            square += (gap - normal[LAST, k]) ** 2
        if worst <= (SETTLED if turn < PATIENCE else ROUNDING) * most:
            return largest
        weight = min(max(-weight * product / square, -10.0), 10.0) if turn > 0 and square != 0.0 else 1.0
        for k in range(count):
            gap = normal[FOUND, k] - normal[NOW, k]
            normal[LAST, k] = gap
            normal[NOW, k] = max(normal[NOW, k] + weight * gap, 0.0)
    return -1.0


@apart
def decide(dyn, scratch, contacts, state, halted, slipping):
    """Normal forces of the gaps in chosen[STAYING], and number[SIGN] of the joints; whether there are some.

    All rows that events switch are released. ``halted``: the joint that has just come to rest, -1 if none has;
    ``slipping``: one at rest has just come to its limit.
    """
    count = contacts.place.shape[0]
    v = state.y[1]
    stand(dyn, scratch, state.clock[TIME], state.y)
    find_rates(dyn, scratch, contacts, v)
    _find_signs(dyn, scratch, contacts, v, halted)
    for k in range(count):
        taking = contacts.chosen[RESTING, k] if contacts.place[k, KIND] == WAY else contacts.chosen[STAYING, k]
        contacts.chosen[TAKING, k] = taking
    _loads(dyn, scratch, contacts, state.clock[TIME], state.y)
    largest = _agree(dyn, scratch, contacts, v, 1.0 - HAIR if slipping else 1.0)
    if largest < 0.0:
        return False
    find_left(contacts)
    for k in range(count):
        contacts.vector[NORMAL, k] = 0.0
        if contacts.place[k, KIND] != WAY:
            normal = contacts.sticks.vector[FORCE, k]
            contacts.vector[NORMAL, k] = normal if normal > FAINT * largest else 0.0
        elif contacts.chosen[RESTING, k] != 0:
            left = contacts.sticks.vector[LEFT, k]
            contacts.number[k, SIGN] = math.copysign(1.0, left) if left != 0.0 else 0.0
    return True
