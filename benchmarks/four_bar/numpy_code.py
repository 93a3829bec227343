"""numpy by hand: reference coordinates, dense 9 x 9 Newton from the last pose, as one writes it for this linkage."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.four_bar import ANGLES, COUPLER, CRANK, GROUND, ROCKER, exact, worst

VERSION = np.__version__
SETTINGS = "Newton, numpy.linalg.solve, pos+vel+acc, tolerance 1e-10"
REPEATS = 3
TOLERANCE = 1e-10

# Pins: (body, place on it) of both sides; body -1 is ground. Bodies: crank, coupler, rocker, frames at their middles.
PINS = (
    (-1, (0.0, 0.0), 0, (-CRANK / 2, 0.0)),
    (0, (CRANK / 2, 0.0), 1, (-COUPLER / 2, 0.0)),
    (1, (COUPLER / 2, 0.0), 2, (ROCKER / 2, 0.0)),
    (-1, (GROUND, 0.0), 2, (-ROCKER / 2, 0.0)),
)


def _side(q: np.ndarray, body: int, local: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Place of a pin's side and its arm from the middle of the body."""
    if body < 0:
        return np.array(local), np.zeros(2)
    c, s = math.cos(q[3 * body + 2]), math.sin(q[3 * body + 2])
    arm = np.array([c * local[0] - s * local[1], s * local[0] + c * local[1]])
    return q[3 * body : 3 * body + 2] + arm, arm


def _equations(q: np.ndarray, omega: np.ndarray, phi: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    residual, jac, gamma = np.zeros(9), np.zeros((9, 9)), np.zeros(9)
    for k, (i, a, j, b) in enumerate(PINS):
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
    theta, swing = (float(x[0]) for x in exact(np.zeros(1)))
    q = np.zeros(9)
    for body, (x, y, angle, length) in enumerate(
        ((0.0, 0.0, 0.0, CRANK), (CRANK, 0.0, theta, COUPLER), (GROUND, 0.0, swing, ROCKER))
    ):
        q[3 * body :][:3] = x + length / 2 * math.cos(angle), y + length / 2 * math.sin(angle), angle
    out = np.zeros((len(ANGLES), 3, 9))
    still = np.zeros(3)
    speed = np.zeros(9)
    speed[8] = 1.0
    for k, phi in enumerate(ANGLES):
        while True:
            residual, jac, _ = _equations(q, still, phi)
            if np.abs(residual).max() < TOLERANCE:
                break
            q = q - np.linalg.solve(jac, residual)
        v = np.linalg.solve(jac, speed)
        gamma = _equations(q, v[2::3], phi)[2]
        out[k] = q, v, np.linalg.solve(jac, gamma)
    return out


def prepare() -> tuple[Any, Any]:
    """``solve`` and ``error`` for measure.py."""

    def error(result: np.ndarray) -> float:
        coupler, rocker = exact(ANGLES)
        return max(worst(result[:, 0, 5], coupler), worst(result[:, 0, 8], rocker))

    return _solve, error
