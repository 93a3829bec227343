"""The generalised forces of all loads along a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.equations.laws import Laws
from mbsd.equations.loads import Loads, tabulate_loads

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


def loads_along(packed: Packed, loads: Loads, laws: Laws, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(T, 3 nb) generalised forces of all loads but friction along a motion q, v (T, 3 nb); zero for ground.

    Raises ModelError where a function of the user fails.
    """
    out = np.zeros_like(q)
    if loads.total:
        tabulate_loads(packed.system, loads, laws, t, q, v, packed.ws, out, np.zeros(len(t)))
        packed.specials.check()
        out[:, :3] = 0.0
    return out
