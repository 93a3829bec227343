"""numpy by hand: dense 9 x 9 Newton from the last pose, as one writes it for this linkage."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks import calls
from benchmarks.harness import Fresh

VERSION = np.__version__
TOLERANCE = 1e-10


def _side(q: np.ndarray, body: int, local: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return the place of a pin's side and its arm from the middle of the body."""
    if body < 0:
        return np.array(local), np.zeros(2)
    c, s = math.cos(q[3 * body + 2]), math.sin(q[3 * body + 2])
    arm = np.array([c * local[0] - s * local[1], s * local[0] + c * local[1]])
    return q[3 * body : 3 * body + 2] + arm, arm


def _equations(q: np.ndarray, omega: np.ndarray, phi: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    residual, jac, gamma = np.zeros(9), np.zeros((9, 9)), np.zeros(9)
    for k, (i, a, j, b) in enumerate(calls.PINS):
        rows = slice(2 * k, 2 * k + 2)
        (pi, si), (pj, sj) = _side(q, i, a), _side(q, j, b)
        residual[rows] = pj - pi
        for body, arm, sign in ((i, si, -1.0), (j, sj, 1.0)):
            if body >= 0:
                jac[rows, 3 * body : 3 * body + 2] = sign * np.eye(2)
                jac[rows, 3 * body + 2] = sign * np.array([-arm[1], arm[0]])
                gamma[rows] += sign * omega[body] ** 2 * arm
    residual[8] = q[2] - phi
    jac[8, 2] = 1.0
    return residual, jac, gamma


def _solve() -> np.ndarray:
    q = np.array([pose[:3] for pose in calls.POSES]).ravel()
    out = np.zeros((len(calls.ANGLES), 3, 9))
    still = np.zeros(3)
    speed = np.zeros(9)
    speed[8] = 1.0
    for k, phi in enumerate(calls.ANGLES):
        while True:
            residual, jac, _ = _equations(q, still, phi)
            if np.abs(residual).max() < TOLERANCE:
                break
            q = q - np.linalg.solve(jac, residual)
        v = np.linalg.solve(jac, speed)
        gamma = _equations(q, v[2::3], phi)[2]
        out[k] = q, v, np.linalg.solve(jac, gamma)
    return out


def run(problem: str) -> tuple[str, Fresh, Callable[[Any], float]]:
    """Return settings, a fresh run of the sweep and the error of its result."""

    def error(result: np.ndarray) -> float:
        coupler, rocker = calls.exact(calls.ANGLES)
        return max(calls.worst(result[:, 0, 5], coupler), calls.worst(result[:, 0, 8], rocker))

    return f"Newton, numpy.linalg.solve, pos+vel+acc, tolerance {TOLERANCE:g}", lambda: _solve, error
