"""Decisions about gaps that stay closed and joints that may stick: open, slide or stick from now on.

For contacts that do not separate and joints at rest, in accelerations (events/friction.py):

    0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= L, s'' = 0 or against T

L = mu_s N of a contact, mu_s (N + N_0) of a joint, whose N is the size of a reaction and no unknown of that problem: it
is solved again with the N of the joints that it gives, until both agree, by the iteration of joint_friction.py. T that
several joints at rest can share is shared (events/laws/division.py).

Ways give way where all that is at rest has come to its limit, and no forces hold it.
Bodies at rest may hold each other by forces that no longer act once they move: pressed with those they could hold as
if they moved, and the other way round. So ways are taken to move as they did in the last try that moved any, with

    T = -s (mu N + L)  of a way that moves with the sign s,   G (N, T) + g = 0  of gaps that push and ways at rest

If what comes out moves just so, they give way. Forces that are not determined are the smallest ones.

Source: Golub and Van Loan, Matrix Computations, sec. 8.6 (singular values by Jacobi's rotations of columns).
"""

from __future__ import annotations

import math

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.events import arrays
from mbsd.dynamics.events.friction import (
    AT_LIMIT,
    BEGINS,
    FAINT,
    acceleration_of,
    begin_deciding,
    begin_touched,
    breaks,
    find_resting,
    gives,
    guess,
    holds,
    left_of,
    press,
    solve_with_friction,
)
from mbsd.dynamics.events.laws.division import divide
from mbsd.dynamics.events.rows import gaps_of
from mbsd.dynamics.events.sticking.sharing import limit_of, stand
from mbsd.dynamics.events.sticking.together import divide_together
from mbsd.dynamics.formulation import along, push, respond
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import FAINT as FAINT_LOAD
from mbsd.equations.joint_friction import MOST_PASSES, SENSE, SETTLED, X, apply_friction, normal_forces
from mbsd.equations.loads import apply_loads

AT_LIMIT_BEYOND = 1e-12
"""The same of joints where one has come to its limit: contacts may leave it little of the motion that it had alone."""
HAIR = 1e-9
"""Part of their limits that joints at rest lack when one of them has just come to its limit."""
ROUNDING, PATIENCE = 1e-9, 20
"""Part of the largest normal force of a joint that may be left after so many passes."""

SWEEPS = 30
"""Sweeps of rotations at most."""
ORTHOGONAL = 1e-15
DEPENDENT = 1e-12
"""Part of the largest singular value below which one is zero."""


@internal
def begin_giving(contacts):
    """Let no way give way yet."""
    for k in range(contacts.place.shape[0]):
        contacts.sticks.vector[arrays.GIVES, k] = 0.0


@internal
def may_give(contacts):
    """Return True if a way moved in some try."""
    moves = False
    for k in range(gaps_of(contacts), contacts.place.shape[0]):
        moves = moves or contacts.sticks.vector[arrays.GIVES, k] != 0.0
    return moves


@internal
def keep_pushes(contacts):
    """Keep normal forces before they are shared."""
    for k in range(gaps_of(contacts)):
        contacts.vector[arrays.PUSH, k] = contacts.sticks.vector[arrays.FORCE, k]


@internal
def _limit_of(contacts, k, pushes):
    """Return the limit of friction of a way at rest under normal forces ``pushes`` (c,)."""
    gaps = gaps_of(contacts)
    if contacts.chosen[arrays.RESTING, k] != 0:
        return contacts.sticks.vector[arrays.LIMIT, k]
    return contacts.friction.number[k - gaps, arrays.HOLDING] * pushes[contacts.friction.gap[k - gaps]]


