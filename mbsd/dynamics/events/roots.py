"""Zeros of guards on the quintic of a step: roots between samples, and dips.

k: a row of Contacts, or an event behind the last one.

Where a scalar is convex it lies above the lines through the samples on both sides of an interval. So it can fall below
zero there only where these lines do; where they meet it is looked at next, and each half is judged anew. That closes in
on a minimum of any width, and costs nothing where the scalar stays away from zero.

A distance is no convex scalar: the arms of its V bend inwards where the point moves on an arc. So lines that come near
zero are drawn again from the ends of the interval, where they are steeper.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, inlined, internal
from mbsd.dynamics.events.arrays import LENGTH, MOST_LOOKS, START
from mbsd.dynamics.events.guards import of_motion, on_quintic
from mbsd.dynamics.integrators.root_search import narrowed, next_part

HALVINGS = 40
"""How close to a bounce its return is looked for: this many halvings of a part of a step."""

CLOSE = 1e-14
MOST_ROOTS = 80
SAMPLES = 6


@apart
def quintic_root(dyn, scratch, contacts, k, level, left, right, at_left, at_right):
    """Return the part of the step between ``left`` and ``right`` where the quintic of row k passes ``level``."""
    a = right
    fa = at_right - level
    b = left
    fb = at_left - level
    c = a
    fc = fa
    part = fa / (fa - fb)
    for _ in range(MOST_ROOTS):
        part = min(max(part, 1e-9), 1.0 - 1e-9)
        x = a + part * (b - a)
        f = on_quintic(dyn, scratch, contacts, k, x) - level
        a, fa, b, fb, c, fc = narrowed(a, fa, b, fb, x, f)
        if f == 0.0 or abs(b - a) <= CLOSE:
            break
        part = next_part(a, fa, b, fb, c, fc)
    return a


@apart
def root_between(dyn, scratch, contacts, k, left, right, at_left, at_right, still, zero):
    """Return the root between two parts of the step, and a part beyond it; the first value is zero up to ``zero``."""
    level = min(0.0, max(at_left, -still))
    negative = right
    if at_left <= zero:
        start = left
        positive = -1.0
        for _ in range(HALVINGS):
            middle = 0.5 * (start + right)
            value = on_quintic(dyn, scratch, contacts, k, middle)
            if value - level > 0.0:
                positive = middle
                at_left = value
                break
            right = middle
            at_right = value
        if positive < 0.0:
            return start, negative
        left = positive
    return quintic_root(dyn, scratch, contacts, k, level, left, right, at_left, at_right), negative


@apart
def dips_before(
    dyn, scratch, contacts, stepping, k, x, values, count, still, where, negative
):  # fmt: skip
    """Return the part where a guard first falls through zero, in a dip or as given, and one beyond; -1, -1: never.

    ``values`` stand at the first ``count`` of the parts ``x``; ``where`` is where these show a fall.
    """
    if where >= 0.0:
        known = 0
        while known < count and x[known] <= where:
            known += 1
        count = known
    above, below = first_dip(dyn, scratch, contacts, stepping, k, x, values, count, still)
    if below >= 0.0:
        high = on_quintic(dyn, scratch, contacts, k, above)
        low = on_quintic(dyn, scratch, contacts, k, below)
        where = 0.5 * (above + below)
        negative = below
        if high > 0.0 > low:
            where = quintic_root(dyn, scratch, contacts, k, 0.0, above, below, high, low)
    return where, negative


AT_END = 1e-3
"""Part of an interval within which the slope at the end of a step is taken."""
INSIDE = 0.02
"""The next look is this part of an interval away from its ends."""
NARROWEST = 1e-10
NEAR, SLACK = 0.3, 0.05
"""Fractions of the higher sample: lines of the neighbours, and of the ends, that come down to this are followed."""
UNSURE = 1e-4
"""Part of what the scalar changes by in a step below which the quintic does not tell its sign."""
A, FA, B, FB, FALLS, RISES = range(6)
"""Columns of Contacts.intervals: both ends and the values there, slopes of the lines from the left and the right."""


@internal
def _lowest(piece):
    """Return where the two lines of an interval meet, and their value there."""
    falls = piece[FALLS]
    rises = piece[RISES]
    if falls >= 0.0 or rises <= 0.0:
        return piece[A], piece[FA]
    x = (piece[FB] - piece[FA] + falls * piece[A] - rises * piece[B]) / (falls - rises)
    x = min(max(x, piece[A]), piece[B])
    return x, max(piece[FA] + falls * (x - piece[A]), piece[FB] + rises * (x - piece[B]))


@internal
def _set_piece(piece, a, fa, b, fb, falls, rises):
    piece[A] = a
    piece[FA] = fa
    piece[B] = b
    piece[FB] = fb
    piece[FALLS] = falls
    piece[RISES] = rises


@inlined
def _slopes(x, values, i, count):
    """Return slopes of the lines through the samples on both sides of the i-th interval; 0 where there are none."""
    left = 0.0
    right = 0.0
    if i > 0:
        left = (values[i] - values[i - 1]) / (x[i] - x[i - 1])
    if i + 2 < count:
        right = (values[i + 2] - values[i + 1]) / (x[i + 2] - x[i + 1])
    return left, right


@internal
def may_dip(x, values, i, count, still):
    """Return True if a scalar may fall below -``still`` in the i-th interval, by its first ``count`` values at x."""
    fa = values[i]
    fb = values[i + 1]
    if i == 0 and min(fa, fb) <= still:
        return False  # it has just left zero
    width = x[i + 1] - x[i]
    left, right = _slopes(x, values, i, count)
    if (i > 0 and left >= 0.0) or (i + 2 < count and right <= 0.0):
        return False
    level = -still + NEAR * max(fa + still, fb + still, 0.0)
    if i > 0 and fa + left * width >= level:
        return False
    return not (i + 2 < count and fb - right * width >= level)


@internal
def _interval(dyn, scratch, contacts, k, x, values, i, count):
    """Fill intervals[0] with the i-th."""
    a = x[i]
    b = x[i + 1]
    fa = values[i]
    fb = values[i + 1]
    left, right = _slopes(x, values, i, count)
    near = AT_END * (b - a)
    falls = (on_quintic(dyn, scratch, contacts, k, a + near) - fa) / near
    rises = (fb - on_quintic(dyn, scratch, contacts, k, b - near)) / near
    if i > 0:
        falls = min(falls, left)
    if i + 2 < count:
        rises = max(rises, right)
    _set_piece(contacts.intervals[0], a, fa, b, fb, falls, rises)


@apart
def _searched(dyn, scratch, contacts, stepping, k, level, truly):
    """Return parts above and below ``level`` from intervals[0] on; the second is -1 if there is none below."""
    pieces = contacts.intervals
    waiting = 1
    looks = 0
    while waiting > 0 and looks < MOST_LOOKS:
        waiting -= 1
        piece = pieces[waiting]
        a = piece[A]
        fa = piece[FA]
        b = piece[B]
        fb = piece[FB]
        falls = piece[FALLS]
        rises = piece[RISES]
        x, least = _lowest(piece)
        width = b - a
        if least >= level + SLACK * max(fa - level, fb - level, 0.0) or width < NARROWEST:
            continue
        x = min(max(x, a + INSIDE * width), b - INSIDE * width)
        if truly:
            t = contacts.clock[START] + contacts.clock[LENGTH] * x
            fx = of_motion(dyn, scratch, contacts, stepping, k, t)
        else:
            fx = on_quintic(dyn, scratch, contacts, k, x)
        looks += 1
        if fx < level:
            return a, x
        left = (fx - fa) / (x - a)
        right = (fb - fx) / (b - x)
        _set_piece(pieces[waiting], x, fx, b, fb, max(left, falls), rises)
        _set_piece(pieces[waiting + 1], a, fa, x, fx, falls, min(right, rises))
        waiting += 2
    return 0.0, -1.0


@apart
def first_dip(dyn, scratch, contacts, stepping, k, x, values, count, still):
    """Return parts between which row k first falls below -``still`` among ``count`` values at x; -1: it does not."""
    low = values[0]
    high = low
    for i in range(1, count):
        low = min(low, values[i])
        high = max(high, values[i])
    for i in range(count - 1):
        if not may_dip(x, values, i, count, still):
            continue
        _interval(dyn, scratch, contacts, k, x, values, i, count)
        kept_falls = contacts.intervals[0, FALLS]
        kept_rises = contacts.intervals[0, RISES]
        level = UNSURE * (high - low) - still
        above, below = _searched(dyn, scratch, contacts, stepping, k, level, False)
        if below < 0.0:
            continue
        if on_quintic(dyn, scratch, contacts, k, below) < -still:
            t = contacts.clock[START] + contacts.clock[LENGTH] * below
            if of_motion(dyn, scratch, contacts, stepping, k, t) < -still:
                return above, below
        _set_piece(contacts.intervals[0], x[i], values[i], x[i + 1], values[i + 1], kept_falls, kept_rises)
        above, below = _searched(dyn, scratch, contacts, stepping, k, -still, True)
        if below >= 0.0:
            return above, below
    return 0.0, -1.0
