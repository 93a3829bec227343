"""Rows of the slider-crank with play: ideal, 0.05 and 0.5 mm, without and with friction.

All are timed in turn in one process.

The error is that of the slider's place over the first quarter turn against equations of its own by scipy (m): every
impact makes a difference several times larger, and two turns have some sixty.
"""

from __future__ import annotations

import time

import numpy as np

import mbsd
from benchmarks.harness import best_in_turns
from benchmarks.rows import Bar, Row
from mbsd import Mechanism
from shared.stage.console import say
from tools.models.clearance_slider_crank import CRANK, ROD, SPEED, TURN, reference, slider_crank

ROUNDS = 9
MOST = 50.0
"""How many times the ideal slider-crank's time one with a clearance joint takes at most."""
TOLERANCE = 1e-7
"""The default tolerance of simulate()."""
SLIP = (0.01, 0.1)
CASES = {"ideal": (None, 0.0), "0.05 mm": (0.05e-3, 0.0), "0.5 mm": (0.5e-3, 0.0), "0.5 mm, friction": (0.5e-3, 0.1)}


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows of all cases, and a bar for each with play."""
    machines = {name: _machine(*case) for name, case in CASES.items()}
    calls = [lambda m=m: m.simulate(2.0 * TURN) for m in machines.values()]
    timed = best_in_turns(calls, ROUNDS, time.perf_counter)
    best = dict(zip(machines, (seconds for seconds, _ in timed), strict=True))
    rows, bars = [], []
    for name, m in machines.items():
        problem = f"slider-crank at 5000 rpm, two turns, {name}"
        settings = f"dop853, tolerance {TOLERANCE:g}, {m.simulate(2.0 * TURN).stats.steps} steps"
        rows.append(Row(problem, "mbsd", mbsd.__version__, settings, best[name], _error(m, *CASES[name])))
        if name != "ideal":
            ratio = best[name] / best["ideal"]
            bars.append(Bar(problem, MOST, ratio, "the ideal one", settings, ratio <= MOST, most=True))
    say("bench", "clearance done")
    return rows, bars


def _machine(clearance: float | None, friction: float) -> Mechanism:
    return slider_crank() if clearance is None else slider_crank(clearance, friction=friction, slip_speeds=SLIP)


def _error(m: Mechanism, clearance: float | None, friction: float) -> float:
    sol = m.simulate(0.25 * TURN)
    if clearance is None:
        turn = SPEED * sol.t
        exact = CRANK * np.cos(turn) + np.sqrt(ROD**2 - (CRANK * np.sin(turn)) ** 2)
        return float(np.abs(sol.body("slider").x - exact).max())
    expected = reference(0.25 * TURN, sol.t, clearance, 0.9, friction, SLIP)
    return float(np.abs(sol.body("slider").x - expected[:, 1]).max())
