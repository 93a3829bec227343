"""Ways at rest at an event: of contacts and of joints that stick alike."""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import ALONE, BROKEN, FRICTION, RATE, RELEASED, REST, RESTING, STAYING
from mbsd.dynamics.events.pushes import STIFF
from mbsd.dynamics.events.rows import find_rates, gaps_of, keep_independent, stop
from mbsd.equations.joint_friction import STATIC


@internal
def gives(contacts, k):
    """Return True if a force along way k moves anything: not at a turning point, nor where drivers alone move it."""
    return contacts.compliance[k, k] > STIFF * contacts.vector[ALONE, k]


@internal
def holds(dyn, contacts, k):
    """Return True if friction can hold way k: not of a released joint, nor with a coefficient of zero."""
    at = contacts.place[k, FRICTION]
    if contacts.number[k, RELEASED] != 0.0:
        return False
    return at < 0 or dyn.loads.friction_number[at, STATIC] > 0.0


@internal
def _halts(contacts, k, gaps, halted):
    """Return True if way k has just come to rest."""
    w = k - gaps
    return contacts.friction.number[w, BROKEN] == 0.0 if w < contacts.friction.gap.shape[0] else k == halted


@internal
def _more_rest(dyn, contacts, gaps, halted):
    """Add ways to chosen[RESTING] by vector[RATE]; whether there were more."""
    friction = contacts.friction
    resting = contacts.chosen[RESTING]
    more = False
    for k in range(gaps, resting.shape[0]):
        w = k - gaps
        if resting[k] != 0 or (w < friction.gap.shape[0] and contacts.chosen[STAYING, friction.gap[w]] == 0):
            continue
        if not holds(dyn, contacts, k):
            continue
        slow = abs(contacts.vector[RATE, k]) <= contacts.number[k, REST]
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
        contacts.chosen[RESTING, k] = 0
    find_rates(dyn, scratch, contacts, v)
    while _more_rest(dyn, contacts, gaps, halted):
        for c in range(v.shape[0]):
            own[c] = v[c]
        keep_independent(contacts, contacts.chosen[RESTING])
        stop(dyn, scratch, contacts, own)
        find_rates(dyn, scratch, contacts, own)
    for k in range(gaps, contacts.place.shape[0]):
        if _halts(contacts, k, gaps, halted):
            contacts.vector[RATE, k] = 0.0
