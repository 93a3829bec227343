"""Rows of tolerances: mbsd.tolerances, the closed form with numpy, and a loop with scipy.

Processor time, which other work on the machine disturbs less. The loop takes a sample of the machines and is scaled.
"""

from __future__ import annotations

import math

import numpy as np
import scipy
from scipy.optimize import fsolve

import mbsd
from benchmarks.harness import best_in_turns
from benchmarks.rows import Bar, Row
from mbsd.measures import largest
from tools.models import linkages

COUNT, STEPS, LOOPED = 100_000, 120, 20
GROUND = 0.120
LENGTHS = {"crank": 0.040, "coupler": 0.120, "rocker": 0.090}
TOLERANCE = 5e-5
PROBLEM = f"{COUNT} four-bars within tolerances x {STEPS} steps"
TIME = "processor time"
BAR = 100.0
"""How many times the processor time of mbsd the loop takes at least."""
EXACT = 1e-9
AT_ONCE = 5_000
ROUNDS = 3


def model() -> mbsd.Mechanism:
    """The four-bar as it is drawn."""
    return linkages.four_bar(GROUND, *LENGTHS.values())


def closed_form(lengths: np.ndarray) -> np.ndarray:
    """(n,) largest angle of the rocker of machines with (n, 3) lengths, some thousand at a time."""
    angle = np.linspace(0.0, math.tau, STEPS + 1)
    out = []
    for first in range(0, len(lengths), AT_ONCE):
        crank, coupler, rocker = lengths[first : first + AT_ONCE, :, None].transpose(1, 0, 2)
        dx, dy = GROUND - crank * np.cos(angle), -crank * np.sin(angle)
        square = dx**2 + dy**2
        along = (square + coupler**2 - rocker**2) / (2.0 * square)
        height = np.sqrt(coupler**2 / square - along**2)
        x, y = along * dx - height * dy - dx, along * dy + height * dx - dy
        out.append(np.arctan2(y, x).max(axis=1))
    return np.concatenate(out)


def looped(lengths: np.ndarray) -> np.ndarray:
    """The same, each pose solved from the one before."""
    out = []
    for machine in lengths.tolist():
        pose, most = np.array([0.7, 1.9]), -math.inf
        for angle in np.linspace(0.0, math.tau, STEPS + 1):
            pose = np.asarray(fsolve(_gaps, pose, (float(angle), *machine)))
            most = max(most, float(pose[1]))
        out.append(most)
    return np.array(out)


def _gaps(q: np.ndarray, angle: float, crank: float, coupler: float, rocker: float) -> tuple[float, float]:
    """By how much the loop does not close."""
    return (
        crank * math.cos(angle) + coupler * math.cos(q[0]) - GROUND - rocker * math.cos(q[1]),
        crank * math.sin(angle) + coupler * math.sin(q[0]) - rocker * math.sin(q[1]),
    )


def _ours() -> mbsd.Tolerances:
    return mbsd.tolerances(model(), dict.fromkeys(LENGTHS, TOLERANCE), largest("rocker.theta"), n=COUNT, steps=STEPS)


def measured() -> tuple[list[Row], list[Bar]]:
    """All rows, and the bar."""
    [(ours, t)] = best_in_turns([_ours], ROUNDS)
    lengths = np.array(list(LENGTHS.values())) + t.deviations
    peers = lambda: closed_form(lengths), lambda: looped(lengths[:LOOPED])
    (numpy_time, exact), (loop_time, sample) = best_in_turns(peers, ROUNDS)
    scaled = loop_time * COUNT / LOOPED
    rows = [
        Row(PROBLEM, "mbsd", mbsd.__version__, f"tolerances, {_rate(ours)}; {TIME}", ours, _error(t.values, exact)),
        Row(PROBLEM, "numpy", np.__version__, f"closed form of this four-bar, {_rate(numpy_time)}; {TIME}", numpy_time,
            0.0),
        Row(PROBLEM, "scipy", scipy.__version__, f"fsolve pose by pose, from {LOOPED} machines; {TIME}", scaled,
            _error(sample, exact[:LOOPED])),
    ]  # fmt: skip
    good = rows[0].error < EXACT and scaled / ours >= BAR
    return rows, [Bar(PROBLEM, BAR, scaled / ours, "scipy", rows[2].settings, good)]


def _rate(seconds: float) -> str:
    return f"{COUNT / seconds:.0f} a second"


def _error(values: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(values - exact).max())
