"""Decisions about gaps that stay closed and joints that may stick: open, slide or stick from now on.

For contacts that do not separate and joints at rest, in accelerations (friction/pushes.py):

    0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= L, s'' = 0 or against T

L = mu_s N of a contact, mu_s (N + N_0) of a joint, whose N is the size of a reaction and no unknown of that problem: it
is solved again with the N of the joints that it gives, until both agree, by the iteration of joint_friction.py. T that
several joints at rest can share is shared (events/laws/division.py).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import (
    FAILURE,
    FORCE,
    FOUND,
    FREE,
    FRICTION,
    GUESS,
    HOLDING,
    KINETIC,
    LAST,
    LEFT,
    LIMIT,
    NO_AGREEMENT,
    NORMAL,
    NOW,
    RATE,
    RELEASED,
    REST,
    RESTING,
    ROW,
    SIGN,
    TAKING,
    TOUCHING,
)
from mbsd.dynamics.events.bounds import AT_LIMIT, AT_LIMIT_BEYOND, BEGINS, HAIR, PATIENCE, ROUNDING
from mbsd.dynamics.events.friction.decisions import begin_deciding, begin_touched, breaks, guess, left_of, press
from mbsd.dynamics.events.friction.pushes import solve_with_friction
from mbsd.dynamics.events.friction.resting import find_resting, gives, holds
from mbsd.dynamics.events.jumps import FAINT
from mbsd.dynamics.events.laws.division import divide
from mbsd.dynamics.events.rows import gaps_of
from mbsd.dynamics.events.sticking.answers import stand
from mbsd.dynamics.events.sticking.giving_way import (
    begin_giving,
    gives_way,
    keep_pushes,
    may_give,
    note_giving,
    solve_giving,
)
from mbsd.dynamics.events.sticking.sharing import limit_of
from mbsd.dynamics.events.sticking.together import divide_together
from mbsd.dynamics.formulation import along, respond
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import FAINT as FAINT_LOAD
from mbsd.equations.joint_friction import MOST_PASSES, SENSE, SETTLED, X, apply_friction, normal_forces
from mbsd.equations.loads import apply_loads


@internal
def _find_signs(dyn, contacts, halted):
    """Find signs of sliding of joints, after find_resting; in chosen[RESTING] forces are to decide."""
    resting = contacts.chosen[RESTING]
    joints = contacts.place.shape[0] - contacts.sticks.joint.shape[0]
    for k in range(contacts.place.shape[0]):
        resting[k] = 0
        if k < joints or contacts.number[k, RELEASED] != 0.0:
            continue
        rate = contacts.vector[RATE, k]
        sign = contacts.number[k, SIGN]
        if not holds(dyn, contacts, k):
            sign = sign if sign != 0.0 else 1.0
        elif abs(rate) > contacts.number[k, REST]:
            sign = math.copysign(1.0, rate)
        elif gives(contacts, k):
            sign = 0.0
            resting[k] = 1
        elif k == halted:
            sign = -sign
        elif sign == 0.0:
            sign = 1.0
        contacts.number[k, SIGN] = sign
        dyn.loads.friction_number[contacts.place[k, FRICTION], SENSE] = sign


@internal
def _choose(dyn, scratch, contacts, v, halted):
    """Choose what slides and what is at rest at velocities v (3 nb,), and the rows whose forces are sought."""
    find_resting(dyn, scratch, contacts, v, halted)
    guess(contacts)
    _find_signs(dyn, contacts, halted)
    press(contacts)
    for k in range(contacts.place.shape[0] - contacts.sticks.joint.shape[0], contacts.place.shape[0]):
        contacts.chosen[TAKING, k] = contacts.chosen[RESTING, k]


@internal
def _share_rest(contacts, rounding):
    """Share friction among the joints that stay at rest, with contacts that stick N and T."""
    vector = contacts.sticks.vector
    number = contacts.friction.number
    gaps = gaps_of(contacts)
    mixed = False
    find_left(contacts, rounding)
    within = 0
    for k in range(contacts.place.shape[0]):
        stays = contacts.chosen[RESTING, k] != 0 and vector[LEFT, k] == 0.0
        contacts.chosen[TOUCHING, k] = 1 if stays else 0
        within += contacts.chosen[TOUCHING, k]
    for w in range(number.shape[0]):
        k = contacts.friction.gap[w]
        limit = number[w, HOLDING] * vector[FORCE, k]
        at_rest = within > 0 and contacts.chosen[TAKING, gaps + w] != 0 and vector[FORCE, k] > 0.0
        if at_rest and left_of(contacts, vector[FORCE], gaps + w, limit, rounding) == 0.0:
            contacts.chosen[TOUCHING, gaps + w] = 1
            mixed = True
    if mixed:
        for k in range(gaps):
            contacts.chosen[TOUCHING, k] = 1 if contacts.chosen[TAKING, k] != 0 and vector[FORCE, k] > 0.0 else 0
        divide_together(contacts, contacts.chosen[TOUCHING], vector[FORCE], vector[LIMIT], HOLDING)
    elif within > 1:
        sticks = contacts.sticks
        divide(contacts.compliance, contacts.chosen[TOUCHING], vector[FORCE], vector[LIMIT], sticks.division)


@internal
def find_left(contacts, rounding):
    """Fill sticks.vector[LEFT] with accelerations of ways at rest under forces, zero where friction holds them.

    ``rounding``: part of what acts that counts as none.
    """
    count = contacts.place.shape[0]
    vector = contacts.sticks.vector
    for k in range(count):
        vector[LEFT, k] = 0.0
        if contacts.chosen[RESTING, k] == 0:
            continue
        vector[LEFT, k] = left_of(contacts, vector[FORCE], k, vector[LIMIT, k], rounding)


@internal
def _loads(dyn, scratch, contacts, t, y):
    """Fill sticks.load[0] with all loads but friction of joints, after stand."""
    load = contacts.sticks.load[0]
    for c in range(load.shape[0]):
        load[c] = dyn.weight[c]
    if dyn.loads.total > 0:
        apply_loads(dyn.loads, dyn.laws, t, y[0], y[1], scratch.ws.cos_sin, load)


@internal
def _add_sliding(contacts, lam):
    """Add what the friction of sliding contacts under vector[FORCE] changes of the multipliers lam (m,)."""
    friction = contacts.friction
    for w in range(friction.gap.shape[0]):
        normal = contacts.sticks.vector[FORCE, friction.gap[w]]
        force = -friction.number[w, KINETIC] * friction.number[w, GUESS] * normal
        if force != 0.0:
            for r in range(lam.shape[0]):
                lam[r] += contacts.sticks.borne[gaps_of(contacts) + w, r] * force


@internal
def _try(dyn, scratch, contacts, v, hair, rounding, giving):
    """Find N and T under the normal forces normal[NOW], and those that they give; returns the largest load, -1 if none.

    ``giving``: ways give way as GIVES says.
    """
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
    pressed = contacts.friction.compliance
    if giving:
        solve_giving(contacts)
    else:
        if not solve_with_friction(contacts, pressed, contacts.vector[FREE], HOLDING, sticks.vector[FORCE]):
            return -1.0
        keep_pushes(contacts)
        _share_rest(contacts, rounding)
        note_giving(contacts, rounding)
    for k in range(contacts.place.shape[0]):
        if contacts.chosen[TAKING, k] != 0:
            for r in range(lam.shape[0]):
                lam[r] += sticks.borne[k, r] * sticks.vector[FORCE, k]
    _add_sliding(contacts, lam)
    normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, sticks.normal[FOUND])
    return largest


@apart
def _agree(dyn, scratch, contacts, v, hair, rounding, giving):
    """Repeat that until the normal forces of the joints agree; returns the largest load, -1 if they do not."""
    normal = contacts.sticks.normal
    count = normal.shape[1]
    weight = 1.0
    for k in range(count):
        before = dyn.loads.normal[X, k]
        normal[NOW, k] = before if math.isfinite(before) else 0.0
        normal[LAST, k] = 0.0
    for turn in range(MOST_PASSES):
        largest = _try(dyn, scratch, contacts, v, hair, rounding, giving)
        if largest < 0.0:
            return largest
        worst = 0.0
        most = FAINT_LOAD * largest
        product = 0.0
        square = 0.0
        for k in range(count):
            gap = normal[FOUND, k] - normal[NOW, k]
            if not math.isfinite(gap):
                contacts.clock[FAILURE] = NO_AGREEMENT
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
    contacts.clock[FAILURE] = NO_AGREEMENT
    return -1.0


@apart
def decide(dyn, scratch, contacts, state, halted, slipping, touched):
    """Find normal forces of gaps in chosen[STAYING], NEXT_SIGN of their ways, number[SIGN] of joints; False: none.

    All rows that events switch are released. ``halted``: the joint that has just come to rest, -1 if none has;
    ``slipping``: one at rest, or all that is at rest, has just come to its limit; ``touched``: the gap that has just
    closed, -1 if none has.
    """
    count = contacts.place.shape[0]
    gaps = gaps_of(contacts)
    v = state.y[1]
    largest = -1.0
    hair = 1.0 - HAIR if slipping else 1.0
    rounding = AT_LIMIT_BEYOND if slipping else AT_LIMIT
    stand(dyn, scratch, state.clock[TIME], state.y)
    begin_deciding(contacts, hair)
    _loads(dyn, scratch, contacts, state.clock[TIME], state.y)
    for _ in range(contacts.friction.gap.shape[0] + 1):
        _choose(dyn, scratch, contacts, v, halted)
        begin_giving(contacts)
        largest = _agree(dyn, scratch, contacts, v, hair, rounding, False)
        if largest < 0.0 and slipping and may_give(contacts):
            largest = _agree(dyn, scratch, contacts, v, hair, rounding, True)
            largest = largest if largest >= 0.0 and gives_way(contacts, rounding) else -1.0
        if largest < 0.0:
            return False
        for k in range(count):
            contacts.vector[NORMAL, k] = contacts.sticks.vector[FORCE, k]
        if not breaks(contacts, FAINT * largest, rounding):
            break
    find_left(contacts, rounding)
    begin_touched(contacts, contacts.friction.compliance, touched, FAINT * largest, rounding)
    for k in range(count):
        if k < gaps and contacts.vector[NORMAL, k] != BEGINS and not contacts.vector[NORMAL, k] > FAINT * largest:
            contacts.vector[NORMAL, k] = 0.0
        elif contacts.chosen[RESTING, k] != 0:
            left = contacts.sticks.vector[LEFT, k]
            contacts.number[k, SIGN] = math.copysign(1.0, left) if left != 0.0 else 0.0
    return True
