"""The generalised forces of all loads along a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.approaches import stretches
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.states import widened, with_states
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
    states: np.ndarray | None = None,
) -> np.ndarray:
    """Return (T, 3 nb) forces of all loads but friction along a motion q, v (T, 3 nb).

    They are generalised forces, zero for ground.

    ``approached`` (T, n): how fast contacts approached (m/s), where they ask for it; None: as kernels remember it now.
    ``states`` (T, n): those of forces (SI), of a mechanism that is packed without them.
    Raises ModelError where a function of the user fails.
    """
    if states is not None:
        wide = with_states(packed)
        wide_q, wide_v = widened(wide, q), widened(wide, v, states)
        return loads_along(wide, pack_loads(wide), laws, t, wide_q, wide_v, approached)[:, : q.shape[1]]
    out = np.zeros_like(q)
    if loads.total:
        power = np.zeros(len(t))
        for at in stretches(loads, approached, len(t)):
            tabulate_loads(packed.system, loads, laws, t[at], q[at], v[at], packed.ws, out[at], power[at])
        packed.specials.check()
        out[:, :3] = 0.0
    return out
