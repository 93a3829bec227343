"""Rows of many simulations, in turns: processor and wall time of a door, on one and two threads."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import resource
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import mbsd
from benchmarks.rows import Bar, Row
from benchmarks.simulations import OUTPUTS, PROBLEM, doors, exact, peers, single, stops
from benchmarks.simulations.mbsd_code import END, WHEN, many, study, study_in_loop

ROUNDS = 3
FEW, LOT = 200, 100_000
"""Doors of what takes a millisecond and more, and the number that is asked of mbsd."""
BARS = {"study": 20.0, "peer": 5.0}
STEPS = (0.1, 0.02)
TOLERANCES = (1e-4, 1e-7)
SCIPY_TOLERANCES = (1e-6, 1e-9)
BOTH = (1, 2)
"""Threads, or processes where a code takes these."""


class Case(NamedTuple):
    """One code in one way."""

    code: str
    settings: str
    threads: int
    doors: int
    run: Callable[[np.ndarray], object]


def cases() -> list[Case]:
    """All of them; the study that makes each by itself is first, the loop with its measures second."""
    out = [Case("mbsd", f"study, {OUTPUTS} outputs", 1, FEW, study)]
    whole = {**WHEN, **END}
    for n in BOTH:
        out.append(
            Case("mbsd", f"simulate_many, {OUTPUTS} outputs", n, LOT, lambda part, n=n: many(part, whole, threads=n))
        )
    for n in BOTH:
        settings = "simulate_many, outputs until it is shut"
        out.append(Case("mbsd", settings, n, LOT, lambda part, n=n: many(part, WHEN, threads=n)))
        settings = "study with simulated, outputs until it is shut"
        out.append(Case("mbsd", settings, n, LOT, lambda part, n=n: study_in_loop(part, n)))
        for tolerance in TOLERANCES:
            settings = f"simulate_many, the end alone, tolerance {tolerance:g}"
            end = lambda part, n=n, tolerance=tolerance: many(part, END, tolerance, n)["angle"]  # noqa: E731
            out.append(Case("mbsd", settings, n, LOT, end))
        for name, count in (("mujoco", 5 * FEW), ("exudyn", 10 * FEW)):
            if importlib.util.find_spec(name) is None:
                continue
            way = {"mujoco": "rollout", "exudyn": "ParameterVariation"}[name]
            for step in STEPS:
                run = lambda part, step=step, n=n, name=name: getattr(peers, name)(part, step, n)  # noqa: E731
                out.append(Case(name, f"{way}, the end alone, step {step:g} s", n, count, run))
    for tolerance in SCIPY_TOLERANCES:
        run = lambda part, tolerance=tolerance: peers.scipy(part, tolerance)  # noqa: E731
        out.append(Case("scipy", f"solve_ivp one by one, tolerance {tolerance:g}", 1, FEW, run))
    return out


def measured() -> tuple[list[Row], list[Bar]]:
    """All rows, and all bars, by processor time."""
    values, every = doors(LOT), cases()
    wall, own = np.full((2, len(every)), np.inf)
    ends: list[object] = [None] * len(every)
    for _ in range(ROUNDS):
        for k, case in enumerate(every):
            part = values[: case.doors]
            began, busy = time.perf_counter(), processor_time()
            ends[k] = case.run(part)
            wall[k] = min(wall[k], (time.perf_counter() - began) / case.doors)
            own[k] = min(own[k], (processor_time() - busy) / case.doors)
    rows = [_row(case, float(own[k]), float(wall[k]), ends[k], values) for k, case in enumerate(every)]
    stopped, bars = stops.measured()
    alone, more = single.measured()
    return rows + stopped + alone, _bars(rows, every) + bars + more


def processor_time() -> float:
    """s of this process and of those it has waited for."""
    return sum(
        use.ru_utime + use.ru_stime for use in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


def _row(case: Case, own: float, wall: float, end: object, values: np.ndarray) -> Row:
    error = float(np.abs(end - exact(values[: len(end)])).max()) if isinstance(end, np.ndarray) else np.nan
    version = mbsd.__version__ if case.code == "mbsd" else importlib.metadata.version(case.code)
    threads = f"{case.threads} thread{'s' * (case.threads > 1)}"
    settings = (
        f"{case.settings}, {threads}: {1 / own:.0f} a second of a core, {1 / wall:.0f} by the clock at a load of "
        f"{os.getloadavg()[0]:.1f}"
    )
    return Row(PROBLEM, case.code, version, settings, own, error)


def _bars(rows: list[Row], every: list[Case]) -> list[Bar]:
    ratio = rows[0].seconds / rows[1].seconds
    bars = [Bar(PROBLEM, BARS["study"], ratio, "study", f"{OUTPUTS} outputs", ratio >= BARS["study"])]
    alone = [row for row, case in zip(rows, every, strict=True) if case.threads == 1 and not np.isnan(row.error)]
    for peer in (row for row in alone if row.code != "mbsd"):
        as_good = [row.seconds for row in alone if row.code == "mbsd" and row.error <= peer.error]
        if as_good:
            ratio = peer.seconds / min(as_good)
            words = f"the end alone, error {peer.error:.0e}"
            bars.append(Bar(PROBLEM, BARS["peer"], ratio, peer.code, words, ratio >= BARS["peer"]))
    return bars
