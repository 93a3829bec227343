"""States of forces along a motion, and whether it can be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.states import own_states
from mbsd.results.measured import measured

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


def check_states(packed: Packed, t: np.ndarray, q: np.ndarray, states: np.ndarray) -> None:
    """Let each force check its states (T, n) (SI) along poses q (T, 3 nb) at times (T,); raises ModelError."""
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.states is not None:
            assert force.kind.along is not None
            value = measured(packed, force.kind.along(force), i, j, q)
            force.kind.states.check(packed.name, force, t, value, states[:, own_states(packed.forces, force.name)])
