"""A four-bar under a motor's curve that comes to rest at a stop: in a study, in many, alone."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import mbsd
from benchmarks.rows import Bar, Row
from mbsd.measures import final, largest, smallest
from tools.models.stops import barrier

PROBLEM = "many four-bars between stops, 2 s each"
DURATION = 2.0
ROUNDS = 4
FEW, LOT = 20, 1000
MOST = 3.0
"""Times of a row that a call of simulate may take, with few outputs."""


def build(damping: float) -> mbsd.Mechanism:
    """One of them."""
    return barrier(True, damping)


def study(values: np.ndarray, outputs: int) -> np.ndarray:
    """Return (n, 3) angle at the end, largest force, fastest rebound.

    Each is built, simulated and measured by Python.
    """

    def measure(m: mbsd.Mechanism) -> dict[str, float]:
        sol = m.simulate(DURATION, steps=outputs)
        return {
            "angle": float(sol.body("rocker").theta[-1]),
            "force": float(sol.joint("D").fy.max()),
            "back": float(sol.body("rocker").omega.min()),
        }

    points = [{"damping": value} for value in values.tolist()]
    made = mbsd.study(build, points, measure, folder=None, processes=1, progress=False)
    return np.column_stack([made["angle"], made["force"], made["back"]])


def many(values: np.ndarray, outputs: int) -> np.ndarray:
    """The same in the compiled loop."""
    measures: dict[str, Any] = {
        "angle": final("rocker.theta"),
        "force": largest("D.fy"),
        "back": smallest("rocker.omega"),
    }
    made = build(0.4).simulate_many(
        DURATION, vary={"spring": {"damping": values}}, measure=measures, steps=outputs, threads=1
    )
    return np.column_stack([made["angle"], made["force"], made["back"]])


def measured() -> tuple[list[Row], list[Bar]]:
    """Return rows with few and many outputs, and their bars.

    Error: the largest difference from the study's numbers.
    """
    values = np.linspace(0.1, 0.8, LOT)
    some = values[:: LOT // FEW]
    rows, bars = [], []
    for outputs in (20, 200):
        best = [np.inf] * 3
        error = np.nan
        single = build(0.4)
        for _ in range(ROUNDS):
            times = [time.process_time()]
            alone = study(some, outputs)
            times.append(time.process_time())
            together = many(values, outputs)
            times.append(time.process_time())
            for _ in range(LOT // 10):
                single.simulate(DURATION, steps=outputs)
            times.append(time.process_time())
            spans = np.diff(times) / (len(some), LOT, LOT // 10)
            best = np.minimum(best, spans).tolist()
            error = float(np.abs(together[:: LOT // FEW] - alone).max())
        names = ("study", np.nan), ("simulate_many", error), ("simulate", np.nan)
        for (name, off), seconds in zip(names, best, strict=True):
            words = f"{name}, {outputs} outputs, {1 / seconds:.0f} a second and core"
            rows.append(Row(PROBLEM, "mbsd", mbsd.__version__, words, seconds, off))
        if outputs == FEW:
            ratio = best[2] / best[1]
            bars.append(Bar(PROBLEM, MOST, ratio, "a row", f"{outputs} outputs, simulate", ratio <= MOST, most=True))
    return rows, bars
