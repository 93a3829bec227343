"""Guards: scalars whose zeros within a step are events, on the step's quintic and along the motion itself.

    open contact    its gap (of a clutch its rate)      closed contact    its normal force N, or room (outlines.py)
    it slides       its speed, sign kept                it sticks         mu_s N - |T|
    user's event    its value, sign kept

Each is that of a row of Contacts: of a gap, or of a way; those of joints: sticking/together.py. Scalars are not
negative now, and mean an event where they fall through zero.

    q(x) = q_0 + h q_0' x + h^2 q_0'' x^2 / 2 + ... x^5        x = (t - t_0) / h

The quintic has q, q' and q'' of both ends of the step; the motion itself is found by going on
from the start of the step.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal, merged
from mbsd.dynamics.events import arrays
from mbsd.dynamics.events.following import advance_to
from mbsd.dynamics.events.outlines import end_at_corners
from mbsd.dynamics.events.rows import any_held, gaps_of, read_gaps
from mbsd.dynamics.events.sticking.together import read_ways
from mbsd.dynamics.events.users import signed
from mbsd.dynamics.formulation import along, bends, derivative, measure_gaps, speeds, without_contacts
from mbsd.dynamics.integrators.advance import NO_LIMIT, copy_state
from mbsd.dynamics.state import NEXT, REACHED, TIME


@internal
def fit(dyn, contacts, state):
    """Find the quintic from contacts.before to ``state``, whose derivatives are valid."""
    before = contacts.before
    bends(dyn, before.y, before.dy, contacts.rates[0])
    bends(dyn, state.y, state.dy, contacts.rates[1])
    start = before.clock[TIME]
    h = state.clock[TIME] - start
    contacts.clock[arrays.START] = start
    contacts.clock[arrays.LENGTH] = h
    for c in range(state.y.shape[1]):
        q0 = before.y[0, c]
        v0 = h * before.dy[0, c]
        a0 = h * h * contacts.rates[0, c]
        rise = state.y[0, c] - q0 - v0 - a0 / 2
        slope = h * state.dy[0, c] - v0 - a0
        bend = h * h * contacts.rates[1, c] - a0
        contacts.quintic[0, c] = q0
        contacts.quintic[1, c] = v0
        contacts.quintic[2, c] = a0 / 2
        contacts.quintic[3, c] = 10 * rise - 4 * slope + bend / 2
        contacts.quintic[4, c] = -15 * rise + 7 * slope - bend
        contacts.quintic[5, c] = 6 * rise - 3 * slope + bend / 2


@internal
def stand_at(dyn, contacts, x):
    """Fill contacts.pose at the part x of the step; returns the time (s)."""
    k = contacts.quintic
    h = contacts.clock[arrays.LENGTH]
    for c in range(k.shape[1]):
        contacts.pose[0, c] = k[0, c] + x * (k[1, c] + x * (k[2, c] + x * (k[3, c] + x * (k[4, c] + x * k[5, c]))))
        rate = k[1, c] + x * (2 * k[2, c] + x * (3 * k[3, c] + x * (4 * k[4, c] + x * 5 * k[5, c])))
        contacts.pose[1, c] = rate / h
    speeds(dyn, contacts.pose[0], contacts.pose[1])
    return contacts.clock[arrays.START] + h * x


@merged
def _values(dyn, scratch, contacts, y, forces):
    """Fill vector[VALUE] at a state y (2, 3 nb) that was measured; what depends on forces only with ``forces``."""
    friction = contacts.friction
    count = gaps_of(contacts)
    for k in range(count):
        row = contacts.place[k, arrays.ROW]
        if contacts.number[k, arrays.CLOSED] > 0.0:
            contacts.vector[arrays.VALUE, k] = -contacts.lam[row]
        elif contacts.place[k, arrays.KIND] == arrays.CLUTCH:
            contacts.vector[arrays.VALUE, k] = along(dyn, scratch, row, y[1])
        else:
            contacts.vector[arrays.VALUE, k] = scratch.ws.phi[row]
    end_at_corners(dyn, scratch, contacts)
    for w in range(friction.gap.shape[0]):
        row = contacts.place[count + w, arrays.ROW]
        if contacts.number[count + w, arrays.CLOSED] > 0.0:
            normal = -contacts.lam[contacts.place[friction.gap[w], arrays.ROW]]
            contacts.vector[arrays.VALUE, count + w] = friction.number[w, arrays.STATIC] * normal - abs(
                contacts.lam[row]
            )
        else:
            contacts.vector[arrays.VALUE, count + w] = contacts.number[count + w, arrays.SIGN] * along(
                dyn, scratch, row, y[1]
            )
    if contacts.clock[arrays.DIVIDES] > 0.0 or contacts.clock[arrays.SHARING] != arrays.APART:
        read_ways(dyn, scratch, contacts, y, forces)


@internal
def read(dyn, scratch, contacts, t, y, forces):
    """Fill vector[VALUE] at a state y (2, 3 nb); what depends on forces only with ``forces``."""
    if forces:
        derivative(dyn, scratch, t, y, contacts.rates, contacts.lam)
    else:
        read_gaps(dyn, scratch, t, y[0])
    _values(dyn, scratch, contacts, y, forces)


@merged
def sample(dyn, scratch, contacts):
    """Fill contacts.samples."""
    forces = False
    for k in range(contacts.place.shape[0]):
        forces = forces or contacts.number[k, arrays.CLOSED] > 0.0
    for i in range(arrays.PARTS.shape[0]):
        t = stand_at(dyn, contacts, arrays.PARTS[i])
        if forces:
            derivative(dyn, scratch, t, contacts.pose, contacts.rates, contacts.lam)
        else:
            measure_gaps(dyn, scratch, t, contacts.pose[0])
        _values(dyn, scratch, contacts, contacts.pose, forces)
        for k in range(contacts.place.shape[0]):
            contacts.samples[k, i] = contacts.vector[arrays.VALUE, k]


@internal
def _value(dyn, scratch, contacts, t, y, k):
    """Return the guard of row k at a state y (2, 3 nb); behind the last row are events of the user."""
    if k >= contacts.place.shape[0]:
        return signed(contacts.events, k - contacts.place.shape[0], t, y)
    read(dyn, scratch, contacts, t, y, contacts.number[k, arrays.CLOSED] > 0.0)
    return contacts.vector[arrays.VALUE, k]


@apart
def on_quintic(dyn, scratch, contacts, k, x):
    """Return the guard of row k at the part x of the step, on the quintic."""
    t = stand_at(dyn, contacts, x)
    return _value(dyn, scratch, contacts, t, contacts.pose, k)


@internal
def at_state(dyn, scratch, contacts, state, k):
    """Return the guard of row k at a state."""
    return _value(dyn, scratch, contacts, state.clock[TIME], state.y, k)


@apart
def of_motion(dyn, scratch, contacts, stepping, k, t):
    """Return the guard of row k along the motion itself at a time (s) within the step; NaN where it gets nowhere."""
    trial = contacts.trial
    copy_state(trial, contacts.before)
    if t > trial.clock[TIME]:
        trial.count[NEXT] = stepping.out.t.shape[0]
        own = dyn if any_held(contacts) else without_contacts(dyn, contacts)
        contacts.clock[arrays.TRYING] = 1.0
        status = advance_to(own, scratch, trial, contacts, stepping, t, NO_LIMIT)
        contacts.clock[arrays.TRYING] = 0.0
        if status != REACHED:
            contacts.clock[arrays.FAILURE] = status
            return math.nan
    return at_state(dyn, scratch, contacts, trial, k)


@internal
def beyond_time(contacts):
    """Return the time (s) at which the guard that was met is beyond zero."""
    return contacts.clock[arrays.START] + contacts.clock[arrays.LENGTH] * contacts.clock[arrays.BEYOND]
