"""Pin in slot (point on line): the point of marker j moves along the x axis of marker i and turns freely.

    Phi = n_i . (p_j - p_i)        constraint `slot`, 1 row

The reaction on body j is a force across the slot.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register

PIN_IN_SLOT = register(JointKind("pin_in_slot", ("slot",), example=lambda m, i, j: m.pin_in_slot("example", i, j)))
