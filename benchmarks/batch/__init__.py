"""Batch: 25 000 four-bar designs x 360 angles in one call, path of a coupler point; error: worst coordinate (m)."""

from __future__ import annotations

import numpy as np

PROBLEM = "25 000 four-bar designs x 360 angles"
DESIGNS, STEPS = 25_000, 360
GROUND, CRANK = 4.0, 1.0
POINT = (1.5, 0.8)
ANGLES = np.arange(STEPS) * 2 * np.pi / STEPS
CODES = ("mbsd", "numpy")
BAR = 25_000.0
"""Designs a second."""


def designs() -> np.ndarray:
    """(n, 2) lengths of coupler and rocker, crank-rockers all."""
    random = np.random.default_rng(7)
    return np.column_stack([random.uniform(3.3, 3.7, DESIGNS), random.uniform(2.8, 3.2, DESIGNS)])


def closed_form(lengths: np.ndarray) -> np.ndarray:
    """(n, T, 2) by numpy, vectorised over designs and angles; positions only."""
    coupler, rocker = lengths[:, :1], lengths[:, 1:]
    bx, by = CRANK * np.cos(ANGLES), CRANK * np.sin(ANGLES)
    dx, dy = GROUND - bx, -by
    square = dx**2 + dy**2
    along = (square + coupler**2 - rocker**2) / (2 * square)
    height = np.sqrt(coupler**2 / square - along**2)
    ux, uy = (along * dx - height * dy) / coupler, (along * dy + height * dx) / coupler
    x, y = POINT
    return np.stack([bx + ux * x - uy * y, by + uy * x + ux * y], axis=-1)
