"""The search for the first event within a step, and its time.

Interior samples of the step's quintic also find scalars that dip below zero and come back, and those that leave zero
at the start of the step (a bounce) and return within it. What dips between two samples is found by its minimum
(roots.py). A gap that begins within rounding of zero, or an error of the integrator below, and opens by its rate and
its acceleration, does not close there: a multistep method begins anew with steps of order one, whose errors in places
are above the gap while it is so young. The same holds of the rate of a clutch and its acceleration, as places of a
method of order two do not go with its rates. A scalar that the quintic shows below zero is looked at again along the
motion itself, and the root is one of the motion.

k: a row of Contacts, whose scalar guards.py says; behind the last row come the events of the user.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.events import arrays
from mbsd.dynamics.events.guards import at_state, beyond_time, of_motion, on_quintic, sample, stand_at
from mbsd.dynamics.events.roots import MOST_ROOTS, SAMPLES, dips_before, may_dip, root_between
from mbsd.dynamics.events.rows import gaps_of, read_gaps
from mbsd.dynamics.events.user_search import first_event
from mbsd.dynamics.events.users import SIDE, rounding_of
from mbsd.dynamics.formulation import along, derivative
from mbsd.dynamics.integrators.root_search import narrowed, next_part
from mbsd.dynamics.state import TIME

LESS = 1e-3
"""Part of NEAR by which a state is changed to tell a jump from a slope."""

CHANCE = 15
"""Status of rows in which rounding decides whether an event happens."""
ROUNDING = 1e-10
"""Rounding of forces, as part of the largest."""


@internal
def still_of(contacts, k):
    """Return the size below which negative values of row k are rounding."""
    if k >= contacts.place.shape[0]:
        return 0.0
    return (
        ROUNDING * contacts.clock[arrays.LOAD]
        if contacts.number[k, arrays.CLOSED] > 0.0
        else contacts.number[k, arrays.NEAR]
    )


@apart
def _leaves(dyn, scratch, contacts, k):
    """Return True if a gap rises away from zero at the begin of the step, by its rates and its second derivative.

    The latter may be negative by the rounding of forces: where a contact has just opened nothing else is left of it.
    Of a clutch the scalar is the rate itself.
    """
    row = contacts.place[k, arrays.ROW]
    rest = -contacts.number[k, arrays.REST]
    t = stand_at(dyn, contacts, 1.0)
    read_gaps(dyn, scratch, t, contacts.pose[0])
    if not along(dyn, scratch, row, contacts.pose[1]) > rest:
        return False
    t = stand_at(dyn, contacts, 0.0)
    derivative(dyn, scratch, t, contacts.pose, contacts.rates, contacts.lam)
    if contacts.place[k, arrays.KIND] == arrays.GAP and not along(dyn, scratch, row, contacts.pose[1]) > rest:
        return False
    least = -ROUNDING * contacts.clock[arrays.LOAD] * contacts.compliance[k, k]
    return along(dyn, scratch, row, contacts.rates[1]) - scratch.ws.right[0, row] > least


@apart
def _falls(dyn, scratch, contacts, k, until):
    """Return where samples of row k show a fall through zero before ``until``, and a part beyond; -1, -1: nowhere."""
    still = still_of(contacts, k)
    values = contacts.samples[k]
    first = 0
    while first < SAMPLES - 1 and not values[first + 1] < -still:
        first += 1
    if first == SAMPLES - 1 or arrays.PARTS[first] >= until:
        return -1.0, -1.0
    where, negative = root_between(
        dyn,
        scratch,
        contacts,
        k,
        arrays.PARTS[first],
        arrays.PARTS[first + 1],
        values[first],
        values[first + 1],
        still,
        still,
    )
    is_open = contacts.place[k, arrays.KIND] in (arrays.GAP, arrays.CLUTCH) and contacts.number[k, arrays.CLOSED] == 0.0
    if where == 0.0 and is_open and _leaves(dyn, scratch, contacts, k):
        opened = 0
        while opened < SAMPLES and not values[opened] > still:
            opened += 1
        while opened < SAMPLES - 1 and not values[opened + 1] < -still:
            opened += 1
        if opened >= SAMPLES - 1:
            return -1.0, -1.0
        where, negative = root_between(
            dyn,
            scratch,
            contacts,
            k,
            arrays.PARTS[opened],
            arrays.PARTS[opened + 1],
            values[opened],
            values[opened + 1],
            still,
            still,
        )
    return where, negative


@apart
def _met_of(dyn, scratch, contacts, stepping, k, until):
    """Return where the guard of row k first falls through zero, and a part beyond; -1, -1 where it does not."""
    where, negative = _falls(dyn, scratch, contacts, k, until)
    still = still_of(contacts, k)
    return dips_before(
        dyn, scratch, contacts, stepping, k, contacts.parts, contacts.samples[k], SAMPLES,
        still, where, negative,
    )  # fmt: skip


@internal
def _may_meet(contacts, k):
    """Return True if samples of row k do not rule out a fall through zero; most steps end here."""
    still = still_of(contacts, k)
    values = contacts.samples[k]
    may = False
    for i in range(1, SAMPLES):
        may = may or values[i] < -still or may_dip(contacts.parts, values, i - 1, SAMPLES, still)
    return may


@lazy(int)
def _fallen(dyn, scratch, contacts, state):
    """Return the first row below zero after a step with no time within it, on which a quintic is rounding; -1: none."""
    contacts.clock[arrays.WHERE] = 1.0
    contacts.clock[arrays.BEYOND] = 1.0
    for k in range(contacts.place.shape[0] + contacts.events.table.shape[0]):
        if k >= contacts.place.shape[0] and contacts.events.number[k - contacts.place.shape[0], SIDE] == 0.0:
            continue
        if at_state(dyn, scratch, contacts, state, k) < -still_of(contacts, k):
            return k
    return -1


@apart
def first_met(dyn, scratch, state, contacts, stepping):
    """Return the row whose guard is the first to fall through zero within the step to ``state``; -1: none.

    What comes behind the last row is an event of the user. WHERE and BEYOND of the clock are set.
    """
    count = contacts.place.shape[0]
    friction = contacts.friction
    gaps = gaps_of(contacts)
    events = contacts.events.table.shape[0]
    middle = contacts.clock[arrays.START] + 0.5 * contacts.clock[arrays.LENGTH]
    if middle == contacts.clock[arrays.START] or middle == state.clock[TIME]:
        return _fallen(dyn, scratch, contacts, state)
    if count > 0:
        sample(dyn, scratch, contacts)
    for e in range(events):
        contacts.events.skipped[e] = 0
    for k in range(count):
        contacts.chosen[arrays.SKIPPED, k] = 0 if _may_meet(contacts, k) else 1
    for w in range(friction.gap.shape[0]):
        if contacts.number[gaps + w, arrays.CLOSED] == 0.0 and contacts.number[gaps + w, arrays.SIGN] == 0.0:
            contacts.chosen[arrays.SKIPPED, gaps + w] = 1
    for _ in range(count + events):
        best = -1
        for turn in range(2 * count):  # joints at rest come last where several are met at once
            k = friction.order[turn % count]
            resting = contacts.place[k, arrays.KIND] == arrays.WAY and contacts.number[k, arrays.CLOSED] > 0.0
            if contacts.chosen[arrays.SKIPPED, k] != 0 or resting != (turn >= count):
                continue
            until = 2.0 if best < 0 else contacts.clock[arrays.BEYOND]
            where, negative = _met_of(dyn, scratch, contacts, stepping, k, until)
            if where >= 0.0 and (best < 0 or where < contacts.clock[arrays.WHERE]):
                best = k
                contacts.clock[arrays.WHERE] = where
                contacts.clock[arrays.BEYOND] = negative
        if events > 0:
            best = first_event(dyn, scratch, contacts, stepping, best)
        if best < 0 or contacts.clock[arrays.WHERE] == 0.0:
            return best
        if contacts.clock[arrays.BEYOND] == 1.0:
            value = at_state(dyn, scratch, contacts, state, best)
        else:
            t = beyond_time(contacts)
            value = of_motion(dyn, scratch, contacts, stepping, best, t)
        if value < -still_of(contacts, best):
            if best >= count and _chance(contacts, state, best - count, value):
                contacts.clock[arrays.FAILURE] = CHANCE
                contacts.clock[arrays.WHICH] = 1.0 + best
                return -1
            return best
        if contacts.clock[arrays.FAILURE] != 0.0:
            return -1
        if best < count:  # the quintic falls below zero, the motion does not
            contacts.chosen[arrays.SKIPPED, best] = 1
        else:
            contacts.events.skipped[best - count] = 1
    return -1


@apart
def _chance(contacts, state, e, value):
    """Return True if rounding decides the sign of event e, whose value beyond the root this is, as its function jumps.

    A smooth function that is within rounding of zero changes by less where the state changes by less.
    """
    there = state
    if contacts.clock[arrays.BEYOND] != 1.0:
        there = contacts.trial
    jump = rounding_of(contacts.events, e, there.clock[TIME], there.y, 1.0)
    return abs(value) <= jump and rounding_of(contacts.events, e, there.clock[TIME], there.y, LESS) >= 0.5 * jump


@apart
def _near_root(dyn, scratch, contacts, stepping, k, first, reach):
    """Return the root (s) within ``reach`` of ``first`` by secants; a time beyond where they leave it."""
    h = contacts.clock[arrays.LENGTH]
    part = (first - contacts.clock[arrays.START]) / h
    beside = 1e-4
    rise = on_quintic(dyn, scratch, contacts, k, part + beside) - on_quintic(dyn, scratch, contacts, k, part - beside)
    slope = rise / (2.0 * beside * h)
    t = first
    f = of_motion(dyn, scratch, contacts, stepping, k, t)
    least = 1e-15 + 8.9e-16 * abs(t)
    for _ in range(6):
        if not slope < 0.0:
            break
        ahead = -f / slope
        if abs(ahead) <= least:
            return t
        following = t + ahead
        if not abs(following - first) <= reach:
            break
        value = of_motion(dyn, scratch, contacts, stepping, k, following)
        if abs(ahead) > 1e3 * least:
            slope = (value - f) / ahead
        t = following
        f = value
    return first + 2.0 * reach


@apart
def event_time(dyn, scratch, contacts, stepping, k):
    """Return the time (s) of the event of row k along the motion itself, as exactly as that is known."""
    start = contacts.clock[arrays.START]
    first = start + contacts.clock[arrays.LENGTH] * contacts.clock[arrays.WHERE]
    if not first > start:
        return start
    high = beyond_time(contacts)
    reach = min(1e-3 * (high - start), 0.5 * (first - start))
    near = _near_root(dyn, scratch, contacts, stepping, k, first, reach)
    if near <= first + reach:
        return near
    low = start
    at_low = of_motion(dyn, scratch, contacts, stepping, k, first - reach)
    if at_low > 0.0:
        low = first - reach
    at_high = of_motion(dyn, scratch, contacts, stepping, k, first + reach)
    if first + reach < high and at_high < 0.0:
        high = first + reach
    else:
        at_high = of_motion(dyn, scratch, contacts, stepping, k, high)
    if low == start:
        at_low = of_motion(dyn, scratch, contacts, stepping, k, low)
    if not at_low > 0.0 or not at_high < 0.0:
        return first  # it left zero at the start of the step: the quintic's root stands
    return _true_root(dyn, scratch, contacts, stepping, k, low, at_low, high, at_high)


@apart
def _true_root(dyn, scratch, contacts, stepping, k, low, at_low, high, at_high):
    """Return the root (s) between two times."""
    a = high
    fa = at_high
    b = low
    fb = at_low
    c = a
    fc = fa
    part = 0.5
    least = 1e-15 + 8.9e-16 * abs(high)
    for _ in range(MOST_ROOTS):
        edge = 0.5 * least / abs(b - a)
        if edge > 0.5:
            break
        part = min(max(part, edge), 1.0 - edge)
        x = a + part * (b - a)
        f = of_motion(dyn, scratch, contacts, stepping, k, x)
        a, fa, b, fb, c, fc = narrowed(a, fa, b, fb, x, f)
        if f == 0.0:
            break
        part = next_part(a, fa, b, fb, c, fc)
    return a if abs(fa) <= abs(fb) else b