@internal
def note_giving(contacts, rounding):
    """Note which ways move under vector[FORCE], and which gaps push, if any way moves."""
    gaps = gaps_of(contacts)
    gives = contacts.sticks.vector[arrays.GIVES]
    force = contacts.sticks.vector[arrays.FORCE]
    taking = contacts.chosen[arrays.TAKING]
    moves = False
    for k in range(gaps, taking.shape[0]):
        if taking[k] != 0:
            limit = _limit_of(contacts, k, contacts.vector[arrays.PUSH])
            moves = moves or left_of(contacts, force, k, limit, rounding) != 0.0
    if not moves:
        return
    for k in range(taking.shape[0]):
        gives[k] = 0.0
        if taking[k] != 0 and k < gaps:
            gives[k] = 1.0 if contacts.vector[arrays.PUSH, k] > 0.0 else 0.0
        elif taking[k] != 0:
            left = left_of(contacts, force, k, _limit_of(contacts, k, contacts.vector[arrays.PUSH]), rounding)
            gives[k] = math.copysign(1.0, left) if left != 0.0 else 0.0


@lazy(None)
def solve_giving(contacts):
    """Fill vector[FORCE] with N and T where ways give way as GIVES says."""
    gaps = gaps_of(contacts)
    gives = contacts.sticks.vector[arrays.GIVES]
    force = contacts.sticks.vector[arrays.FORCE]
    limit = contacts.sticks.vector[arrays.LIMIT]
    taking = contacts.chosen[arrays.TAKING]
    friction = contacts.friction
    compliance = friction.compliance
    table = contacts.tableau
    places = contacts.basis[1]
    n = 0
    for k in range(taking.shape[0]):
        force[k] = 0.0
        if taking[k] == 0:
            continue
        if (k < gaps) == (gives[k] != 0.0):
            places[n] = k
            n += 1
        elif k >= gaps and contacts.chosen[arrays.RESTING, k] != 0:
            force[k] = -gives[k] * limit[k]
    last = 2 * n
    for i in range(n):
        row = places[i]
        right = -contacts.vector[arrays.FREE, row]
        for k in range(gaps, taking.shape[0]):
            right -= compliance[row, k] * force[k]
        table[i, last] = right
        for j in range(n):
            k = places[j]
            value = compliance[row, k]
            for w in range(friction.gap.shape[0]):
                p = gaps + w
                if friction.gap[w] == k and taking[p] != 0 and gives[p] != 0.0:
                    value -= compliance[row, p] * gives[p] * friction.number[w, arrays.HOLDING]
            table[i, j] = value
            table[i, n + j] = 1.0 if i == j else 0.0
    solve_least(table, n)
    for i in range(n):
        force[places[i]] = table[i, last + 1]
    for w in range(friction.gap.shape[0]):
        p = gaps + w
        if taking[p] != 0 and gives[p] != 0.0:
            force[p] = -gives[p] * friction.number[w, arrays.HOLDING] * force[friction.gap[w]]


@lazy(None)
def solve_least(table, n):
    """Put the shortest x with least |A x - b| in column 2 n + 1 of a table (n, 2 n + 2) of A, a unit matrix and b."""
    for _ in range(SWEEPS):
        rotated = False
        for p in range(n):
            for q in range(p + 1, n):
                a = 0.0
                b = 0.0
                c = 0.0
                for i in range(n):
                    a += table[i, p] * table[i, p]
                    b += table[i, q] * table[i, q]
                    c += table[i, p] * table[i, q]
                if abs(c) <= ORTHOGONAL * math.sqrt(a * b):
                    continue
                rotated = True
                zeta = (b - a) / (2.0 * c)
                tangent = math.copysign(1.0, zeta) / (abs(zeta) + math.sqrt(1.0 + zeta * zeta))
                cosine = 1.0 / math.sqrt(1.0 + tangent * tangent)
                sine = cosine * tangent
                for i in range(n):
                    for first in range(0, 2 * n, n):
                        left = table[i, first + p]
                        right = table[i, first + q]
                        table[i, first + p] = cosine * left - sine * right
                        table[i, first + q] = sine * left + cosine * right
        if not rotated:
            break
    largest = 0.0
    for j in range(n):
        square = 0.0
        for i in range(n):
            square += table[i, j] * table[i, j]
        largest = max(largest, square)
    for i in range(n):
        table[i, 2 * n + 1] = 0.0
    for j in range(n):
        square = 0.0
        along = 0.0
        for i in range(n):
            square += table[i, j] * table[i, j]
            along += table[i, j] * table[i, 2 * n]
        if square > DEPENDENT**2 * largest:
            for i in range(n):
                table[i, 2 * n + 1] += table[i, n + j] * along / square


