"""Rows of many simulations: in turns on one core, processor time of a door, least of several."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import time
from collections.abc import Callable

import numpy as np

import mbsd
from benchmarks.rows import Bar, Row
from benchmarks.simulations import OUTPUTS, PROBLEM, doors, exact, peers
from benchmarks.simulations.mbsd_code import many, study

ROUNDS = 3
FEW, LOT = 200, 8000
BARS = {"study": 20.0, "peer": 5.0}
STEPS = {"mujoco": (0.1, 0.02), "exudyn": (0.1, 0.02)}
TOLERANCES = (1e-4, 1e-7)


def measured() -> tuple[list[Row], list[Bar]]:
    """All rows, and both bars."""
    values = doors(LOT)
    runs: dict[tuple[str, str], tuple[int, Callable[[np.ndarray], object]]] = {
        ("mbsd", f"study, {OUTPUTS} outputs"): (FEW, study),
        ("mbsd", f"simulate_many, {OUTPUTS} outputs"): (LOT, lambda part: many(part, True)),
    }
    for tolerance in TOLERANCES:
        runs["mbsd", f"simulate_many, the end alone, tolerance {tolerance:g}"] = (
            LOT, lambda part, tolerance=tolerance: many(part, False, tolerance)["angle"]
        )  # fmt: skip
    for name in ("mujoco", "exudyn"):
        if importlib.util.find_spec(name) is None:
            continue
        for step in STEPS[name]:
            runs[name, f"the end alone, step {step:g} s"] = (
                FEW, lambda part, step=step, name=name: getattr(peers, name)(part, step)
            )  # fmt: skip
    best, ends = dict.fromkeys(runs, np.inf), {}
    for _ in range(ROUNDS):
        for key, (count, run) in runs.items():
            part = values[:count]
            started = time.process_time()
            ends[key] = run(part)
            best[key] = min(best[key], (time.process_time() - started) / count)
    rows = []
    for (code, settings), seconds in best.items():
        end = ends[code, settings]
        error = float(np.abs(end - exact(values[: len(end)])).max()) if isinstance(end, np.ndarray) else np.nan
        version = mbsd.__version__ if code == "mbsd" else importlib.metadata.version(code)
        rows.append(Row(PROBLEM, code, version, f"{settings}, {1 / seconds:.0f} a second and core", seconds, error))
    return rows, _bars(rows)


def _bars(rows: list[Row]) -> list[Bar]:
    by_study, in_loop = (row.seconds for row in rows[:2])
    ratio = by_study / in_loop
    bars = [Bar(PROBLEM, BARS["study"], ratio, "study", f"{OUTPUTS} outputs", ratio >= BARS["study"])]
    own = [row for row in rows if row.code == "mbsd" and not np.isnan(row.error)]
    for peer in (row for row in rows if row.code != "mbsd"):
        as_good = [row.seconds for row in own if row.error <= peer.error]
        if as_good:
            ratio = peer.seconds / min(as_good)
            words = f"the end alone, error {peer.error:.0e}"
            bars.append(Bar(PROBLEM, BARS["peer"], ratio, peer.code, words, ratio >= BARS["peer"]))
    return bars
