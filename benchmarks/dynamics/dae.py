"""A mechanism of pins as a DAE F(y, y') = 0 with its Newton matrix, for SUNDIALS IDA.

    y = (q, v, lam)            q' - v = 0,              M v' + J^T lam - Q = 0,    J v' - gamma + 2 b J v + b^2 Phi = 0
    y = (q, v, lam, mu)        q' - v + J^T mu = 0,     the same,                  J v = 0,     Phi = 0

The first, index 1, has Baumgarte's feedback with rate b (1/s). The second, index 2, is the form of Gear, Gupta and
Leimkuhler (J. Comp. Appl. Math. 12, 1985). The Newton matrix is dF/dy + c dF/dy'; the derivative of J^T mu by q is left
out, for mu stays at rounding.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from benchmarks.dynamics.equations import Equations
from benchmarks.dynamics.pins import Pinned


class Dae:
    """Equations of one mechanism, with the constraint as ``index`` 1 or 2."""

    def __init__(self, model: Pinned, index: int, feedback: float = 0.0) -> None:
        self.model, self.index, self.feedback = model, index, feedback
        self.eq = eq = Equations(model)
        self.n, self.m = eq.size, eq.rows
        self.length = 2 * self.n + self.m * index
        self.algebraic = list(range(2 * self.n, self.length))
        rows, columns = self._pattern()
        self.cells, self.where = np.unique(columns * self.length + rows, return_inverse=True)
        self.columns, self.rows = np.divmod(self.cells, self.length)
        ones = np.ones(len(self.cells))
        cells = self.rows.astype(np.int32), self.columns.astype(np.int32)  # what IDA counts in
        self.sparsity = sparse.csc_array((ones, cells), shape=(self.length, self.length))

    def start(self) -> tuple[np.ndarray, np.ndarray]:
        """Consistent y and y'."""
        q, v = (part.ravel() for part in self.model.start)
        eq = self.eq
        arms = eq.arms(q)
        jac = eq.jacobian(arms)
        free = eq.loads(q) * eq.weight
        lam = np.linalg.solve((jac * eq.weight) @ jac.T, jac @ free - eq.gamma(v, arms))
        y = np.concatenate([q, v, lam, np.zeros(self.length - 2 * self.n - self.m)])
        slope = np.zeros(self.length)
        slope[: 2 * self.n] = np.concatenate([v, free - eq.weight * (lam @ jac)])
        return y, slope

    def tolerances(self, of_motion: float) -> np.ndarray:
        """Absolute ones: the multipliers follow from the motion and must not steer the step."""
        return np.where(np.arange(self.length) < 2 * self.n, of_motion, 1e10)

    def unpack(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Poses and velocities (bodies, 3)."""
        return y[: self.n].reshape(-1, 3), y[self.n : 2 * self.n].reshape(-1, 3)

    def residual(self, _t: float, y: np.ndarray, yp: np.ndarray, res: np.ndarray) -> None:
        """F."""
        eq, n, m = self.eq, self.n, self.m
        q, v, lam, mu = y[:n], y[n : 2 * n], y[2 * n : 2 * n + m], y[2 * n + m :]
        arms = eq.arms(q)
        jac = eq.jacobian(arms)
        res[n : 2 * n] = eq.mass * yp[n : 2 * n] + lam @ jac - eq.loads(q)
        if self.index == 1:
            res[:n] = yp[:n] - v
            b = self.feedback
            res[2 * n :] = jac @ (yp[n : 2 * n] + 2 * b * v) - eq.gamma(v, arms) + b * b * eq.residual(q, arms)
        else:
            res[:n] = yp[:n] - v + mu @ jac
            res[2 * n : 2 * n + m] = jac @ v
            res[2 * n + m :] = eq.residual(q, arms)

    def fill_dense(self, _t: float, y: np.ndarray, yp: np.ndarray, _res: Any, c: float, out: np.ndarray) -> None:
        """The Newton matrix into a full one."""
        out[self.rows, self.columns] = self._values(y, yp, c)

    def fill_sparse(self, _t: float, y: np.ndarray, yp: np.ndarray, _res: Any, c: float, out: np.ndarray) -> None:
        """The Newton matrix by columns."""
        out[:] = self._values(y, yp, c)

    def _pattern(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns of all terms in the order of :meth:`_values`; terms of one cell add up."""
        eq, n, m = self.eq, self.n, self.m
        diagonal = np.arange(n)
        place, turn, x = eq.turn - 2, eq.turn, 2 * eq.pin
        jac = (np.concatenate([x, x + 1, x, x + 1]), np.concatenate([place, place + 1, turn, turn]))
        terms = [(diagonal, diagonal), (diagonal, n + diagonal), (n + diagonal, n + diagonal)]
        terms += [(n + jac[1], 2 * n + jac[0]), (n + turn, turn)]  # J^T by lam, (J^T lam) by q
        for s in eq.springs:
            body = 3 * s.j + np.arange(3)
            terms.append((n + np.repeat(body, 3), np.tile(body, 3)))
        last = 2 * n
        terms += [(last + jac[0], n + jac[1]), (last + np.concatenate([x, x + 1]), np.tile(turn, 2))]
        if self.index == 1:
            terms += [(last + np.concatenate([x, x + 1]), n + np.tile(turn, 2)), (last + jac[0], jac[1])]
        else:
            terms += [(last + m + jac[0], jac[1]), (jac[1], last + m + jac[0])]
        return np.concatenate([t[0] for t in terms]), np.concatenate([t[1] for t in terms])

    def _values(self, y: np.ndarray, yp: np.ndarray, c: float) -> np.ndarray:
        eq, n, m = self.eq, self.n, self.m
        q, v, lam, a = y[:n], y[n : 2 * n], y[2 * n : 2 * n + m], yp[n : 2 * n]
        arms = eq.arms(q)
        jac = np.concatenate([eq.sign, eq.sign, -arms.imag, arms.real])
        force = lam.view(complex)[eq.pin]
        omega, alpha = v[eq.turn], a[eq.turn]
        terms = [np.full(n, c), np.full(n, -1.0), c * eq.mass, jac, -(arms.conj() * force).real]
        for s in eq.springs:
            terms.append(-self._spring_slope(s, q).ravel())
        if self.index == 1:
            b = self.feedback
            by_angle = -(alpha + 2 * b * omega + 1j * omega**2) * arms
            by_rate = -2 * omega * arms
            terms += [(c + 2 * b) * jac, by_angle.real, by_angle.imag, by_rate.real, by_rate.imag, b * b * jac]
        else:
            by_angle = -omega * arms
            terms += [jac, by_angle.real, by_angle.imag, jac, jac]
        return np.bincount(self.where, np.concatenate(terms), len(self.cells))

    def _spring_slope(self, s: Any, q: np.ndarray) -> np.ndarray:
        """dQ/dq of one spring, 3 x 3, by central differences."""
        out = np.zeros((3, 3))
        body = slice(3 * s.j, 3 * s.j + 3)
        for k in range(3):
            step = np.zeros(len(q))
            step[3 * s.j + k] = 1e-6
            out[:, k] = (self.eq.loads(q + step)[body] - self.eq.loads(q - step)[body]) / 2e-6
        return out
