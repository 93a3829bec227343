"""Consistent poses and velocities at the start of rows that differ in them.

Where bodies form no loops and what is given tells all of them, the pose is that of the mechanism with these angles: a
few steps of Newton-Raphson in which given coordinates are held. Else each row's start is found as that of a single
simulation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.users_function import described
from mbsd.dynamics.many.designs import Designs
from mbsd.kinematics.pose.initial import consistent

if TYPE_CHECKING:
    from mbsd.dynamics.many.worker import Base


class Starts:
    """Starts row by row."""

    def __init__(self, designs: Designs, base: Base) -> None:
        self.designs, self.base = designs, base
        self.work: Any = designs.copied()

    def __call__(self, rows: range) -> tuple[np.ndarray, np.ndarray, list[str | None]]:
        """q and v (R, 3 nb) of rows, and why a row has none."""
        ready = self.base.run.ready
        q, v = np.repeat(ready.initial.q[None], len(rows), 0), np.repeat(ready.initial.v[None], len(rows), 0)
        reasons: list[str | None] = []
        for k, row in enumerate(rows):
            try:
                self.designs.put_start(self.work, row)
                initial = consistent(self.work, ready.packed, ready.start, ready.dynamics.metric)
                q[k], v[k] = initial.q, initial.v
                reasons.append("; ".join(initial.velocities) or None)
            except Exception as error:
                reasons.append(described(error))
        return q, v, reasons


def starts_of(designs: Designs, base: Base) -> Starts:
    """The starts of rows."""
    return Starts(designs, base)
