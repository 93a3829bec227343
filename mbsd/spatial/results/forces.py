"""Forces along a motion: measures, rates and efforts, or forces and moments at frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.names import Suggesting
from mbsd.spatial.arrays.along import force_rows
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.equations.calls import tabulate_calls
from mbsd.spatial.model.rotation import rotation_matrix


@dataclass(frozen=True, eq=False)
class ForceView(Suggesting):
    """A force of one row or more: m and N, or rad and N m."""

    values: np.ndarray
    """(T, rows) lengths, turns or places that it measures."""
    rates: np.ndarray
    """(T, rows) by s."""
    efforts: np.ndarray
    """(T, rows) pushes that make them larger."""

    @property
    def value(self) -> np.ndarray:
        """(T,) measure of the first row."""
        return self.values[:, 0]

    @property
    def rate(self) -> np.ndarray:
        """(T,) its rate, by s."""
        return self.rates[:, 0]

    @property
    def effort(self) -> np.ndarray:
        """(T,) push of the first row."""
        return self.efforts[:, 0]

    @property
    def power(self) -> np.ndarray:
        """(T,) power that it puts into the mechanism (W)."""
        return (self.rates * self.efforts).sum(axis=1)


@dataclass(frozen=True, eq=False)
class WrenchView(Suggesting):
    """A force by a function of frames: forces and moments at them, in the world."""

    forces: np.ndarray
    """(T, f, 3) at each frame (N)."""
    moments: np.ndarray
    """(T, f, 3) at each frame (N m)."""
    energy: np.ndarray
    """(T,) that it holds (J); 0 of functions of the user."""
    power: np.ndarray
    """(T,) power that it puts into the mechanism (W)."""

    @property
    def force(self) -> np.ndarray:
        """(T, 3) on the second body, or the last frame (N)."""
        return self.forces[:, -1]

    @property
    def moment(self) -> np.ndarray:
        """(T, 3) at the second body's place, or the last frame (N m)."""
        return self.moments[:, -1]


def wrench_view(packed: Packed, force: int, motion: Any, wanted: np.ndarray) -> WrenchView:
    """Return the view of a force that is a function, by its number."""
    own = sum(known.call is not None for known in packed.forces[:force])
    count, (t, q, v) = int(packed.system.call[own, 2]), (part[wanted] for part in (motion.times, motion.q, motion.v))
    out = np.zeros((len(t), *packed.ws.outputs.shape))
    tabulate_calls(packed.system, t, np.ascontiguousarray(q), np.ascontiguousarray(v), packed.ws, out)
    power = np.zeros(len(t))
    wrenches = out[:, own, : 6 * count].reshape(-1, count, 2, 3)
    for k, frame in enumerate(packed.system.frame_place[packed.system.call[own, 1] :][:count]):
        b, arm = int(packed.system.arm_body[frame]), packed.system.arm[frame]
        if b > 0:
            turned = rotation_matrix(q[:, 7 * b - 1 : 7 * b + 3]) @ arm
            w = v[:, 6 * b : 6 * b + 3]
            power += (wrenches[:, k, 0] * (v[:, 6 * b - 3 : 6 * b] + np.cross(w, turned))).sum(axis=1)
            power += (wrenches[:, k, 1] * w).sum(axis=1)
    return WrenchView(wrenches[:, :, 0], wrenches[:, :, 1], out[:, own, 6 * count], power)


def force_view(packed: Packed, force: int, motion: Any, wanted: np.ndarray) -> ForceView:
    """Return the view of a force, by its number, at the ``wanted`` steps of a motion with multipliers."""
    values, rates = force_values(packed, force, motion, wanted)
    rows = packed.system.held + _rows_of(packed, force)
    return ForceView(values, rates, -motion.lam[wanted][:, rows])


def force_values(packed: Packed, force: int, motion: Any, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what a force measures (T, rows), and its rates."""
    values, rates = force_rows(packed, *(part[wanted] for part in (motion.drives, motion.q, motion.v, motion.turn)))
    rows = _rows_of(packed, force)
    return values[:, rows], rates[:, rows]


def _rows_of(packed: Packed, force: int) -> np.ndarray:
    """Return the numbers of a force's rows among those of all forces."""
    counts = [len(known.pushes) for known in packed.forces]
    return np.arange(counts[force]) + sum(counts[:force])
