"""Velocities after an impact at a given state, by the law that simulations use."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from mbsd.dynamics.events.arrays import TOUCHING
from mbsd.dynamics.events.jumps import strike
from mbsd.dynamics.events.packing import contacts_of
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.state import start_state


def velocities_after(
    ready: PreparedDynamics, t: float, q: np.ndarray, v: np.ndarray, names: Collection[str]
) -> np.ndarray:
    """Return velocities (3 nb,) after the impacts of contacts by name, at t (s) and q, v (3 nb,).

    Raises ArithmeticError where no impulses are possible.
    """
    packed = ready.packed
    state = start_state(np.stack([q, v]), len(packed.ws.phi), t)
    contacts = contacts_of(ready, state, [], ready.end - ready.start, None)
    for k, contact in enumerate(ready.switches.contacts):
        contacts.chosen[TOUCHING, k] = contact.name in names
    scratch = scratch_for(ready.dynamics, packed.ws, len(packed.motions), 1, (0, 0))
    if not strike(ready.dynamics, scratch, contacts, t, state.y):
        raise ArithmeticError(f"{packed.name}: at t = {t:.6g} s no impulses of contacts are possible")
    return state.y[1]