@internal
def gives_way(contacts, rounding):
    """Return True if ways under vector[FORCE] move as GIVES says, and contacts push or open."""
    gaps = gaps_of(contacts)
    gives = contacts.sticks.vector[arrays.GIVES]
    force = contacts.sticks.vector[arrays.FORCE]
    taking = contacts.chosen[arrays.TAKING]
    agrees = True
    for k in range(taking.shape[0]):
        if taking[k] == 0:
            continue
        if k < gaps:
            bend = acceleration_of(contacts, force, k)[0]
            agrees = agrees and force[k] >= 0.0 and (gives[k] != 0.0 or bend >= 0.0)
            continue
        most = _limit_of(contacts, k, force)
        left = left_of(contacts, force, k, most, rounding)
        sign = math.copysign(1.0, left) if left != 0.0 else 0.0
        agrees = agrees and sign == gives[k] and abs(force[k]) <= most * (1.0 + AT_LIMIT)
    return agrees


@internal
def _find_signs(dyn, contacts, halted):
    """Find signs of sliding of joints, after find_resting; in chosen[RESTING] forces are to decide."""
    resting = contacts.chosen[arrays.RESTING]
    joints = contacts.place.shape[0] - contacts.sticks.joint.shape[0]
    for k in range(contacts.place.shape[0]):
        resting[k] = 0
        if k < joints or contacts.number[k, arrays.RELEASED] != 0.0:
            continue
        rate = contacts.vector[arrays.RATE, k]
        sign = contacts.number[k, arrays.SIGN]
        if not holds(dyn, contacts, k):
            sign = sign if sign != 0.0 else 1.0
        elif abs(rate) > contacts.number[k, arrays.REST]:
            sign = math.copysign(1.0, rate)
        elif gives(contacts, k):
            sign = 0.0
            resting[k] = 1
        elif k == halted:
            sign = -sign
        elif sign == 0.0:
            sign = 1.0
        contacts.number[k, arrays.SIGN] = sign
        dyn.loads.friction_number[contacts.place[k, arrays.FRICTION], SENSE] = sign


@internal
def _choose(dyn, scratch, contacts, v, halted):
    """Choose what slides and what is at rest at velocities v (3 nb,), and the rows whose forces are sought."""
    find_resting(dyn, scratch, contacts, v, halted)
    guess(contacts)
    _find_signs(dyn, contacts, halted)
    press(contacts)
    for k in range(contacts.place.shape[0] - contacts.sticks.joint.shape[0], contacts.place.shape[0]):
        contacts.chosen[arrays.TAKING, k] = contacts.chosen[arrays.RESTING, k]


@lazy(None)
def _share_rest(contacts, rounding):
    """Share friction among the joints that stay at rest, with contacts that stick N and T."""
    vector = contacts.sticks.vector
    number = contacts.friction.number
    gaps = gaps_of(contacts)
    mixed = False
    find_left(contacts, rounding)
    within = 0
    for k in range(contacts.place.shape[0]):
        stays = contacts.chosen[arrays.RESTING, k] != 0 and vector[arrays.LEFT, k] == 0.0
        contacts.chosen[arrays.TOUCHING, k] = 1 if stays else 0
        within += contacts.chosen[arrays.TOUCHING, k]
    for w in range(number.shape[0]):
        k = contacts.friction.gap[w]
        limit = number[w, arrays.HOLDING] * vector[arrays.FORCE, k]
        at_rest = within > 0 and contacts.chosen[arrays.TAKING, gaps + w] != 0 and vector[arrays.FORCE, k] > 0.0
        if at_rest and left_of(contacts, vector[arrays.FORCE], gaps + w, limit, rounding) == 0.0:
            contacts.chosen[arrays.TOUCHING, gaps + w] = 1
            mixed = True
    if mixed:
        for k in range(gaps):
            contacts.chosen[arrays.TOUCHING, k] = (
                1 if contacts.chosen[arrays.TAKING, k] != 0 and vector[arrays.FORCE, k] > 0.0 else 0
            )
        divide_together(
            contacts, contacts.chosen[arrays.TOUCHING], vector[arrays.FORCE], vector[arrays.LIMIT], arrays.HOLDING
        )
    elif within > 1:
        sticks = contacts.sticks
        divide(
            contacts.compliance,
            contacts.chosen[arrays.TOUCHING],
            vector[arrays.FORCE],
            vector[arrays.LIMIT],
            sticks.division,
        )


