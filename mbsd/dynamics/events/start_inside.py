"""Refuse contacts that start inside what they should touch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import SimulationError
from mbsd.dynamics.events.monitors import Samples
from mbsd.dynamics.reference.arrays import Dynamics, Scratch
from mbsd.dynamics.rows.switches import RunContact
from mbsd.dynamics.state import TIME, State

INSIDE = 1e-6
"""A contact that starts deeper than this part of the size (rad) inside is refused."""


def refuse_inside(
    packed: Packed, dynamics: Dynamics, scratch: Scratch, contacts: Sequence[RunContact], state: State
) -> None:
    """Raise SimulationError for a contact that starts inside."""
    scale = packed.row_scale()
    time = np.array([state.clock[TIME]])
    sample = Samples(packed, dynamics, scratch, time, state.y[0][None], state.y[1][None])
    for contact in contacts:
        gap = float(sample.residuals()[0, contact.gap])
        if not contact.always_closed and gap * scale[contact.gap] < -INSIDE:
            closed = contact.joint.params.get("closed") is True
            other = "give the points of its closed curve in reverse order" if closed else "turn the contact's marker"
            raise SimulationError(
                f"{packed.name}: contact '{contact.name}' starts {-gap:.3g} (m or rad) inside; "
                f"move the start with start_near, or, where its solid side is the wrong one, {other}"
            )
