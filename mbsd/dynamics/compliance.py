"""How a mechanism answers impulses and forces at a pose, its joints and drivers holding, its contacts open.

    M dv + J^T p = impulse,  J dv = 0          M a + J^T lam = Q,  J a = gamma

One sparse factorisation serves all right-hand sides of an event.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.assembly import tabulate
from mbsd.dynamics.arrays import Dynamics
from mbsd.dynamics.switches import Switches
from mbsd.loads import loads_along
from mbsd.packing import Packed
from mbsd.reactions import times_compact

LESS = 1e-5
"""Of the lift of coordinates without inertia: here nothing is refined, and a smaller one does no harm."""


class Compliance:
    """Of one pose and time; ``compact`` (m, 6) is J of all rows, ``phi`` (m,) their residuals."""

    def __init__(self, packed: Packed, dynamics: Dynamics, switches: Switches, time: float, q: np.ndarray) -> None:
        from scipy.sparse import bmat, csc_array, diags_array
        from scipy.sparse.linalg import splu

        self.packed = packed
        self.dynamics = dynamics
        self.time = time
        self.q = q
        self.rows = switches.bilateral()
        self.drive = packed.drives(np.array([time]))
        self._tabulate(np.zeros_like(q))
        inertia = dynamics.inertia[3:].copy()
        none = inertia == 0.0
        inertia[none] = LESS / dynamics.inverse[3:][none]
        jac = csc_array(self.generalised(self.rows).T)
        matrix = bmat([[diags_array(inertia), jac.T], [jac, None]], format="csc")
        self._solve = splu(matrix).solve
        self._count = len(inertia)

    def _tabulate(self, v: np.ndarray) -> np.ndarray:
        rows = len(self.packed.ws.phi)
        phi, gamma, compact = np.zeros((1, rows)), np.zeros((1, rows)), np.zeros((1, rows, 6))
        tabulate(self.packed.system, self.drive, self.q[None], v[None], self.packed.ws, phi, compact, gamma)
        self.phi, self.compact = phi[0], compact[0]
        return gamma[0]

    def generalised(self, rows: Sequence[int] | np.ndarray) -> np.ndarray:
        """(n, k) J^T of the rows, ground's entries left out."""
        rows = np.asarray(rows, np.int64)
        out = np.zeros((self._width, len(rows)))
        for side in (0, 1):
            at = 3 * self.packed.system.row_body[rows, side]
            for c in range(3):
                out[at + c, np.arange(len(rows))] = self.compact[rows, 3 * side + c]
        return out[3:]

    @property
    def _width(self) -> int:
        return len(self.q)

    def rates(self, rows: Sequence[int], v: np.ndarray) -> np.ndarray:
        """(k,) J v of the rows."""
        return times_compact(self.packed, self.compact[None], v[None])[0][list(rows)]

    def answer(self, impulses: np.ndarray) -> np.ndarray:
        """(n, k) change of velocities by impulses (n, k)."""
        right = np.vstack([impulses, np.zeros((len(self.rows), impulses.shape[1]))])
        return self._solve(right)[: self._count] if impulses.shape[1] else impulses

    def accelerations(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Without contacts: a (n,), gamma (m,) of all rows, and the largest load (N or N m)."""
        gamma = self._tabulate(v)
        loads = loads_along(
            self.packed, self.dynamics.loads, self.dynamics.laws, np.array([self.time]), self.q[None], v[None]
        )[0]
        loads = (loads + self.dynamics.weight)[3:]
        a = self._solve(np.concatenate([loads, gamma[self.rows]]))[: self._count]
        return a, gamma, float(np.abs(loads).max(initial=0.0))