@internal
def find_left(contacts, rounding):
    """Fill sticks.vector[LEFT] with accelerations of ways at rest under forces, zero where friction holds them.

    ``rounding``: part of what acts that counts as none.
    """
    count = contacts.place.shape[0]
    vector = contacts.sticks.vector
    for k in range(count):
        vector[arrays.LEFT, k] = 0.0
        if contacts.chosen[arrays.RESTING, k] == 0:
            continue
        vector[arrays.LEFT, k] = left_of(contacts, vector[arrays.FORCE], k, vector[arrays.LIMIT, k], rounding)


@internal
def _loads_in_plane(dyn, scratch, contacts, t, y):
    load = contacts.sticks.load[0]
    for c in range(load.shape[0]):
        load[c] = dyn.weight[c]
    if dyn.loads.total > 0:
        apply_loads(dyn.loads, dyn.laws, t, y[0], y[1], scratch.ws.cos_sin, load)


@internal
def _loads(dyn, scratch, contacts, t, y):
    load = contacts.sticks.load[0]
    for c in range(load.shape[0]):
        load[c] = scratch.force[c]
    for b in range(dyn.schur.rows.shape[0]):
        for s in range(2):
            row = dyn.schur.rows[b, s]
            if row >= 0:
                push(dyn, scratch, row, contacts.lam[row], load)


@internal
def _add_friction_in_plane(dyn, scratch, v, normal, load):
    apply_friction(dyn.system, dyn.loads, v, scratch.ws, normal, 1.0, load)


@internal
def _add_no_friction(dyn, scratch, v, normal, load):
    pass


find_loads = alternatives({Dynamics: _loads_in_plane}, _loads)
"""(dyn, scratch, contacts, t, y): fill sticks.load[0] with all loads but friction of joints, after stand. In added
formulations they are what accelerations have left of the forces, and what the rows that hold carry."""
add_friction = alternatives({Dynamics: _add_friction_in_plane}, _add_no_friction)
"""(dyn, scratch, v, normal, load): add friction of joints under normal forces (f,); added formulations have none."""


@lazy(None)
def _press_joints(dyn, scratch, contacts, lam):
    """Fill normal[FOUND] by multipliers lam (m,), to which vector[FORCE] and friction of sliding contacts are added."""
    friction = contacts.friction
    sticks = contacts.sticks
    for k in range(contacts.place.shape[0]):
        if contacts.chosen[arrays.TAKING, k] != 0:
            for r in range(lam.shape[0]):
                lam[r] += sticks.borne[k, r] * sticks.vector[arrays.FORCE, k]
    for w in range(friction.gap.shape[0]):
        normal = sticks.vector[arrays.FORCE, friction.gap[w]]
        force = -friction.number[w, arrays.KINETIC] * friction.number[w, arrays.GUESS] * normal
        if force != 0.0:
            for r in range(lam.shape[0]):
                lam[r] += contacts.sticks.borne[gaps_of(contacts) + w, r] * force
    normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, sticks.normal[arrays.FOUND])


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
    add_friction(dyn, scratch, v, sticks.normal[arrays.NOW], load)
    largest = 0.0
    for c in range(3, load.shape[0]):
        largest = max(largest, abs(load[c]))
    respond(dyn, scratch, load, 1.0, contacts.rates[1], lam)
    for k in range(contacts.place.shape[0]):
        row = contacts.place[k, arrays.ROW]
        sticks.vector[arrays.LIMIT, k] = 0.0
        if contacts.chosen[arrays.RESTING, k] != 0:
            sticks.vector[arrays.LIMIT, k] = hair * limit_of(
                dyn, contacts.place[k, arrays.FRICTION], sticks.normal[arrays.NOW]
            )
        if contacts.chosen[arrays.TAKING, k] != 0:
            contacts.vector[arrays.FREE, k] = along(dyn, scratch, row, contacts.rates[1]) - scratch.ws.right[0, row]
    pressed = contacts.friction.compliance
    if giving:
        solve_giving(contacts)
    else:
        if not solve_with_friction(
            contacts, pressed, contacts.vector[arrays.FREE], arrays.HOLDING, sticks.vector[arrays.FORCE]
        ):
            return -1.0
        keep_pushes(contacts)
        if sticks.joint.shape[0] > 0:
            _share_rest(contacts, rounding)
        note_giving(contacts, rounding)
    if sticks.normal.shape[1] > 0:
        _press_joints(dyn, scratch, contacts, lam)
    return largest


