"""Gas and oil in cylinders along simulations that are done: whether it has room and pressure, as ``simulate`` asks."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.chambers import check_pistons
from mbsd.arrays.packing import Packed
from mbsd.arrays.states import states_of
from mbsd.base.errors import MechanismError
from mbsd.results.states import check_states


def has_cylinders(packed: Packed) -> bool:
    """Whether there is a force that says after a simulation whether that can be."""
    return any(force.kind.chamber is not None or force.kind.states is not None for force in packed.forces)


def can_be(packed: Packed, t: np.ndarray, y: np.ndarray) -> bool:
    """Whether cylinders can be as they are along y (T, 2, 3 nb) at times (T,) (s)."""
    q = np.ascontiguousarray(y[:, 0])
    try:
        check_pistons(packed, t, q, tell=False)
        check_states(packed, t, q, states_of(packed, y[:, 1]))
    except MechanismError:
        return False
    return True
