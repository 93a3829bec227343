"""Friction of a joint along a motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.names import Suggesting

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


@dataclass(frozen=True)
class FrictionView(Suggesting):
    """Friction of a joint, (T,) arrays."""

    rate: np.ndarray
    """Speed at which it turns (rad/s) or slides (m/s): of its second marker against its first."""
    normal: np.ndarray
    """Normal force, without preload (N)."""
    force: np.ndarray
    """Friction on its second body, along the way (N), or about the pin (N m)."""

    @property
    def power(self) -> np.ndarray:
        """(T,) what it takes from the motion (W), never positive."""
        return self.force * self.rate


def friction_view(
    packed: Packed,
    name: str,
    q: np.ndarray,
    v: np.ndarray,
    lam: np.ndarray,
    held: np.ndarray | None = None,
    pairs: np.ndarray | None = None,
) -> FrictionView:
    """View of the friction ``name``; q, v (T, nb, 3) or (T, 3 nb), lam (T, m).

    ``held`` (T, m) are the rows of J that hold, None: all; ``pairs`` (T, o) those of outlines.
    A joint that an action released has no friction.
    """
    from mbsd.arrays.curve_branches import tabulate_along
    from mbsd.arrays.directory import directory
    from mbsd.arrays.friction_along import normals_along
    from mbsd.arrays.loads import pack_loads
    from mbsd.equations.joint_friction import FIRST, WAY, tabulate_rates

    count, rows = len(lam), len(packed.ws.phi)
    flat_q, flat_v = (np.ascontiguousarray(part.reshape(count, -1)) for part in (q, v))
    phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
    drives = np.zeros((count, len(packed.motions) + 1, 3))
    tabulate_along(packed, drives, flat_q, flat_v, phi, compact, gamma, pairs)
    loads = pack_loads(packed)
    normal = normals_along(packed, loads, flat_q, compact, lam)
    [k] = directory(packed)[name].friction
    rate, force = np.zeros((2, count))
    tabulate_rates(packed.system, loads, k, flat_q, flat_v, normal[:, k], packed.ws, rate, force)
    way = int(loads.friction[k, WAY])
    force = -lam[:, way] if way >= 0 else force
    if held is not None:
        force = np.where(held[:, loads.friction[k, FIRST]], force, 0.0)
    return FrictionView(rate, normal[:, k], force)
