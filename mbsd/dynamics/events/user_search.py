"""At how many parts of a step a function of the user is looked at.

As often as ``shortest`` asks for; else one more value tells whether the polynomial through the first ones knows the
function. If not, intervals whose middle is not what the neighbours let expect are halved. What comes after the first
negative value is not looked at.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.events.arrays import BEYOND, LENGTH, PARTS, WHERE
from mbsd.dynamics.events.guards import on_quintic
from mbsd.dynamics.events.roots import dips_before, root_between
from mbsd.dynamics.events.users import SHORTEST, SIDE, UNKNOWN, rounding_of
from mbsd.dynamics.state import TIME

TRIED = np.array([0.1337, 0.5437])
"""Parts of a step at which the polynomial through a function of the user is tried; no simple fractions, which a period
might share."""
ROUGH, ROUGH_HALVES = 0.01, 0.05
"""Fractions of what the function changes by in a step: what is missed by more is not known; at first, and in halves."""
PER_SHORTEST = 2.0
"""Looks at the shortest thing in a function."""
FAR = 10.0
"""Times what a function changes by in a step: from there it does not come to zero, and changes may be rounding."""
NARROWEST = 1.0 / 2048
MOST_VALUES = 512
"""Values in one step."""

SAMPLES = 6


@internal
def _expected(x, values, begin, end, at):
    """Return the polynomial through values [begin, end) at x, at another position."""
    out = 0.0
    for k in range(begin, end):
        above = 1.0
        below = 1.0
        for j in range(begin, end):
            if j != k:
                above *= at - x[j]
                below *= x[k] - x[j]
        out += above / below * values[k]
    return out


@internal
def _until_negative(values, count):
    """Return how many values there are up to the first negative one behind the first."""
    for k in range(1, count):
        if values[k] < 0.0:
            return k + 1
    return count


@internal
def _put_between(x, values, count, at, value):
    """Put one more into the first ``count``."""
    k = count
    while k > 0 and x[k - 1] > at:
        x[k] = x[k - 1]
        values[k] = values[k - 1]
        k -= 1
    x[k] = at
    values[k] = value


@internal
def _by_shortest(dyn, scratch, contacts, e, k):
    """Look as often as ``shortest`` asks for, up to the first negative value; returns how many values there are."""
    events = contacts.events
    x = events.parts
    values = events.values
    count = _until_negative(values, SAMPLES)
    looks = math.ceil(PER_SHORTEST * contacts.clock[LENGTH] / events.number[e, SHORTEST])
    looks = min(looks, x.shape[0] - SAMPLES)
    if looks < SAMPLES:
        return count
    width = 1.0 / looks
    for i in range(1, looks):
        at = i * width
        known = False
        for part in PARTS:
            known = known or part == at
        if known:
            continue
        if at >= x[count - 1]:
            break
        value = on_quintic(dyn, scratch, contacts, k, at)
        _put_between(x, values, count, at, value)
        count += 1
        if value < 0.0:
            break
    return _until_negative(values, count)


@internal
def _find_middles(dyn, scratch, contacts, k, count):
    """Find values in the middle of rough intervals, and whether neighbours let expect another: rough[1]."""
    events = contacts.events
    x = events.parts
    values = events.values
    low = values[0]
    high = values[0]
    for i in range(1, count):
        low = min(low, values[i])
        high = max(high, values[i])
    for i in range(count - 1):
        if events.rough[0, i] != 0:
            at = 0.5 * (x[i] + x[i + 1])
            value = on_quintic(dyn, scratch, contacts, k, at)
            begin = min(max(i - 1, 0), count - 4)
            end = begin + 4
            begin = begin if begin >= 0 else count + begin
            events.there[0, i] = value
            events.there[1, i] = abs(value - _expected(x, values, begin, min(end, count), at))
            low = min(low, value)
            high = max(high, value)
    least = ROUGH_HALVES * (high - low)
    last = -1
    for i in range(count - 1):
        events.rough[1, i] = 0
    for i in range(count - 1):  # one that agrees may do so by chance: its neighbours are looked at again, too
        if events.rough[0, i] == 0:
            continue
        if events.there[1, i] > least:
            events.rough[1, i] = 1
            if last >= 0:
                events.rough[1, last] = 1
        elif last >= 0 and events.there[1, last] > least:
            events.rough[1, i] = 1
        last = i
    for i in range(count - 1):
        if not x[i + 1] - x[i] > NARROWEST:
            events.rough[1, i] = 0


@internal
def _merge(events, count):
    """Put the middles between the values; returns how many there are, up to the first negative one."""
    x = events.parts
    values = events.values
    n = 0
    for i in range(count):
        events.more[0, n] = x[i]
        events.more[1, n] = values[i]
        n += 1
        if i + 1 < count and events.rough[0, i] != 0:
            events.more[0, n] = 0.5 * (x[i] + x[i + 1])
            events.more[1, n] = events.there[0, i]
            n += 1
    at = 0
    for i in range(count - 1):
        wide = events.rough[0, i] != 0
        still = events.rough[1, i] if wide else 0
        events.there[1, at] = still
        at += 1
        if wide:
            events.there[1, at] = still
            at += 1
    for i in range(n):
        x[i] = events.more[0, i]
        values[i] = events.more[1, i]
        if i < n - 1:
            events.rough[0, i] = 1 if events.there[1, i] != 0.0 else 0
    return _until_negative(values, n)


@apart
def look(dyn, scratch, contacts, e):
    """Fill parts of the step and values there, with its side's sign, that show how event e goes; how many they are."""
    events = contacts.events
    x = events.parts
    values = events.values
    k = contacts.place.shape[0] + e
    least = math.inf
    most = -math.inf
    for i in range(SAMPLES):
        x[i] = PARTS[i]
        values[i] = on_quintic(dyn, scratch, contacts, k, PARTS[i])
        least = min(least, values[i])
        most = max(most, values[i])
    if events.number[e, SHORTEST] > 0.0:
        return _by_shortest(dyn, scratch, contacts, e, k)
    missed = 0.0
    for i in range(TRIED.shape[0]):
        value = on_quintic(dyn, scratch, contacts, k, TRIED[i])
        events.there[0, i] = value
        missed = max(missed, abs(value - _expected(x, values, 0, SAMPLES, TRIED[i])))
        least = min(least, value)
        most = max(most, value)
    if least > FAR * (most - least) or not missed > ROUGH * (most - least):
        return SAMPLES
    count = SAMPLES
    for i in range(TRIED.shape[0]):
        _put_between(x, values, count, TRIED[i], events.there[0, i])
        count += 1
    count = _until_negative(values, count)
    waiting = count - 1
    for i in range(count):
        events.rough[0, i] = 1
    while waiting > 0 and count + waiting <= MOST_VALUES:
        _find_middles(dyn, scratch, contacts, k, count)
        count = _merge(events, count)
        waiting = 0
        for i in range(count - 1):
            waiting += events.rough[0, i]
    if waiting > 0:
        events.number[e, UNKNOWN] = count
    return count


