"""Path synthesis: a four-bar whose coupler point passes through four points.

Any pivots and lengths within bounds are allowed.

The points are of a known four-bar, so an exact design exists. The error is the largest distance (m) of a point from the
path, taken from a sweep by mbsd of each code's design; times are of the processor, which other programs do not change.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from importlib import metadata
from typing import Any

import numpy as np

import mbsd
from benchmarks.harness import best_in_turns
from benchmarks.rows import Bar, Row
from mbsd.synthesis.target import feet, places_at

PROBLEM = "four-bar through four points, from a known one"
POINTS = np.array(
    [(0.22902721, 0.23877409), (0.23830146, 0.28944367), (0.11430643, 0.25583701), (0.04107749, 0.16811844)]
)
"""m; the first of the start, then each 67.5 degrees of the crank."""
STEPS = 3600
"""Number of steps of the sweep that gives the error."""
BAR = 1.5
"""How many times the processor time of mbsd pylinkage takes at least."""
EXACT = 1e-9
TIME = "; processor time"
ROUNDS = 3
VARY = {
    "crank": (0.05, 0.2),
    "coupler": (0.2, 0.5),
    "rocker": (0.2, 0.5),
    "A": ((-0.1, 0.1), (-0.1, 0.1)),
    "D": ((0.2, 0.6), (-0.1, 0.1)),
    "P": ((0.0, 0.4), (-0.2, 0.2)),
}


def four_bar(lengths: Sequence[float], a: Any, d: Any, p: Any, start: dict[str, float]) -> mbsd.Mechanism:
    """Crank, coupler and rocker on the pivots a and d; p in the coupler's frame (m), start in degrees."""
    m = mbsd.Mechanism("path")
    crank, coupler, rocker = (m.bar(name, n) for name, n in zip(("crank", "coupler", "rocker"), lengths, strict=True))
    m.revolute("A", m.ground.at(*a), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(*d), rocker.start)
    m.drive_angle("motor", crank, mbsd.constant_rate(math.tau))
    m.trace("P", coupler.at(*p))
    m.start_near(**start)
    return m


def error(m: mbsd.Mechanism) -> float:
    """Largest distance (m) of a point from the path of P."""
    point = m.sweep(steps=STEPS).point("P")
    path = np.column_stack([point.x, point.y])
    return float(np.hypot(*(places_at(path, feet(path, POINTS, True), True) - POINTS).T).max())


def _ours() -> mbsd.Mechanism:
    start = {"crank": 0.0, "coupler": 45.0, "rocker": 90.0}
    m = four_bar((0.1, 0.38, 0.3), (0.0, 0.0), (0.4, 0.02), (0.2, 0.1), start)
    return mbsd.fit_path(m, POINTS, VARY, starts=1).mechanism


def _theirs() -> list[Any]:
    from pylinkage.synthesis import path_generation

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        solutions = path_generation([(float(x), float(y)) for x, y in POINTS], max_solutions=1)
    return solutions.raw_solutions


def as_mechanism(design: Any) -> mbsd.Mechanism:
    """A design of pylinkage, driven from the pose that it gives to the next whole turn."""
    a, b, c, d, p = (
        np.array(place, float)
        for place in (
            design.ground_pivot_a,
            design.crank_pivot_b,
            design.coupler_pivot_c,
            design.ground_pivot_d,
            design.coupler_point,
        )
    )
    along = (c - b) / np.hypot(*(c - b))
    on_coupler = along @ (p - b), along[0] * (p - b)[1] - along[1] * (p - b)[0]
    lengths = [float(np.hypot(*line)) for line in (b - a, c - b, c - d)]
    turns = [math.atan2(*line[::-1]) for line in (b - a, c - b, c - d)]
    start = dict(zip(("crank", "coupler", "rocker"), map(math.degrees, turns), strict=True))
    m = four_bar(lengths, a, d, on_coupler, start)
    m.drivers.clear()
    m.drive_angle("motor", m.bodies["crank"], mbsd.constant_rate(math.tau, start=turns[0]))
    return m


def measured() -> tuple[list[Row], list[Bar]]:
    """Both rows, and the bar."""
    (ours, mechanism), (theirs, designs) = best_in_turns([_ours, _theirs], ROUNDS)
    errors = [error(as_mechanism(design)) for design in designs]
    rows = [
        Row(PROBLEM, "mbsd", mbsd.__version__, f"fit_path, one start, nine numbers free{TIME}", ours, error(mechanism)),
        Row(
            PROBLEM, "pylinkage", metadata.version("pylinkage"), f"path_generation, its first solution{TIME}", theirs,
            min(errors, default=math.inf),
        ),
    ]  # fmt: skip
    good = rows[0].error < EXACT and theirs / ours >= BAR
    return rows, [Bar(PROBLEM, BAR, theirs / ours, "pylinkage", rows[1].settings, good)]
