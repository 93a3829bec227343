"""How a mechanism answers impulses and forces at a pose, its joints and drivers holding, its contacts open.

    M dv + J^T p = impulse,  J dv = 0          M a + J^T lam = Q,  J a = gamma

One sparse factorisation serves all right-hand sides of an event.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.loads_along import loads_along
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import times_compact
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.rows.switches import Switches
from mbsd.equations.assembly import tabulate

LESS = 1e-5
"""Fraction of the lift of coordinates without inertia: here nothing is refined, and a smaller one does no harm."""


class Compliance:
    """Compliance of one pose and time; ``compact`` (m, 6) is J of all rows, ``phi`` (m,) their residuals."""

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

    def rates(self, rows: Sequence[int] | np.ndarray, v: np.ndarray) -> np.ndarray:
        """(k,) J v of the rows."""
        return times_compact(self.packed, self.compact[None], v[None])[0][list(rows)]

    def answer(self, impulses: np.ndarray) -> np.ndarray:
        """(n, k) change of velocities by impulses (n, k)."""
        return self.answers(impulses)[0]

    def answers(self, impulses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n, k) change of velocities by impulses (n, k), and (m, k) the multipliers of joints and drivers."""
        lam = np.zeros((len(self.compact), impulses.shape[1]))
        if not impulses.shape[1]:
            return impulses, lam
        solved = self._solve(np.vstack([impulses, np.zeros((len(self.rows), impulses.shape[1]))]))
        lam[self.rows] = solved[self._count :]
        return solved[: self._count], lam

    def stopped(self, rows: Sequence[int] | np.ndarray, v: np.ndarray) -> np.ndarray:
        """(3 nb,) velocities v with the rates of the rows taken off by impulses along them; rows may depend."""
        directions = self.generalised(rows)
        dv, out = self.answer(directions), v.copy()
        out[3:] -= dv @ np.linalg.lstsq(directions.T @ dv, self.rates(rows, v), rcond=1e-12)[0]
        return out

    def loads(self, v: np.ndarray) -> np.ndarray:
        """(3 nb,) weight and all loads but friction of joints."""
        time = np.array([self.time])
        loads = loads_along(self.packed, self.dynamics.loads, self.dynamics.laws, time, self.q[None], v[None])
        return loads[0] + self.dynamics.weight

    def gamma(self, v: np.ndarray) -> np.ndarray:
        """(m,) of all rows."""
        return self._tabulate(v)

    def accelerations(self, loads: np.ndarray, gamma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Without contacts, under loads (3 nb,): a (n,), and the multipliers (m,) of joints and drivers."""
        solved, lam = self._solve(np.concatenate([loads[3:], gamma[self.rows]])), np.zeros(len(gamma))
        lam[self.rows] = solved[self._count :]
        return solved[: self._count], lam