@apart
def _agree(dyn, scratch, contacts, v, hair, rounding, giving):
    """Repeat that until the normal forces of the joints agree; returns the largest load, -1 if they do not."""
    normal = contacts.sticks.normal
    count = normal.shape[1]
    weight = 1.0
    for k in range(count):
        before = dyn.loads.normal[X, k]
        normal[arrays.NOW, k] = before if math.isfinite(before) else 0.0
        normal[arrays.LAST, k] = 0.0
    for turn in range(MOST_PASSES):
        largest = _try(dyn, scratch, contacts, v, hair, rounding, giving)
        if largest < 0.0:
            return largest
        worst = 0.0
        most = FAINT_LOAD * largest
        product = 0.0
        square = 0.0
        for k in range(count):
            gap = normal[arrays.FOUND, k] - normal[arrays.NOW, k]
            if not math.isfinite(gap):
                contacts.clock[arrays.FAILURE] = arrays.NO_AGREEMENT
                return -1.0
            worst = max(worst, abs(gap))
            most = max(most, normal[arrays.FOUND, k])
            product += normal[arrays.LAST, k] * (gap - normal[arrays.LAST, k])
            square += (gap - normal[arrays.LAST, k]) ** 2
        if worst <= (SETTLED if turn < PATIENCE else ROUNDING) * most:
            return largest
        weight = min(max(-weight * product / square, -10.0), 10.0) if turn > 0 and square != 0.0 else 1.0
        for k in range(count):
            gap = normal[arrays.FOUND, k] - normal[arrays.NOW, k]
            normal[arrays.LAST, k] = gap
            normal[arrays.NOW, k] = max(normal[arrays.NOW, k] + weight * gap, 0.0)
    contacts.clock[arrays.FAILURE] = arrays.NO_AGREEMENT
    return -1.0


@lazy(bool)
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
    stand(dyn, scratch, contacts, state.clock[TIME], state.y)
    begin_deciding(contacts, hair)
    find_loads(dyn, scratch, contacts, state.clock[TIME], state.y)
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
            contacts.vector[arrays.NORMAL, k] = contacts.sticks.vector[arrays.FORCE, k]
        if not breaks(contacts, FAINT * largest, rounding):
            break
    find_left(contacts, rounding)
    begin_touched(contacts, touched, FAINT * largest, rounding)
    for k in range(count):
        if (
            k < gaps
            and contacts.vector[arrays.NORMAL, k] != BEGINS
            and not contacts.vector[arrays.NORMAL, k] > FAINT * largest
        ):
            contacts.vector[arrays.NORMAL, k] = 0.0
        elif contacts.chosen[arrays.RESTING, k] != 0:
            left = contacts.sticks.vector[arrays.LEFT, k]
            contacts.number[k, arrays.SIGN] = math.copysign(1.0, left) if left != 0.0 else 0.0
    return True
