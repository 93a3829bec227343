"""Which contacts with friction slide from now on and which stick: events/laws/stick_slip.py for contacts, compiled.

0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= mu_s N, s'' = 0 or against T
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.bounds import AT_LIMIT
from mbsd.dynamics.many.contacts.arrays import (
    ALONE,
    BESIDE,
    BROKEN,
    CLOSED,
    FORCED,
    FREE,
    GUESS,
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
from mbsd.dynamics.many.contacts.friction.pushes import solve_with_friction
from mbsd.dynamics.many.contacts.pushes import STIFF
from mbsd.dynamics.many.contacts.rows import find_rates, keep_independent, move_zero, stop


@internal
def note_met(contacts, met, lam):
    """Fill FORCED after the row ``met`` of contacts fell through zero, the multipliers lam (m,) being those before."""
    number = contacts.friction.number
    gaps = contacts.place.shape[0] - number.shape[0]
    for w in range(number.shape[0]):
        number[w, FORCED] = NO_SIGN
    if met >= gaps:
        slips = contacts.number[met, CLOSED] > 0.0
        force = lam[contacts.place[met, ROW]]
        number[met - gaps, FORCED] = math.copysign(1.0, force) if slips and force != 0.0 else 0.0


@lazy(bool)
def find_friction(dyn, scratch, contacts, v, faint):
    """Fill vector[NORMAL] with N and T of the contacts in chosen[STAYING], and NEXT_SIGN.

    vector[FREE] are the accelerations of all rows without N and T, v (3 nb,) the velocities; an N up to ``faint`` is
    none. Returns False where no N and T are possible.
    """
    number = contacts.friction.number
    for w in range(number.shape[0]):
        number[w, BROKEN] = number[w, FORCED]
    for _ in range(number.shape[0] + 1):
        _guess(dyn, scratch, contacts, v)
        _press(contacts)
        if not solve_with_friction(contacts, contacts.friction.compliance, contacts.vector[FREE], STATIC):
            return False
        if not _breaks(contacts, faint):
            break
    return True


@internal
def _guess(dyn, scratch, contacts, v):
    """Fill GUESS: signs of rates, 0 of ways at rest; these are taken to be so exactly, as others may rest with them."""
    friction = contacts.friction
    number = friction.number
    resting = contacts.chosen[TAKING]
    gaps = contacts.place.shape[0] - number.shape[0]
    own = friction.velocity
    for k in range(resting.shape[0]):
        resting[k] = 0
    for c in range(v.shape[0]):
        own[c] = v[c]
    find_rates(dyn, scratch, contacts, own)
    more = True
    while more:
        more = False
        for w in range(number.shape[0]):
            p = gaps + w
            if contacts.chosen[STAYING, friction.gap[w]] == 0 or resting[p] != 0:
                continue
            gives = contacts.compliance[p, p] > STIFF * contacts.vector[ALONE, p]
            slow = number[w, BROKEN] == 0.0 or abs(contacts.vector[RATE, p]) <= contacts.number[p, REST]
            if gives and slow:
                resting[p] = 1
                more = True
        if more:
            for c in range(v.shape[0]):
                own[c] = v[c]
            keep_independent(contacts, resting)
            stop(dyn, scratch, contacts, own)
            find_rates(dyn, scratch, contacts, own)
    for w in range(number.shape[0]):
        rate = contacts.vector[RATE, gaps + w]
        number[w, GUESS] = 0.0
        if number[w, BROKEN] != NO_SIGN:
            number[w, GUESS] = number[w, BROKEN]
        elif abs(rate) > contacts.number[gaps + w, REST]:
            number[w, GUESS] = math.copysign(1.0, rate)


@internal
def _press(contacts):
    """Choose the rows that push, and let the normal forces of sliding contacts push with their friction."""
    friction = contacts.friction
    number = friction.number
    pressed = friction.compliance
    taking = contacts.chosen[TAKING]
    count = taking.shape[0]
    gaps = count - number.shape[0]
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
def _breaks(contacts, faint):
    """Fill NEXT_SIGN; whether static friction was at its limit somewhere, where less holds once it slides."""
    friction = contacts.friction
    number = friction.number
    gaps = contacts.place.shape[0] - number.shape[0]
    breaks = False
    for w in range(number.shape[0]):
        number[w, NEXT_SIGN] = number[w, GUESS]
        normal = contacts.vector[NORMAL, friction.gap[w]]
        along = contacts.vector[NORMAL, gaps + w]
        if contacts.chosen[TAKING, gaps + w] == 0 or not normal > faint or along == 0.0:
            continue
        if abs(along) >= number[w, STATIC] * normal * (1.0 - AT_LIMIT):
            number[w, NEXT_SIGN] = -math.copysign(1.0, along)
            if number[w, STATIC] > number[w, KINETIC]:
                number[w, BROKEN] = number[w, NEXT_SIGN]
                breaks = True
    return breaks


@internal
def slide_or_stick(dyn, scratch, contacts):
    """Let contacts slide and stick as NEXT_SIGN says, those with a normal force; choose the ways that stick."""
    friction = contacts.friction
    number = friction.number
    gaps = contacts.place.shape[0] - number.shape[0]
    for w in range(number.shape[0]):
        p = gaps + w
        closed = contacts.number[friction.gap[w], CLOSED] > 0.0
        sticks = closed and number[w, NEXT_SIGN] == 0.0
        if sticks and not contacts.number[p, CLOSED] > 0.0:
            move_zero(scratch, contacts, p)
        contacts.number[p, SIGN] = number[w, NEXT_SIGN] if closed else 0.0
        dyn.sliding.table[w, 0] = number[w, KINETIC] * contacts.number[p, SIGN]
        contacts.number[p, CLOSED] = 1.0 if sticks else 0.0
        contacts.chosen[TAKING, p] = 1 if sticks else 0
