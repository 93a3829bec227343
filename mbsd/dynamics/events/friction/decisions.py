"""Decisions of contacts with friction: slide or stick from now on.

0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= mu_s N, s'' = 0 or against T
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.arrays import (
    AT_ONCE,
    BESIDE,
    BROKEN,
    CLOSED,
    FORCED,
    FREE,
    GUESS,
    HOLDING,
    KINETIC,
    NEXT_SIGN,
    NO_SIGN,
    NORMAL,
    RATE,
    REST,
    ROW,
    SIGN,
    STATIC,
    STAYING,
    TAKING,
)
from mbsd.dynamics.events.bounds import AT_LIMIT, BEGINS, GRAZING, IN_TURN, UNSURE
from mbsd.dynamics.events.friction.pushes import solve_with_friction
from mbsd.dynamics.events.friction.resting import find_resting
from mbsd.dynamics.events.rows import gaps_of, move_zero


@internal
def note_met(contacts, met, lam):
    """Fill FORCED after the row ``met`` of contacts fell through zero, the multipliers lam (m,) being those before."""
    number = contacts.friction.number
    gaps = gaps_of(contacts)
    for w in range(number.shape[0]):
        number[w, FORCED] = NO_SIGN
    if gaps <= met < gaps + number.shape[0]:
        slips = contacts.number[met, CLOSED] > 0.0
        force = lam[contacts.place[met, ROW]]
        number[met - gaps, FORCED] = math.copysign(1.0, force) if slips and force != 0.0 else 0.0


@internal
def one_by_one(contacts):
    """Return True if contacts may come to their limits one by one: none loses friction, no joint sticks.

    What one at its limit lacks the others carry, and nothing moves before all of them are there. Not where they come to
    their limits again and again at one time.
    """
    number = contacts.friction.number
    out = contacts.sticks.joint.shape[0] == 0 and contacts.clock[AT_ONCE] <= IN_TURN * gaps_of(contacts)
    for w in range(number.shape[0]):
        out = out and number[w, STATIC] <= number[w, KINETIC]
    return out


@internal
def acceleration_of(contacts, compliance, forces, k):
    """Return the acceleration of row k under N and T in ``forces`` (c,) of chosen[TAKING], and its largest part."""
    out = contacts.vector[FREE, k]
    most = abs(out)
    for j in range(contacts.place.shape[0]):
        if contacts.chosen[TAKING, j] != 0:
            part = compliance[k, j] * forces[j]
            out += part
            most = max(most, abs(part))
    return out, most


@internal
def left_of(contacts, forces, k, limit, rounding):
    """Return the acceleration of way k, 0 where friction up to ``limit`` holds it; ``rounding``: part taken as 0."""
    left = acceleration_of(contacts, contacts.friction.compliance, forces, k)[0]
    own = contacts.compliance[k, k]
    others = abs(left - own * forces[k])
    zero = max(rounding * max(own * limit, others), UNSURE * abs(contacts.vector[FREE, k]))
    return left if abs(left) > zero else 0.0


@internal
def begin_touched(contacts, compliance, touched, faint, rounding):
    """Let gap ``touched`` hold that has just closed, where it does not push yet: its push begins now."""
    if touched < 0 or contacts.chosen[STAYING, touched] == 0 or contacts.vector[NORMAL, touched] > faint:
        return
    left, most = acceleration_of(contacts, compliance, contacts.vector[NORMAL], touched)
    if abs(left) > GRAZING * most:
        return
    friction = contacts.friction
    gaps = gaps_of(contacts)
    for w in range(friction.gap.shape[0]):
        if friction.gap[w] == touched and friction.number[w, GUESS] == 0.0:
            along = left_of(contacts, contacts.vector[NORMAL], gaps + w, 0.0, rounding)
            friction.number[w, NEXT_SIGN] = math.copysign(1.0, along) if along != 0.0 else 0.0
    contacts.vector[NORMAL, touched] = BEGINS


@lazy(bool)
def find_friction(dyn, scratch, contacts, v, faint):
    """Fill vector[NORMAL] with N and T of the contacts in chosen[STAYING], and NEXT_SIGN.

    vector[FREE] are the accelerations of all rows without N and T, v (3 nb,) the velocities; an N up to ``faint`` is
    none. Returns False where no N and T are possible.
    """
    begin_deciding(contacts, 1.0)
    for _ in range(contacts.friction.gap.shape[0] + 1):
        find_resting(dyn, scratch, contacts, v, -1)
        guess(contacts)
        press(contacts)
        pressed = contacts.friction.compliance
        if not solve_with_friction(contacts, pressed, contacts.vector[FREE], HOLDING, contacts.vector[NORMAL]):
            return False
        if not breaks(contacts, faint, AT_LIMIT):
            break
    return True


@internal
def begin_deciding(contacts, hair):
    """Restore static friction, but of a contact that has come to its limit; ``hair``: part of the limit left."""
    number = contacts.friction.number
    for w in range(number.shape[0]):
        number[w, BROKEN] = number[w, FORCED]
        number[w, HOLDING] = hair * number[w, STATIC]


@internal
def guess(contacts):
    """Fill GUESS: signs of rates, 0 of ways at rest, after find_resting."""
    number = contacts.friction.number
    gaps = gaps_of(contacts)
    for w in range(number.shape[0]):
        rate = contacts.vector[RATE, gaps + w]
        number[w, GUESS] = 0.0
        if number[w, BROKEN] != NO_SIGN:
            number[w, GUESS] = number[w, BROKEN]
        elif abs(rate) > contacts.number[gaps + w, REST]:
            number[w, GUESS] = math.copysign(1.0, rate)


@internal
def press(contacts):
    """Choose the gaps and ways of contacts that push, and let normal forces of sliding ones push with their friction.

    Of joints those in chosen[STAYING], where none is.
    """
    friction = contacts.friction
    number = friction.number
    pressed = friction.compliance
    taking = contacts.chosen[TAKING]
    count = taking.shape[0]
    gaps = gaps_of(contacts)
    for k in range(count):
        taking[k] = contacts.chosen[STAYING, k]
        for j in range(count):
            pressed[k, j] = contacts.compliance[k, j]
    for w in range(number.shape[0]):
        k = friction.gap[w]
        number[w, BESIDE] = 0.0
        taking[gaps + w] = 1 if taking[k] != 0 and number[w, GUESS] == 0.0 else 0
        if number[w, GUESS] != 0.0:
            for j in range(count):
                pressed[j, k] -= number[w, KINETIC] * number[w, GUESS] * contacts.compliance[j, gaps + w]


@internal
def breaks(contacts, faint, rounding):
    """Fill NEXT_SIGN by N and T in vector[NORMAL]; whether static friction broke where less holds once it slides."""
    friction = contacts.friction
    number = friction.number
    gaps = gaps_of(contacts)
    broken = False
    plain = one_by_one(contacts)
    for w in range(number.shape[0]):
        number[w, NEXT_SIGN] = number[w, GUESS]
        normal = contacts.vector[NORMAL, friction.gap[w]]
        along = contacts.vector[NORMAL, gaps + w]
        if contacts.chosen[TAKING, gaps + w] == 0 or not normal > faint or along == 0.0:
            continue
        limit = number[w, HOLDING] * normal
        if abs(along) < limit * (1.0 - AT_LIMIT):
            continue
        if plain or left_of(contacts, contacts.vector[NORMAL], gaps + w, limit, rounding) != 0.0:
            number[w, NEXT_SIGN] = -math.copysign(1.0, along)
            if number[w, STATIC] > number[w, KINETIC]:
                number[w, BROKEN] = number[w, NEXT_SIGN]
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
        closed = contacts.number[friction.gap[w], CLOSED] > 0.0
        sticks = closed and number[w, NEXT_SIGN] == 0.0
        if sticks and not contacts.number[p, CLOSED] > 0.0:
            move_zero(scratch, contacts, p)
        contacts.number[p, SIGN] = number[w, NEXT_SIGN] if closed else 0.0
        contacts.number[p, CLOSED] = 1.0 if sticks else 0.0
        contacts.chosen[TAKING, p] = 1 if sticks else 0
