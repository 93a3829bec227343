"""A chain of 100 links, bars of 0.1 m and 0.1 kg, released in a straight line off the vertical.

It starts at rest, 30 degrees off the vertical.

Errors after 1 s: drift of the energy (J) and the worst angle (rad) against the equations in absolute angles, written
out and integrated by themselves:

  sum_j A_ij (cos(theta_i - theta_j) theta_j'' + sin(theta_i - theta_j) theta_j'^2) = -m g L (n - i + 1/2) cos theta_i
    A_ij = m L^2 (n - max(i, j) + 1/2),  A_ii = m L^2 (n - i + 1/3)
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.dynamics.pins import GROUND, Pin, Pinned, Record, Solid, energy_drift

NAME = "chain of 100 links"
LINKS = 100
LENGTH, MASS, GRAVITY = 0.1, 0.1, 9.81
SLANT = -math.pi / 3
DURATION = 1.0
LIMITS = {"energy drift (J)": 1e-2, "angle (rad)": 1e-6}
BAR = 10.0
"""How many times our time the best peer that meets both limits takes at least."""


def model() -> Pinned:
    """Each link's frame at its middle, x along it."""
    c, s = math.cos(SLANT), math.sin(SLANT)
    solids, pins = [], []
    for k in range(LINKS):
        reach = (k + 0.5) * LENGTH
        solids.append(Solid(MASS, MASS * LENGTH**2 / 12, (reach * c, reach * s, SLANT)))
        before = (GROUND, (0.0, 0.0)) if k == 0 else (k - 1, (LENGTH / 2, 0.0))
        pins.append(Pin(*before, k, (-LENGTH / 2, 0.0)))
    return Pinned(tuple(solids), tuple(pins), GRAVITY)


EXACT = (
    -1.475344634,
    -1.462858154,
    -1.444751338,
    -1.418126589,
    -1.376627584,
    -1.306484429,
    -1.173571844,
    -1.052320520,
    -1.046842804,
    -1.047197572,
)
"""Angles of every tenth link at the end (rad), by DOP853 with rtol 1e-9 on the equations above."""


def angles(links: int, duration: float) -> np.ndarray:
    """(links,) at the end (rad), from the equations; 100 links take half a minute."""
    from scipy.integrate import solve_ivp

    below = links - np.arange(1, links + 1)
    shared = MASS * LENGTH**2 * (np.minimum(below[:, None], below) + 0.5)
    own = MASS * LENGTH**2 * (below + 1 / 3)
    load = MASS * GRAVITY * LENGTH * (below + 0.5)

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        theta, omega = y[:links], y[links:]
        between = theta[:, None] - theta
        matrix = shared * np.cos(between)
        np.fill_diagonal(matrix, own)
        right = -(shared * np.sin(between)) @ omega**2 - load * np.cos(theta)
        return np.concatenate([omega, np.linalg.solve(matrix, right)])

    start = np.concatenate([np.full(links, SLANT), np.zeros(links)])
    solved = solve_ivp(rates, (0.0, duration), start, method="DOP853", rtol=1e-9, atol=1e-11)
    return solved.y[:links, -1]


def errors(record: Record) -> dict[str, float]:
    """By the names of LIMITS."""
    angle = float(np.abs(record.poses[-1, 9::10, 2] - EXACT).max())
    if abs(record.times[-1] - DURATION) > 1e-6 or not np.isfinite(angle):
        angle = float("inf")
    return {"energy drift (J)": energy_drift(model(), record), "angle (rad)": angle}
