"""Batch of 25 000 four-bar designs x 360 angles in one call: path of a coupler point.

Error: the worst coordinate (m).
"""

from __future__ import annotations

import os
import time

import numpy as np

import mbsd
from benchmarks.harness import best_in_turns
from benchmarks.rows import Bar, Row
from tools.models import linkages

PROBLEM = "25 000 four-bar designs x 360 angles"
DESIGNS, STEPS = 25_000, 360
GROUND, CRANK = 4.0, 1.0
POINT = (1.5, 0.8)
ANGLES = np.arange(STEPS) * 2 * np.pi / STEPS
CODES = ("mbsd", "numpy")
BAR = 25_000.0
"""Designs a second."""
ROUNDS = 5


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


def model() -> mbsd.Mechanism:
    """The linkage that the designs vary."""
    return linkages.four_bar(GROUND, CRANK, 3.5, 3.0, (60, 100), traced=POINT)


def measured() -> tuple[list[Row], list[Bar]]:
    """Both rows, and the bar."""
    lengths, linkage = designs(), model()
    changes = {"coupler": lengths[:, 0], "rocker": lengths[:, 1]}
    last = 1.0 - 1.0 / STEPS
    calls = lambda: linkage.batch(lengths=changes, duration=last, steps=STEPS - 1), lambda: closed_form(lengths)
    (ours, result), (theirs, exact) = best_in_turns(calls, ROUNDS, time.perf_counter)
    error = float(np.abs(result.points["P"] - exact).max())
    assert result.closes.all()
    assert len(ANGLES) == exact.shape[1]
    rate = DESIGNS / ours
    cores = f"{os.process_cpu_count()} cores"
    rows = [
        Row(PROBLEM, "mbsd", mbsd.__version__, f"m.batch, {cores}, {rate:.0f} designs a second", ours, error),
        Row(
            PROBLEM,
            "numpy",
            np.__version__,
            f"closed form of this four-bar, {DESIGNS / theirs:.0f} a second",
            theirs,
            0.0,
        ),
    ]
    closed = error < 1e-12
    name = f"{PROBLEM}, thousand designs a second"
    return rows, [Bar(name, BAR / 1000, rate / 1000, "", f"on {cores}", closed and rate >= BAR)]
