"""The generalised forces of all loads along a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.approaches import stretches
from mbsd.equations.laws import Laws
from mbsd.equations.loads import Loads, tabulate_loads

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


def loads_along(
    packed: Packed,
    loads: Loads,
    laws: Laws,
    t: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    approached: np.ndarray | None = None,
) -> np.ndarray:
    """(T, 3 nb) generalised forces of all loads but friction along a motion q, v (T, 3 nb); zero for ground.

    ``approached`` (T, n): how fast contacts approached (m/s), where they ask for it; None: as kernels remember it now.
    Raises ModelError where a function of the user fails.
    """
    out = np.zeros_like(q)
    if loads.total:
        power = np.zeros(len(t))
        for at in stretches(loads, approached, len(t)):
            tabulate_loads(packed.system, loads, laws, t[at], q[at], v[at], packed.ws, out[at], power[at])
        packed.specials.check()
        out[:, :3] = 0.0
    return out
