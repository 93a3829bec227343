"""Friction of joints as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.equations.joint_friction import BY_RATE, GUIDE, PIN

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


SHAPES = {"pin": PIN, "guide": GUIDE, "slot": 2}
"""What the kernels call the pairs of :attr:`mbsd.model.joint.JointKind.pair`."""
SHARP = 1e-9
"""Slip speed, in sizes/s, of joints that stick, where no simulation looks for the events."""


def pack_friction(packed: Packed) -> tuple[np.ndarray, np.ndarray]:
    """The table (f, 7) and the numbers (f, 8), for Loads."""
    rows, numbers = [], []
    names = [joint.name for joint in packed.joints]
    sharp = SHARP * packed.size
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.of_reactions:
            p, k = force.params, names.index(force.params["joint"])
            shape = SHAPES[packed.joints[k].kind.pair or ""]
            second = int(packed.system.marker_body[j] > 0)
            way = packed.first_row[names.index(force.name)] if force.name in names else -1
            rows.append((shape, i, j, packed.first_row[k], packed.first_row[k + 1], second, way))
            slip_speed = sharp if p["sticks"] else p["slip_speed"]
            own = (p["coefficient"], p["static"], p["stribeck"], p["viscous"], slip_speed, p["preload"])
            numbers.append((*own, p["radius"] if shape == PIN else p["length"], BY_RATE))
    return np.array(rows, np.int64).reshape(-1, 7), np.array(numbers, float).reshape(-1, 8)
