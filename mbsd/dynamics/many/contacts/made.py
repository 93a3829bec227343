"""Contacts of a prepared run for the compiled loop, or why they do not go there."""

from __future__ import annotations

import numpy as np

from mbsd.dynamics.events.sides import NEAR as CLOSED_GAP
from mbsd.dynamics.events.steps import STILL
from mbsd.dynamics.many.contacts.arrays import FAILURE, HELD, KEPT, MOST_LOOKS, PARTS, SHIFT, Contacts
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.schur import Schur
from mbsd.dynamics.reference.sequence import plan_schur
from mbsd.dynamics.state import State
from mbsd.equations.constraints.relative import ROW as RELATIVE_ROW

MOST = 40
"""Contacts of which all meet all others in small full matrices."""


def why_not(ready: PreparedDynamics) -> str | None:
    """Why events of this mechanism are left to single simulations, or None."""
    contacts = ready.switches.contacts
    if ready.sticks:
        return f"'{ready.sticks[0].name}' sticks by events"
    for contact in contacts:
        if contact.friction:
            return f"'{contact.name}' has friction"
        if contact.always_closed:
            return f"'{contact.name}' locks one way"
    if contacts and len(ready.dynamics.loads.friction):
        return f"'{contacts[0].name}' is beside friction of joints"
    if contacts and ready.approaches:
        return f"'{contacts[0].name}' is beside a contact that remembers how fast it began"
    if len(contacts) > MOST:
        return f"it has {len(contacts)} contacts; {MOST} at most"
    return None


def contacts_of(ready: PreparedDynamics, state: State) -> Contacts:
    """Those of a run at its start; all are open."""
    packed, switches = ready.packed, ready.switches
    scale = packed.row_scale()
    own = switches.contacts
    place = [(contact.gap, *switches.place[contact.gap]) for contact in own]
    number = [
        (
            CLOSED_GAP / scale[contact.gap],
            STILL / scale[contact.gap],
            contact.settle,
            contact.restitution,
            scale[contact.gap],
            0.0,
            0.0,
        )
        for contact in own
    ]
    c, n3, rows = len(own), state.y.shape[1], len(state.lam)

    def another() -> State:
        return State(*(np.zeros_like(part) for part in state))

    return Contacts(
        np.array(place, np.int64).reshape(-1, 3),
        np.array(number).reshape(-1, HELD + 1),
        np.zeros(FAILURE + 1),
        another(),
        another(),
        np.zeros((6, n3)),
        np.zeros((2, n3)),
        np.zeros((2, n3)),
        np.zeros(rows),
        np.zeros(n3),
        np.zeros((len(PARTS), c)),
        np.zeros((c, n3)),
        np.zeros((c, c)),
        np.zeros((c, c)),
        np.zeros((c, 2 * c + 2)),
        np.zeros((SHIFT + 1, c)),
        np.zeros((MOST_LOOKS + 2, 6)),
        np.zeros((KEPT + 1, c), np.int64),
        *_without(ready),
        np.zeros((2, c), np.int64),
    )


def _without(ready: PreparedDynamics) -> tuple[Schur, np.ndarray]:
    """What steps need while all contacts are open."""
    packed, schur, special = ready.packed, ready.dynamics.schur, ready.packed.system.special
    if not ready.switches.contacts:
        return schur, special
    blocks = schur.rows[(schur.rows >= 0).any(axis=1)]
    kept = blocks[np.argsort(blocks.max(axis=1))]
    others = int((special[:, RELATIVE_ROW] < packed.contact_rows).sum())
    first = special[:others] if (special[:others, RELATIVE_ROW] < packed.contact_rows).all() else special
    return plan_schur(packed.system.row_body, np.ascontiguousarray(kept, np.int64))[0], first
