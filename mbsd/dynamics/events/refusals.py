"""Errors of contacts, from the arrays of the loop: they start inside, nothing gives way, or friction jams."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.friction_along import REMEDY, jam
from mbsd.base.errors import SimulationError
from mbsd.dynamics.events.arrays import ALONE, FAILURE, NO_AGREEMENT, NOW, TAKING, Contacts
from mbsd.dynamics.events.loop import INSIDE
from mbsd.dynamics.events.rows import STIFF
from mbsd.dynamics.state import TIME, State
from mbsd.dynamics.switches import RunContact
from mbsd.model.event import Happening

TURNS, BRIEF = 100, 1e-4
"""Changes of contacts that follow each other within this part of the time that is left, where they take turns."""

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics


def refuse_inside(ready: PreparedDynamics, residuals: np.ndarray) -> None:
    """Raise SimulationError for a contact that starts inside, with residuals (m,) at the start."""
    name, scale = ready.packed.name, ready.packed.row_scale()
    for contact in ready.switches.contacts:
        gap = float(residuals[contact.gap])
        if not contact.always_closed and gap * scale[contact.gap] < -INSIDE:
            closed = contact.joint.params.get("closed") is True
            other = "give the points of its closed curve in reverse order" if closed else "turn the contact's marker"
            raise SimulationError(
                f"{name}: contact '{contact.name}' starts {-gap:.3g} (m or rad) inside; "
                f"move the start with start_near, or, where its solid side is the wrong one, {other}"
            )


def jam_at(ready: PreparedDynamics, contacts: Contacts, state: State) -> SimulationError:
    """Return the error of an event at which no velocities or forces are possible."""
    where = f"{ready.packed.name}: at t = {float(state.clock[TIME]):.6g} s"
    if contacts.clock[FAILURE] == NO_AGREEMENT:
        return SimulationError(f"{where} {jam(ready.packed, contacts.sticks.normal[NOW])}. {REMEDY}.")
    taking = np.flatnonzero(contacts.chosen[TAKING, : len(ready.switches.contacts)]).tolist()
    pressed = contacts.friction.compliance if len(contacts.friction.gap) else contacts.compliance
    for k in taking:
        contact, own, stiff = ready.switches.contacts[k], contacts.compliance[k, k], STIFF * contacts.vector[ALONE, k]
        if not own > stiff:
            return SimulationError(
                f"{where} joints and drivers move '{contact.name}' against its stop, and nothing can give way. "
                "Drive less far, move the stop, or put a spring between."
            )
        if not pressed[k, k] > stiff:
            critical = contact.friction * own / (own - pressed[k, k])
            return _paradox(
                where, [contact], f": its friction {contact.friction:.4g} is above {critical:.4g}, from which on "
                "sliding this way its own normal force presses the bodies together"
            )  # fmt: skip
    closed = [ready.switches.contacts[k] for k in taking]
    frictions = ", ".join(f"{contact.friction:.4g}" for contact in closed)
    return _paradox(where, closed, f" with friction {frictions}" if closed else "")


def _paradox(where: str, taking: Sequence[RunContact], why: str) -> SimulationError:
    """Return the error where rigid bodies with Coulomb's friction have no motion; ``taking``: the contacts that jam."""
    names = [f"'{contact.name}'" for contact in taking]
    what = "joints that stick jam"
    if names:
        what = f"contact {names[0]} jams" if len(names) == 1 else f"contacts {' and '.join(names)} jam"
    return SimulationError(
        f"{where} {what}{why}. This is Painleve's paradox: with rigid bodies and "
        "Coulomb's friction the equations of motion have no solution in this pose, whatever the step or the method. "
        "Take less friction, or a contact that yields: m.contact(...) in place of m.rigid_contact(...), see "
        "docs/events.md."
    )


def taking_turns(model: str, happenings: Sequence[Happening], end: float) -> SimulationError | None:
    """Return the error of contacts that open and close in turns without end, or None for other events.

    ``end``: of the simulation (s).
    """
    last = happenings[-TURNS:]
    brief = len(last) == TURNS and last[-1].time - last[0].time < BRIEF * (end - last[0].time)
    if not brief or not all(each.what in ("opens", "closes", "sticks", "slides") for each in last):
        return None
    names = " and ".join(f"'{name}'" for name in dict.fromkeys(each.name for each in last))
    return SimulationError(
        f"{model}: near t = {last[-1].time:.6g} s {names} carry in turns: the last {TURNS} changes took "
        f"{last[-1].time - last[0].time:.2g} s. With rigid bodies and Coulomb's friction more than one motion is "
        "possible there, as where feet wedge each other. Take less friction, or contacts that yield: m.contact(...) in "
        "place of m.rigid_contact(...), see docs/events.md."
    )
