"""Pin in slot (point on line): marker j moves along the x axis of marker i and turns freely.

    Phi = n_i . (p_j - p_i)        constraint `slot`, 1 row

The reaction on body j is a force across the slot.
"""

from __future__ import annotations

from mbsd.model.adding.joints import Limits, join, limits_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

PIN_IN_SLOT = register(
    JointKind("pin_in_slot", ("slot",), look="captive", example=lambda m, i, j: m.pin_in_slot("example", i, j))
)


@PIN_IN_SLOT.adds
def pin_in_slot(m: Model, name: str, slot: Marker, pin: Marker, limits: Limits = None) -> Joint:
    """The point of marker ``pin`` moves along the x axis of marker ``slot``, within ``limits`` (m)."""
    return join(m, PIN_IN_SLOT, name, slot, pin, None, **limits_given(m, name, limits))
