"""What is monitored of joints that stick, as events/monitors.py has it.

slides    its speed, sign kept
sticks    its limit less |T|; where joints share their friction  1 - s  of all of them, times the largest load
"""

from __future__ import annotations

from mbsd.compiling.jit import lazy
from mbsd.dynamics.many.contacts.arrays import (
    CLOSED,
    FOUND,
    FRICTION,
    KIND,
    LOAD,
    ROW,
    SHARING,
    SIGN,
    VALUE,
    WAY,
)
from mbsd.dynamics.many.contacts.rows import along
from mbsd.dynamics.many.contacts.sticking.sharing import carry, limit_of
from mbsd.dynamics.many.rows_at import measure
from mbsd.equations.joint_friction import normal_forces


@lazy(None)
def read_ways(dyn, scratch, contacts, y, forces):
    """Fill vector[VALUE] of ways at a state y (2, 3 nb) at which contacts.lam are the multipliers, if ``forces``."""
    normal = contacts.sticks.normal[FOUND]
    resting = -1
    if forces:
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, contacts.lam, normal)
    for k in range(contacts.place.shape[0]):
        if contacts.place[k, KIND] != WAY:
            continue
        row = contacts.place[k, ROW]
        if contacts.number[k, CLOSED] == 0.0:
            contacts.vector[VALUE, k] = contacts.number[k, SIGN] * along(dyn, scratch, row, y[1])
            continue
        contacts.vector[VALUE, k] = contacts.clock[LOAD]
        if forces and contacts.clock[SHARING] == 0.0:
            limit = limit_of(dyn, contacts.place[k, FRICTION], normal)
            contacts.vector[VALUE, k] = limit - abs(contacts.lam[row])
        if resting < 0:
            resting = k
    if resting >= 0 and forces and contacts.clock[SHARING] > 0.0:
        part = carry(dyn, scratch, contacts, contacts.lam)
        contacts.vector[VALUE, resting] = (1.0 - part) * contacts.clock[LOAD]


@lazy(None)
def share_outputs(dyn, scratch, contacts, out, first, end):
    """Divide the friction of joints at rest in outputs ``first`` to ``end`` (left out)."""
    for k in range(first, end):
        measure(dyn, scratch, out.t[k], out.y[k, 0])
        carry(dyn, scratch, contacts, out.lam[k])
