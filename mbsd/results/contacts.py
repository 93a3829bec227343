"""Results of a contact during a simulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.names import Suggesting

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


@dataclass(frozen=True)
class ContactView(Suggesting):
    """A contact, (T,) arrays: m and N, or rad and N m for stops of angles."""

    gap: np.ndarray
    rate: np.ndarray
    """Rate of the gap, by s."""
    normal: np.ndarray
    """Force that pushes the gap open, never negative."""
    friction: np.ndarray
    """Force along the sliding way."""

    @property
    def closed(self) -> np.ndarray:
        """(T,) where it pushes."""
        return self.normal > 0.0


def contact_view(packed: Packed, row: int, q: np.ndarray, v: np.ndarray, lam: np.ndarray) -> ContactView:
    """View of the contact whose gap is ``row``; q, v (T, nb, 3), lam (T, m)."""
    from mbsd.arrays.curve_branches import tabulate_along
    from mbsd.arrays.reactions import times_compact

    count, rows = len(lam), len(packed.ws.phi)
    flat_q, flat_v = q.reshape(count, -1), v.reshape(count, -1)
    phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
    drives = np.zeros((count, len(packed.motions) + 1, 3))
    tabulate_along(packed, drives, flat_q, flat_v, phi, compact, gamma)
    joint = packed.joint_of_row(row)
    friction = -lam[:, row + 1] if len(joint.kind.constraints) > 1 else np.zeros(count)
    return ContactView(phi[:, row], times_compact(packed, compact, flat_v)[:, row], -lam[:, row], friction)