@apart
def _met_of(dyn, scratch, contacts, stepping, e, until):
    """Return where event e first passes zero, and a part beyond; -1, -1 where it does not."""
    events = contacts.events
    k = contacts.place.shape[0] + e
    count = look(dyn, scratch, contacts, e)
    x = events.parts
    values = events.values
    first = 0
    while first < count - 1 and not values[first + 1] < 0.0:
        first += 1
    where = -1.0
    negative = -1.0
    if first < count - 1 and x[first] < until:
        zero = 0.0
        if first == 0 and values[0] > 0.0:  # it may have begun here: a root beside it is none
            zero = rounding_of(events, e, contacts.before.clock[TIME], contacts.before.y, 1.0)
        where, negative = root_between(
            dyn, scratch, contacts, k, x[first], x[first + 1], values[first], values[first + 1], 0.0, zero
        )
    return dips_before(dyn, scratch, contacts, stepping, k, x, values, count, 0.0, where, negative)


@lazy(int)
def first_event(dyn, scratch, contacts, stepping, best):
    """Return the row that is met first: ``best`` with WHERE and BEYOND of the clock, -1 for none, or an event."""
    for e in range(contacts.events.table.shape[0]):
        if contacts.events.skipped[e] != 0 or contacts.events.number[e, SIDE] == 0.0:  # it has stayed zero
            continue
        until = 2.0 if best < 0 else contacts.clock[BEYOND]
        where, negative = _met_of(dyn, scratch, contacts, stepping, e, until)
        if where >= 0.0 and (best < 0 or where < contacts.clock[WHERE]):
            best = contacts.place.shape[0] + e
            contacts.clock[WHERE] = where
            contacts.clock[BEYOND] = negative
    return best
