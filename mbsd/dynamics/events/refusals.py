"""Errors of contacts: they start inside what they should touch, nothing gives way, or friction jams."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.friction_along import REMEDY, jam
from mbsd.arrays.packing import Packed
from mbsd.base.errors import SimulationError
from mbsd.dynamics.events.laws.complementarity import jammed, refuse_driven
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.many.contacts.arrays import FAILURE, NO_AGREEMENT, NOW, TAKING, Contacts
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.rows.switches import Switches
from mbsd.dynamics.state import TIME, State

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics

INSIDE = 1e-6
"""A contact that starts deeper than this part of the size (rad) inside is refused."""


def refuse_inside(packed: Packed, dynamics: Dynamics, switches: Switches, state: State) -> None:
    """Raise SimulationError for a contact that starts inside."""
    if not switches.contacts:
        return
    scale = packed.row_scale()
    residuals = Compliance(packed, dynamics, switches, float(state.clock[TIME]), state.y[0]).phi
    for contact in switches.contacts:
        gap = float(residuals[contact.gap])
        if not contact.always_closed and gap * scale[contact.gap] < -INSIDE:
            closed = contact.joint.params.get("closed") is True
            other = "give the points of its closed curve in reverse order" if closed else "turn the contact's marker"
            raise SimulationError(
                f"{packed.name}: contact '{contact.name}' starts {-gap:.3g} (m or rad) inside; "
                f"move the start with start_near, or, where its solid side is the wrong one, {other}"
            )


def jam_at(ready: PreparedDynamics, contacts: Contacts, state: State) -> SimulationError:
    """Return the error of an event at which no velocities or forces are possible, from the arrays of the loop."""
    packed, time = ready.packed, float(state.clock[TIME])
    if contacts.clock[FAILURE] == NO_AGREEMENT:
        return SimulationError(f"{packed.name}: at t = {time:.6g} s {jam(packed, contacts.sticks.normal[NOW])}. {REMEDY}.")
    at = Compliance(packed, ready.dynamics, ready.switches, time, state.y[0].copy())
    count = len(ready.switches.contacts)
    taking = np.flatnonzero(contacts.chosen[TAKING, :count]).tolist()
    pressed = contacts.friction.compliance if len(contacts.friction.gap) else contacts.compliance
    closed = [ready.switches.contacts[k] for k in taking]
    try:
        refuse_driven(at, closed, contacts.compliance[np.ix_(taking, taking)])
        refuse_driven(at, closed, pressed[np.ix_(taking, taking)])
    except SimulationError as error:
        return error
    return jammed(at, closed)
