"""Which event of the user is the first to pass zero in a step."""

from __future__ import annotations

from mbsd.compiling.jit import apart, lazy
from mbsd.dynamics.many.contacts.arrays import BEYOND, WHERE
from mbsd.dynamics.many.contacts.events.resolution import look
from mbsd.dynamics.many.contacts.roots import dips_before, root_between
from mbsd.dynamics.many.events.arrays import SIDE
from mbsd.dynamics.many.events.sides import rounding_of
from mbsd.dynamics.state import TIME


@apart
def _met_of(dyn, scratch, settings, contacts, out, before, after, e, until):
    """Where event e first passes zero, and a part where it is beyond; -1, -1 where it does not."""
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
    return dips_before(dyn, scratch, settings, contacts, out, before, after, k, x, values, count, 0.0, where, negative)


@lazy(int)
def first_event(dyn, scratch, settings, contacts, out, before, after, best):
    """The number of what is met first: ``best`` with WHERE and BEYOND of the clock, -1 for none, or an event."""
    for e in range(contacts.events.table.shape[0]):
        if contacts.events.skipped[e] != 0 or contacts.events.number[e, SIDE] == 0.0:  # it has stayed zero
            continue
        until = 2.0 if best < 0 else contacts.clock[BEYOND]
        where, negative = _met_of(dyn, scratch, settings, contacts, out, before, after, e, until)
        if where >= 0.0 and (best < 0 or where < contacts.clock[WHERE]):
            best = contacts.place.shape[0] + e
            contacts.clock[WHERE] = where
            contacts.clock[BEYOND] = negative
    return best
