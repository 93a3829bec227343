"""Guards of joints that stick.

slides    its speed, sign kept
sticks    its limit less |T|; where what is at rest shares its forces  1 - s  of all of it, times the largest load
"""

from __future__ import annotations

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.arrays import (
    APART,
    CLOSED,
    FOUND,
    FRICTION,
    KIND,
    LOAD,
    ROW,
    SHARING,
    SIGN,
    SLIDE,
    TOGETHER,
    VALUE,
    WAY,
)
from mbsd.dynamics.events.friction import holds
from mbsd.dynamics.events.laws.least_part import PULLED
from mbsd.dynamics.events.rows import gaps_of
from mbsd.dynamics.events.sticking.sharing import carry, limit_of
from mbsd.dynamics.events.sticking.together import carry_together
from mbsd.dynamics.formulation import along, measure
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import normal_forces

ROUNDING = 1e-10
"""Rounding of forces, as part of the largest."""


@internal
def _share(dyn, scratch, contacts, v, lam, asked):
    """Divide lam (m,) at the pose of scratch.ws; returns s, if it is ``asked`` for at velocities v (3 nb,)."""
    if contacts.clock[SHARING] == TOGETHER:
        return carry_together(dyn, scratch, contacts, v, lam, asked)
    return carry(dyn, scratch, contacts, v, lam, asked)


@lazy(None)
def read_ways(dyn, scratch, contacts, y, forces):
    """Fill vector[VALUE] of ways at a state y (2, 3 nb) at which contacts.lam are the multipliers, if ``forces``."""
    normal = contacts.sticks.normal[FOUND]
    resting = -1
    sharing = contacts.clock[SHARING]
    if forces:
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, contacts.lam, normal)
    for k in range(contacts.place.shape[0]):
        if contacts.place[k, KIND] == SLIDE and sharing == TOGETHER and contacts.number[k, CLOSED] > 0.0:
            contacts.vector[VALUE, k] = contacts.clock[LOAD]
        if contacts.place[k, KIND] != WAY:
            continue
        row = contacts.place[k, ROW]
        if not holds(dyn, contacts, k):
            contacts.vector[VALUE, k] = contacts.clock[LOAD]
            continue
        if contacts.number[k, CLOSED] == 0.0:
            contacts.vector[VALUE, k] = contacts.number[k, SIGN] * along(dyn, scratch, row, y[1])
            continue
        contacts.vector[VALUE, k] = contacts.clock[LOAD]
        if forces and sharing == APART:
            limit = limit_of(dyn, contacts.place[k, FRICTION], normal)
            contacts.vector[VALUE, k] = limit - abs(contacts.lam[row])
        if resting < 0:
            resting = k
    if forces and sharing != APART:
        part = _share(dyn, scratch, contacts, y[1], contacts.lam, True)
        for k in range(contacts.place.shape[0]):
            if resting < 0 and contacts.place[k, KIND] == SLIDE and contacts.number[k, CLOSED] > 0.0:
                resting = k
            if k < gaps_of(contacts) and contacts.number[k, CLOSED] > 0.0:
                push = -contacts.lam[contacts.place[k, ROW]]
                pulls = part == PULLED and push < ROUNDING * contacts.clock[LOAD]
                contacts.vector[VALUE, k] = -contacts.clock[LOAD] if pulls else push
        contacts.vector[VALUE, resting] = (1.0 - min(part, 2.0)) * contacts.clock[LOAD]


@lazy(None)
def share_outputs(dyn, scratch, contacts, out, first, end):
    """Divide the friction of joints at rest in outputs ``first`` to ``end`` (left out)."""
    for k in range(first, end):
        measure(dyn, scratch, out.t[k], out.y[k, 0])
        _share(dyn, scratch, contacts, out.y[k, 1], out.lam[k], False)


@internal
def share_here(dyn, scratch, contacts, state):
    """Put the multipliers of a state whose derivative is valid in contacts.lam, divided among what is at rest."""
    for r in range(state.lam.shape[0]):
        contacts.lam[r] = state.lam[r]
    if contacts.clock[SHARING] != APART:
        share_state(dyn, scratch, contacts, state)


@lazy(None)
def share_state(dyn, scratch, contacts, state):
    """Divide contacts.lam, the multipliers of a state."""
    measure(dyn, scratch, state.clock[TIME], state.y[0])
    _share(dyn, scratch, contacts, state.y[1], contacts.lam, False)
