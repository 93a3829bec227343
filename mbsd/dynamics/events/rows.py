"""Rows of J that events switch, at a pose: their rates, what impulses along them change, and which of them hold."""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events import arrays
from mbsd.dynamics.formulation import along, measure_gaps, push, respond
from mbsd.equations.system import ZERO

STIFF = 1e-12
"""Compliance of a row, as part of that of its bodies alone, below which nothing gives way."""
DEPENDENT = 1e-9
"""Part of its compliance that the rows before must leave of a row."""


@apart
def read_gaps(dyn, scratch, t, q):
    """Call ``measure_gaps``, which its callers otherwise contain."""
    measure_gaps(dyn, scratch, t, q)


@internal
def gaps_of(contacts):
    """Return the number of gaps, the first rows of Contacts; behind them are ways of contacts, then of joints."""
    return contacts.place.shape[0] - contacts.friction.gap.shape[0] - contacts.sticks.joint.shape[0]


@internal
def hold_rows(dyn, contacts):
    """Let the rows hold that should, and contacts slide as they do."""
    for k in range(contacts.place.shape[0]):
        held = contacts.number[k, arrays.HELD] > 0.0
        dyn.schur.rows[contacts.place[k, arrays.BLOCK], contacts.place[k, arrays.SIDE]] = (
            contacts.place[k, arrays.ROW] if held else -1
        )
    gaps = gaps_of(contacts)
    for w in range(contacts.friction.gap.shape[0]):
        dyn.sliding.table[w, 0] = contacts.friction.number[w, arrays.KINETIC] * contacts.number[gaps + w, arrays.SIGN]


@internal
def release_rows(dyn, contacts):
    """Let none of them hold, and no contact have friction."""
    for k in range(contacts.place.shape[0]):
        dyn.schur.rows[contacts.place[k, arrays.BLOCK], contacts.place[k, arrays.SIDE]] = -1
    for w in range(dyn.sliding.table.shape[0]):
        dyn.sliding.table[w, 0] = 0.0


@internal
def move_zero(scratch, contacts, k):
    """Count the way of row k from the pose of scratch.ws.phi."""
    scratch.ws.relative[contacts.place[k, arrays.RELATIVE], ZERO] += scratch.ws.phi[contacts.place[k, arrays.ROW]]


@internal
def find_rates(dyn, scratch, contacts, v):
    """Fill vector[RATE] at velocities v (3 nb,)."""
    for k in range(contacts.place.shape[0]):
        contacts.vector[arrays.RATE, k] = along(dyn, scratch, contacts.place[k, arrays.ROW], v)


@apart
def find_answer(dyn, scratch, contacts, k, lam):
    """Fill answer[k], the change of velocities by a unit impulse of row k, and vector[ALONE] without joints.

    lam (m,) takes the multipliers. Factors and scratch.ws.jac are those of the pose, with all contacts released.
    """
    n3 = dyn.inverse.shape[0]
    force = contacts.force
    row = contacts.place[k, arrays.ROW]
    for c in range(n3):
        force[c] = 0.0
    push(dyn, scratch, row, 1.0, force)
    alone = 0.0
    for c in range(3, n3):
        alone += dyn.inverse[c] * force[c] ** 2
    contacts.vector[arrays.ALONE, k] = alone if alone > 0.0 else 1.0
    respond(dyn, scratch, force, 0.0, contacts.answer[k], lam)


@internal
def find_answers(dyn, scratch, contacts, flags):
    """Fill answer, compliance and vector[ALONE] of the rows in ``flags`` (c,), and borne where joints have friction."""
    keeps = contacts.sticks.borne.shape[0] > 0
    for k in range(contacts.place.shape[0]):
        if flags[k] != 0:
            find_answer(dyn, scratch, contacts, k, contacts.sticks.borne[k] if keeps else scratch.multipliers)
    read_compliance(dyn, scratch, contacts, flags)


@internal
def read_compliance(dyn, scratch, contacts, flags):
    """Fill compliance of the rows in ``flags`` (c,), whose answers are there."""
    count = contacts.place.shape[0]
    for k in range(count):
        for j in range(count):
            if flags[k] != 0 and flags[j] != 0:
                row = contacts.place[j, arrays.ROW]
                contacts.compliance[j, k] = along(dyn, scratch, row, contacts.answer[k])


@internal
def give(contacts, v, pushes):
    """Change velocities v (3 nb,) by impulses (c,) along the rows in chosen[TAKING]."""
    for k in range(contacts.place.shape[0]):
        if contacts.chosen[arrays.TAKING, k] != 0 and pushes[k] != 0.0:
            for c in range(3, v.shape[0]):
                v[c] += contacts.answer[k, c] * pushes[k]


@apart
def keep_independent(contacts, flags):
    """Fill chosen[KEPT] with the rows in ``flags`` (c,) that do not follow from earlier ones, and their factor."""
    count = contacts.place.shape[0]
    kept = contacts.chosen[arrays.KEPT]
    factor = contacts.factor
    for k in range(count):
        kept[k] = 0
        own = contacts.compliance[k, k]
        if flags[k] == 0 or not own > 0.0:
            continue
        left = own
        for j in range(k):
            if kept[j] == 0:
                continue
            value = contacts.compliance[k, j]
            for i in range(j):
                if kept[i] != 0:
                    value -= factor[k, i] * factor[j, i]
            factor[k, j] = value / factor[j, j]
            left -= factor[k, j] ** 2
        if left > DEPENDENT * own:
            kept[k] = 1
            factor[k, k] = math.sqrt(left)


@apart
def stop(dyn, scratch, contacts, v):
    """Take the rates of the rows in chosen[KEPT] off velocities v (3 nb,) by impulses along them."""
    count = contacts.place.shape[0]
    kept = contacts.chosen[arrays.KEPT]
    factor = contacts.factor
    push = contacts.vector[arrays.SHIFT]
    find_rates(dyn, scratch, contacts, v)
    for k in range(count):
        push[k] = 0.0
        if kept[k] != 0:
            push[k] = -contacts.vector[arrays.RATE, k]
            for j in range(k):
                if kept[j] != 0:
                    push[k] -= factor[k, j] * push[j]
            push[k] /= factor[k, k]
    for k in range(count - 1, -1, -1):
        if kept[k] != 0:
            for j in range(k + 1, count):
                if kept[j] != 0:
                    push[k] -= factor[j, k] * push[j]
            push[k] /= factor[k, k]
            for c in range(3, v.shape[0]):
                v[c] += contacts.answer[k, c] * push[k]


@internal
def any_held(contacts):
    """Return True if a contact is closed, or a joint sticks."""
    held = False
    for k in range(contacts.place.shape[0]):
        held = held or contacts.number[k, arrays.CLOSED] > 0.0
    return held
