"""The index-1 equations of pinned mechanisms as an able user writes them with numpy: M a + J^T lam = Q, J a = gamma."""

from __future__ import annotations

import numpy as np

from benchmarks.dynamics.problems import Plain


class Index1:
    """Residuals, Jacobian and accelerations; states are flat (3 nb,)."""

    def __init__(self, plain: Plain) -> None:
        self.plain = plain
        self.n, self.m = 3 * len(plain.mass), 2 * len(plain.pins)
        self.inertia = np.column_stack([plain.mass, plain.mass, np.maximum(plain.inertia, 1e-12)]).ravel()
        pins = np.array(plain.pins)
        self.first, self.second = pins[:, 0].astype(int), pins[:, 3].astype(int)
        self.arm_first, self.arm_second = pins[:, 1:3], pins[:, 4:6]
        self.kkt = np.zeros((self.n + self.m, self.n + self.m))
        self.kkt[: self.n, : self.n] = np.diag(self.inertia)
        self.weight = np.tile([0.0, -plain.gravity, 0.0], len(plain.mass)) * self.inertia

    def _ends(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """World arms and places of both ends of the pins; ground's arms are places."""
        bodies = np.vstack([q.reshape(-1, 3), np.zeros(3)])
        out = []
        for number, arm in ((self.first, self.arm_first), (self.second, self.arm_second)):
            c, s = np.cos(bodies[number, 2]), np.sin(bodies[number, 2])
            turned = np.column_stack([c * arm[:, 0] - s * arm[:, 1], s * arm[:, 0] + c * arm[:, 1]])
            out += [turned, bodies[number, :2] + turned]
        return out[0], out[1], out[2], out[3]

    def constraints(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Phi (m,) and J (m, n)."""
        arm_i, place_i, arm_j, place_j = self._ends(q)
        jac = np.zeros((self.m, self.n + 3))
        rows = np.arange(len(self.first))
        for number, arm, sign in ((self.first, arm_i, -1.0), (self.second, arm_j, 1.0)):
            column = np.where(number >= 0, 3 * number, self.n)
            jac[2 * rows, column] = sign
            jac[2 * rows + 1, column + 1] = sign
            jac[2 * rows, column + 2] = -sign * arm[:, 1]
            jac[2 * rows + 1, column + 2] = sign * arm[:, 0]
        return (place_j - place_i).ravel(), jac[:, : self.n]

    def loads(self, q: np.ndarray) -> np.ndarray:
        """(n,) weight, torque and spring."""
        out = self.weight.copy()
        if self.plain.torque:
            out[3 * self.plain.torque[0] + 2] += self.plain.torque[1]
        if self.plain.spring:
            _, x, y, j, sx, sy, stiffness, length = self.plain.spring
            c, s = np.cos(q[3 * j + 2]), np.sin(q[3 * j + 2])
            arm = np.array([c * sx - s * sy, s * sx + c * sy])
            gap = q[3 * j : 3 * j + 2] + arm - (x, y)
            now = np.hypot(*gap)
            pull = -stiffness * (now - length) * gap / now
            out[3 * j : 3 * j + 2] += pull
            out[3 * j + 2] += arm[0] * pull[1] - arm[1] * pull[0]
        return out

    def gamma(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(m,)"""
        arm_i, _, arm_j, _ = self._ends(q)
        spin = np.append(v[2::3], 0.0) ** 2
        return (spin[self.second, None] * arm_j - spin[self.first, None] * arm_i).ravel()

    def accelerations(self, q: np.ndarray, v: np.ndarray, stabilise: float = 0.0) -> np.ndarray:
        """(n,) with Baumgarte's stabilisation at the rate given (1/s)."""
        phi, jac = self.constraints(q)
        right = self.gamma(q, v) - 2 * stabilise * (jac @ v) - stabilise**2 * phi
        self.kkt[self.n :, : self.n] = jac
        self.kkt[: self.n, self.n :] = jac.T
        return np.linalg.solve(self.kkt, np.concatenate([self.loads(q), right]))[: self.n]
