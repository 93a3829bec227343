"""Problems in space beside peers: a top, a loop, chains of universal joints, a sweep.

Errors are the largest coordinate of a watched place away from the exact one (m) at the end, of the sweep at all poses.
Exact places are those of tests/spatial; of the longest chain of both formulations at tolerance 1e-12, and of the sweep
by closed form. Each code has the cheapest setting that keeps the limit.
"""

from __future__ import annotations

import math

import numpy as np

TOP, BRICARD, SWEEP = "heavy top, 0.2 s", "Bricard's loop, 1 s", "spatial slider-crank, sweep of 1000 poses"
CHAINS = {f"chain of {count} universal joints, 1 s": count for count in (1, 10, 40)}
BATCH, COUNT = "1000 heavy tops, 0.2 s", 1000
PROBLEMS = (TOP, BRICARD, *CHAINS, SWEEP)
CODES = ("mbsd", "exudyn", "mujoco")
STEPS = 1000
DURATION = dict.fromkeys(PROBLEMS, 1.0) | {TOP: 0.2}
LIMITS = dict(zip(PROBLEMS, (1.5e-7, 1e-7, 1e-8, 1e-8, 1e-8, 2e-8), strict=True))
BARS = {
    name: {"exudyn": exudyn, "mujoco": mujoco}
    for name, exudyn, mujoco in zip(PROBLEMS, (200, 300, 2, 9, 30, 50), (15, 20, 10, 6, 6, 8), strict=True)
}
BARS[BATCH] = {"mujoco": 10}
"""How many times the time of mbsd each peer takes at least."""
DURATION[BATCH], LIMITS[BATCH] = DURATION[TOP], LIMITS[TOP]
SPIN, TOP_MASS, TOP_MOMENTS = (0.0, 150.0, -4.61538), 15.0, (0.234375, 0.46875, 0.234375)
LINK, LINK_MASS, LINK_MOMENTS = 0.1, 0.1, (1e-5, 0.1 * 0.01 / 12, 0.1 * 0.01 / 12)
CORNERS = ((0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1))
"""Corners of Bricard's loop; the hinge at each is along y, z, x in turn."""
AXES = ((0, 1, 0), (0, 0, 1), (1, 0, 0)) * 2
BEARING, PIN, EYE, ROD = (0.0, 0.1, 0.12), (0.0, 0.1, 0.2), (0.2, 0.0, 0.0), 0.3
CRANK, RATE = 0.08, -2.0 * math.pi

ENDS = {
    TOP: (0.6055505613769797, 0.5989576817949867, -0.5239830274300867),
    BRICARD: (0.5105014611872203, -1.649167599394806, 0.14012311455318605),
    "chain of 1 universal joints, 1 s": (0.011016097432845522, -0.0993868804585592, -0.0009452989295025472),
    "chain of 10 universal joints, 1 s": (0.1621894405667371, -0.8806080293260177, 0.09764551553752829),
    "chain of 40 universal joints, 1 s": (-3.240279545753525, -1.494736227774132, -1.773651925009266),
}


def moments_of_rod(k: int) -> np.ndarray:
    """Return the moments (3,) of rod k of Bricard's loop, .1 m square, about its centre (kg m^2)."""
    along = np.abs(np.subtract(CORNERS[k], CORNERS[k - 1]))
    return along * 0.02 / 12 + (1 - along) * 1.01 / 12


def spins() -> np.ndarray:
    """Return angular velocities (COUNT, 3) of the tops at the start (rad/s), that of the single one first."""
    return np.array(SPIN) * np.linspace(1.0, 0.9, COUNT)[:, None]


def error_at_end(problem: str, place: np.ndarray) -> float:
    """Return the largest error of the watched place (m)."""
    return float(np.abs(place - ENDS[problem]).max())


def angles() -> np.ndarray:
    """Return the turns (T,) of the crank of the sweep (rad)."""
    return RATE * np.arange(1, STEPS + 1) / STEPS


def slide(turn: np.ndarray) -> np.ndarray:
    """Return how far the slider is along its rail (m) at turns of the crank about x from its upright pose."""
    y, z = BEARING[1] - CRANK * np.sin(turn), BEARING[2] + CRANK * np.cos(turn)
    return np.sqrt(ROD**2 - y**2 - z**2)
