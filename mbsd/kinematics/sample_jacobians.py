"""Jacobians at unrelated poses, by which the elimination is planned."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.kept import Kept
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.equations.constraints.relative import ACTIVE, ROW

_SAMPLES: Kept[np.ndarray] = Kept()


def sample_jacobians(packed: Packed) -> np.ndarray:
    """(4, m, n) at unrelated poses, to see which entries are constant."""
    numbers = packed.numbers()
    return _sampled(packed) if numbers is None else _SAMPLES.get(numbers, lambda: _sampled(packed))


def _sampled(packed: Packed) -> np.ndarray:
    random = np.random.default_rng(2)
    none = np.zeros((len(packed.motions) + 1, 3))
    samples = []
    special, rows = packed.system.special.copy(), packed.system.special[:, ROW]
    special[:, ACTIVE] = 0  # their entries may be constant here and there, as in the dwell of a Geneva: none counts
    system = packed.system.changed(special=special)
    for _ in range(4):
        q = np.zeros(3 * len(packed.body_names))
        q[3:] = random.uniform(-2.0, 2.0, packed.coordinates) * packed.column_scale()
        residual_and_jacobian(system, q, none, packed.ws)
        packed.ws.jac[rows] = random.uniform(1.0, 2.0, (len(rows), 6))
        samples.append(packed.jacobian())
    return np.array(samples)
