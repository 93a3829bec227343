"""Rows of engines: sweeps with reactions beside a four-bar's, in turn in one process; the map.

The sweep's error is the largest gap of a joint (m or rad).
"""

from __future__ import annotations

import time

import mbsd
from benchmarks.harness import best_in_turns
from benchmarks.rows import Bar, Row
from mbsd.machines.engines.bank_angles import FAMILIES, all_families
from mbsd.machines.engines.engine import engine
from shared.stage.console import say
from tools.models import linkages

STEPS = 720
ROUNDS = 15
MOST = 25.0
"""How many times the four-bar's time an engine of 25 bodies takes at most."""
MAP_SECONDS = 10.0
SIZE = {"bore": 0.086, "stroke": 0.086, "rod": 0.145, "piston_mass": 0.5, "rod_mass": 0.6, "speed": 300.0}
FOUR_BAR = "a four-bar"


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows of the four-bar and the engines, and of the map; the bars."""
    machines = {FOUR_BAR: four_bar(), "V8": engine("V8", **SIZE), "V12": engine("V12", **SIZE)}
    problem = f"sweep of {STEPS} angles, reactions"
    timed = best_in_turns([lambda m=m: m.sweep(steps=STEPS) for m in machines.values()], ROUNDS, time.perf_counter)
    best = dict(zip(machines, (seconds for seconds, _ in timed), strict=True))
    rows = []
    for name, m in machines.items():
        residual = m.sweep(steps=STEPS).stats.position_residual
        own = f"{name}, {len(m.bodies) - 1} bodies: {problem}"
        rows.append(Row(own, "mbsd", mbsd.__version__, "as it comes", best[name], residual))
    ratio = best["V12"] / best[FOUR_BAR]
    bars = [Bar(rows[-1].problem, MOST, ratio, FOUR_BAR, "as many angles", ratio <= MOST, most=True)]
    begun = time.perf_counter()
    angles = sum(len(family.angle) for family in all_families())
    seconds = time.perf_counter() - begun
    whole = f"map of {len(FAMILIES)} families of V engines, {angles} bank angles"
    rows.append(Row(whole, "mbsd", mbsd.__version__, "one process", seconds, 0.0))
    bars.append(Bar(whole, MAP_SECONDS, seconds, "a second", "one process", seconds <= MAP_SECONDS, most=True))
    say("bench", "engines done")
    return rows, bars


def four_bar() -> mbsd.Mechanism:
    """A crank-rocker with masses."""
    return linkages.four_bar(0.4, 0.1, 0.35, 0.3, (45, 90), masses=(1.0, 1.0, 1.0), law=mbsd.constant_rate(300.0))
