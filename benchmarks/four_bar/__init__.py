"""Four-bar sweep: 1000 crank angles over one turn of a crank-rocker; error: worst coupler or rocker angle (rad).

Exact angles from the triangle crank end, rocker pivot, coupler end.
"""

from __future__ import annotations

import numpy as np

PROBLEM = "four-bar sweep of 1000 angles"
GROUND, CRANK, COUPLER, ROCKER = 4.0, 1.0, 3.5, 3.0
STEPS = 1000
ANGLES = np.arange(STEPS) * 2 * np.pi / STEPS
REPEATS = 40


def exact(phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coupler and rocker angle (rad, open branch) at crank angles phi."""
    bx, by = CRANK * np.cos(phi), CRANK * np.sin(phi)
    dx, dy = GROUND - bx, -by
    diagonal = np.hypot(dx, dy)
    bend = np.arccos((COUPLER**2 + diagonal**2 - ROCKER**2) / (2 * COUPLER * diagonal))
    coupler = np.arctan2(dy, dx) + bend
    cx, cy = bx + COUPLER * np.cos(coupler), by + COUPLER * np.sin(coupler)
    return coupler, np.arctan2(cy, cx - GROUND)


def worst(angle: np.ndarray, wanted: np.ndarray) -> float:
    """Largest difference of two angles, whole turns aside."""
    return float(np.abs(np.angle(np.exp(1j * (angle - wanted)))).max())
