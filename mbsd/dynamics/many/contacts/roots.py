"""Where in a step what is looked at falls through zero, on the step's quintic; k: a row of Contacts, or an event."""

from __future__ import annotations

from mbsd.compiling.jit import apart
from mbsd.dynamics.events.bounds import HALVINGS
from mbsd.dynamics.integrators.root_search import narrowed, next_part
from mbsd.dynamics.many.contacts.dips import first_dip
from mbsd.dynamics.many.contacts.within import on_quintic

CLOSE = 1e-14
MOST_ROOTS = 80
SAMPLES = 6


@apart
def quintic_root(dyn, scratch, contacts, k, level, left, right, at_left, at_right):
    """Part of the step between ``left`` and ``right`` where the quintic of row k passes ``level``."""
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
    """Between two parts of the step, and a part where it is negative; the first counts as zero up to ``zero``."""
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
    dyn, scratch, settings, contacts, out, before, after, k, x, values, count, still, where, negative
):  # fmt: skip
    """Where it first falls through zero, and a part where it is negative: in a dip, or else as given; -1, -1: never.

    ``values`` stand at the first ``count`` of the parts ``x``; ``where`` is where these show a fall.
    """
    if where >= 0.0:
        known = 0
        while known < count and x[known] <= where:
            known += 1
        count = known
    above, below = first_dip(dyn, scratch, settings, contacts, out, before, after, k, x, values, count, still)
    if below >= 0.0:
        high = on_quintic(dyn, scratch, contacts, k, above)
        low = on_quintic(dyn, scratch, contacts, k, below)
        where = 0.5 * (above + below)
        negative = below
        if high > 0.0 > low:
            where = quintic_root(dyn, scratch, contacts, k, 0.0, above, below, high, low)
    return where, negative
