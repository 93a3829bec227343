"""Friction of closed contacts and of joints that stick: what they push with, and whether they slide or stick.

Contacts slide or stick from now on by

    0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= mu_s N, s'' = 0 or against T

Normal forces and friction are a linear complementarity problem, in accelerations, or in velocities for impulses.
Without N and T gaps open with g, ways go on with s:

    0 <= N complementary to g + G_n N + G_nt T >= 0;    |T| <= mu N + L, and the way rests or goes against T

in N, T = T+ - T-, and the slack l of the friction limit:

    w  = G_n N + G_nt T + g                  w+ = G_tn N + G_t T + l + s
    w_l = mu N + L - T+ - T-                 w- = -(G_tn N + G_t T) + l - s

L is the limit of friction of a joint, whose normal force is none of N.

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 5; Stewart, Trinkle 1996, Int. J. Numer.
Meth. Eng. 39.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.events import arrays
from mbsd.dynamics.events.laws.complementarity import lowest_row, pivot_to_end
from mbsd.dynamics.events.rows import STIFF, find_rates, gaps_of, keep_independent, move_zero, stop
from mbsd.equations.joint_friction import STATIC as JOINT_STATIC

AT_LIMIT = 1e-10
"""Part of the limit of friction: closer to it a contact slides."""
UNSURE = 1e-13
"""Part of the acceleration of a way without normal forces and friction that is rounding of what these leave of it."""
GRAZING = 1e-7
"""Part of what acts on a gap below which its acceleration is none, where a contact closes that does not push yet."""
BEGINS = 1e-300
"""Normal force of a contact that holds though it does not push yet (N)."""
FAINT = 1e-12
"""Part of the largest load below which a normal force is none."""
IN_TURN = 5
"""Events at one time, for each contact, after which contacts are no longer taken one by one."""


@internal
def gives(contacts, k):
    """Return True if a force along way k moves anything: not at a turning point, nor where drivers alone move it."""
    return contacts.compliance[k, k] > STIFF * contacts.vector[arrays.ALONE, k]


@internal
def holds(dyn, contacts, k):
    """Return True if friction can hold way k: not of a released joint, nor with a coefficient of zero."""
    at = contacts.place[k, arrays.FRICTION]
    if contacts.number[k, arrays.RELEASED] != 0.0:
        return False
    return at < 0 or dyn.loads.friction_number[at, JOINT_STATIC] > 0.0


@internal
def _halts(contacts, k, gaps, halted):
    """Return True if way k has just come to rest."""
    w = k - gaps
    return contacts.friction.number[w, arrays.BROKEN] == 0.0 if w < contacts.friction.gap.shape[0] else k == halted


@internal
def _more_rest(dyn, contacts, gaps, halted):
    """Add ways to chosen[RESTING] by vector[RATE]; whether there were more."""
    friction = contacts.friction
    resting = contacts.chosen[arrays.RESTING]
    more = False
    for k in range(gaps, resting.shape[0]):
        w = k - gaps
        if resting[k] != 0 or (w < friction.gap.shape[0] and contacts.chosen[arrays.STAYING, friction.gap[w]] == 0):
            continue
        if not holds(dyn, contacts, k):
            continue
        slow = abs(contacts.vector[arrays.RATE, k]) <= contacts.number[k, arrays.REST]
        if gives(contacts, k) and (slow or _halts(contacts, k, gaps, halted)):
            resting[k] = 1
            more = True
    return more


@apart
def find_resting(dyn, scratch, contacts, v, halted):
    """Fill chosen[RESTING] with the ways at rest at velocities v (3 nb,), and vector[RATE].

    Those at rest are taken to be so exactly: others may be at rest with them. Contacts that have just come to rest have
    a BROKEN of 0; ``halted`` is the joint that has, -1 if none has.
    """
    gaps = gaps_of(contacts)
    own = contacts.rates[0]
    for k in range(contacts.place.shape[0]):
        contacts.chosen[arrays.RESTING, k] = 0
    find_rates(dyn, scratch, contacts, v)
    while _more_rest(dyn, contacts, gaps, halted):
        for c in range(v.shape[0]):
            own[c] = v[c]
        keep_independent(contacts, contacts.chosen[arrays.RESTING])
        stop(dyn, scratch, contacts, own)
        find_rates(dyn, scratch, contacts, own)
    for k in range(gaps, contacts.place.shape[0]):
        if _halts(contacts, k, gaps, halted):
            contacts.vector[arrays.RATE, k] = 0.0


@internal
def _fill_tableau(contacts, compliance, rates, first, both, size, fastest):
    """Fill the tableau with the ``both`` rows that may give way, of which gaps are the ``first``; w = z at the begin.

    ``size``: of compliances, ``fastest``: of rates, by which all is divided.
    """
    alone = contacts.vector[arrays.ALONE]
    tableau = contacts.tableau
    places = contacts.basis[1]
    ways = both - first
    n = first + 3 * ways
    last = 2 * n + 1
    for i in range(n):
        for j in range(last):
            tableau[i, j] = 0.0
        tableau[i, i] = 1.0
        tableau[i, 2 * n] = -1.0
    for i in range(both):
        unit = 1.0 / math.sqrt(alone[places[i]])
        rate = rates[places[i]] * unit / fastest
        tableau[i, last] = rate
        if i >= first:
            tableau[i + ways, last] = -rate
        for j in range(both):
            value = compliance[places[i], places[j]] * unit / math.sqrt(alone[places[j]]) / size
            tableau[i, n + j] = -value
            if j >= first:
                tableau[i, n + j + ways] = value
            if i >= first:
                tableau[i + ways, n + j] = value
                if j >= first:
                    tableau[i + ways, n + j + ways] = -value


@lazy(bool)
def solve_with_friction(contacts, compliance, rates, coefficient, out):
    """Fill out (c,) with N of the gaps and T of the ways in chosen[TAKING], 0 of others.

    ``compliance`` (c, c) and ``rates`` (c,) are those without N and T; ``coefficient`` is the column of Friction.number
    with mu. L stands in its BESIDE, of joints in LIMIT. Returns False where nothing gives way, or no N and T are
    possible.
    """
    taking = contacts.chosen[arrays.TAKING]
    alone = contacts.vector[arrays.ALONE]
    tableau = contacts.tableau
    places = contacts.basis[1]
    friction = contacts.friction
    rows = taking.shape[0]
    gaps = gaps_of(contacts)
    joints = rows - contacts.sticks.joint.shape[0]
    both = 0
    first = 0
    size = 0.0
    fastest = 0.0
    for p in range(rows):
        out[p] = 0.0
        if taking[p] == 0:
            continue
        if p < gaps and not compliance[p, p] > STIFF * alone[p]:
            return False
        size = max(size, abs(compliance[p, p]) / alone[p])
        fastest = max(fastest, abs(rates[p]) / math.sqrt(alone[p]))
        places[both] = p
        both += 1
        if p < gaps:
            first = both
    if size == 0.0:
        size = 1.0
    if fastest == 0.0:
        fastest = 1.0
    ways = both - first
    n = first + 3 * ways
    last = 2 * n + 1
    _fill_tableau(contacts, compliance, rates, first, both, size, fastest)
    for k in range(ways):
        way = places[first + k]
        unit = 1.0 / math.sqrt(alone[way])
        slack = first + 2 * ways + k
        tableau[first + k, n + slack] = -1.0
        tableau[first + ways + k, n + slack] = -1.0
        tableau[slack, n + first + k] = 1.0
        tableau[slack, n + first + ways + k] = 1.0
        if way >= joints:
            tableau[slack, last] = contacts.sticks.vector[arrays.LIMIT, way] / unit * size / fastest
            continue
        number = friction.number[way - gaps]
        tableau[slack, last] = number[arrays.BESIDE] / unit * size / fastest
        for j in range(first):
            if places[j] == friction.gap[way - gaps]:
                tableau[slack, n + j] = -number[coefficient] / unit / math.sqrt(alone[places[j]])
    lowest = lowest_row(tableau, n)
    if lowest < 0:
        return True
    if not pivot_to_end(tableau, contacts.basis[0], n, lowest):
        return False
    for i in range(n):
        variable = contacts.basis[0, i] - n
        if not 0 <= variable < first + 2 * ways:
            continue
        value = max(tableau[i, last], 0.0) * fastest / size
        back = variable >= both
        p = places[variable - ways] if back else places[variable]
        out[p] += (-value if back else value) / math.sqrt(alone[p])
    return True


@internal
def note_met(contacts, met, lam):
    """Fill FORCED after the row ``met`` of contacts fell through zero, the multipliers lam (m,) being those before."""
    number = contacts.friction.number
    gaps = gaps_of(contacts)
    for w in range(number.shape[0]):
        number[w, arrays.FORCED] = arrays.NO_SIGN
    if gaps <= met < gaps + number.shape[0]:
        slips = contacts.number[met, arrays.CLOSED] > 0.0
        force = lam[contacts.place[met, arrays.ROW]]
        number[met - gaps, arrays.FORCED] = math.copysign(1.0, force) if slips and force != 0.0 else 0.0


@internal
def one_by_one(contacts):
    """Return True if contacts may come to their limits one by one: none loses friction, no joint sticks.

    What one at its limit lacks the others carry, and nothing moves before all of them are there. Not where they come to
    their limits again and again at one time.
    """
    number = contacts.friction.number
    out = contacts.sticks.joint.shape[0] == 0 and contacts.clock[arrays.AT_ONCE] <= IN_TURN * gaps_of(contacts)
    for w in range(number.shape[0]):
        out = out and number[w, arrays.STATIC] <= number[w, arrays.KINETIC]
    return out


@internal
def acceleration_of(contacts, forces, k):
    """Return the acceleration of row k under N and T in ``forces`` (c,) of chosen[TAKING], and its largest part."""
    out = contacts.vector[arrays.FREE, k]
    most = abs(out)
    for j in range(contacts.place.shape[0]):
        if contacts.chosen[arrays.TAKING, j] != 0:
            part = contacts.friction.compliance[k, j] * forces[j]
            out += part
            most = max(most, abs(part))
    return out, most


@internal
def left_of(contacts, forces, k, limit, rounding):
    """Return the acceleration of way k, 0 where friction up to ``limit`` holds it; ``rounding``: part taken as 0."""
    left = acceleration_of(contacts, forces, k)[0]
    own = contacts.compliance[k, k]
    others = abs(left - own * forces[k])
    zero = max(rounding * max(own * limit, others), UNSURE * abs(contacts.vector[arrays.FREE, k]))
    return left if abs(left) > zero else 0.0


@internal
def begin_touched(contacts, touched, faint, rounding):
    """Let gap ``touched`` hold that has just closed, where it does not push yet: its push begins now."""
    if touched < 0 or contacts.chosen[arrays.STAYING, touched] == 0 or contacts.vector[arrays.NORMAL, touched] > faint:
        return
    left, most = acceleration_of(contacts, contacts.vector[arrays.NORMAL], touched)
    if abs(left) > GRAZING * most:
        return
    friction = contacts.friction
    gaps = gaps_of(contacts)
    for w in range(friction.gap.shape[0]):
        if friction.gap[w] == touched and friction.number[w, arrays.GUESS] == 0.0:
            along = left_of(contacts, contacts.vector[arrays.NORMAL], gaps + w, 0.0, rounding)
            friction.number[w, arrays.NEXT_SIGN] = math.copysign(1.0, along) if along != 0.0 else 0.0
    contacts.vector[arrays.NORMAL, touched] = BEGINS


@internal
def begin_deciding(contacts, hair):
    """Restore static friction, but of a contact that has come to its limit; ``hair``: part of the limit left."""
    number = contacts.friction.number
    for w in range(number.shape[0]):
        number[w, arrays.BROKEN] = number[w, arrays.FORCED]
        number[w, arrays.HOLDING] = hair * number[w, arrays.STATIC]


@internal
def guess(contacts):
    """Fill GUESS: signs of rates, 0 of ways at rest, after find_resting."""
    number = contacts.friction.number
    gaps = gaps_of(contacts)
    for w in range(number.shape[0]):
        rate = contacts.vector[arrays.RATE, gaps + w]
        number[w, arrays.GUESS] = 0.0
        if number[w, arrays.BROKEN] != arrays.NO_SIGN:
            number[w, arrays.GUESS] = number[w, arrays.BROKEN]
        elif abs(rate) > contacts.number[gaps + w, arrays.REST]:
            number[w, arrays.GUESS] = math.copysign(1.0, rate)


@internal
def press(contacts):
    """Choose the gaps and ways of contacts that push, and let normal forces of sliding ones push with their friction.

    Of joints those in chosen[STAYING], where none is.
    """
    friction = contacts.friction
    number = friction.number
    pressed = friction.compliance
    taking = contacts.chosen[arrays.TAKING]
    count = taking.shape[0]
    gaps = gaps_of(contacts)
    for k in range(count):
        taking[k] = contacts.chosen[arrays.STAYING, k]
        for j in range(count):
            pressed[k, j] = contacts.compliance[k, j]
    for w in range(number.shape[0]):
        k = friction.gap[w]
        number[w, arrays.BESIDE] = 0.0
        taking[gaps + w] = 1 if taking[k] != 0 and number[w, arrays.GUESS] == 0.0 else 0
        if number[w, arrays.GUESS] != 0.0:
            for j in range(count):
                pressed[j, k] -= number[w, arrays.KINETIC] * number[w, arrays.GUESS] * contacts.compliance[j, gaps + w]


@internal
def breaks(contacts, faint, rounding):
    """Fill NEXT_SIGN by N and T in vector[NORMAL]; whether static friction broke where less holds once it slides."""
    friction = contacts.friction
    number = friction.number
    gaps = gaps_of(contacts)
    broken = False
    plain = one_by_one(contacts)
    for w in range(number.shape[0]):
        number[w, arrays.NEXT_SIGN] = number[w, arrays.GUESS]
        normal = contacts.vector[arrays.NORMAL, friction.gap[w]]
        along = contacts.vector[arrays.NORMAL, gaps + w]
        if contacts.chosen[arrays.TAKING, gaps + w] == 0 or not normal > faint or along == 0.0:
            continue
        limit = number[w, arrays.HOLDING] * normal
        if abs(along) < limit * (1.0 - AT_LIMIT):
            continue
        if plain or left_of(contacts, contacts.vector[arrays.NORMAL], gaps + w, limit, rounding) != 0.0:
            number[w, arrays.NEXT_SIGN] = -math.copysign(1.0, along)
            if number[w, arrays.STATIC] > number[w, arrays.KINETIC]:
                number[w, arrays.BROKEN] = number[w, arrays.NEXT_SIGN]
                broken = True
    return broken


@internal
def slide_or_stick(scratch, contacts):
    """Let contacts slide and stick as NEXT_SIGN says, those with a normal force; choose the ways that stick."""
    friction = contacts.friction
    number = friction.number
    gaps = gaps_of(contacts)
    for w in range(number.shape[0]):
        p = gaps + w
        closed = contacts.number[friction.gap[w], arrays.CLOSED] > 0.0
        sticks = closed and number[w, arrays.NEXT_SIGN] == 0.0
        if sticks and not contacts.number[p, arrays.CLOSED] > 0.0:
            move_zero(scratch, contacts, p)
        contacts.number[p, arrays.SIGN] = number[w, arrays.NEXT_SIGN] if closed else 0.0
        contacts.number[p, arrays.CLOSED] = 1.0 if sticks else 0.0
        contacts.chosen[arrays.TAKING, p] = 1 if sticks else 0
