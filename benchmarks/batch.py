"""Rows of the batch: mbsd's m.batch on all cores, and the closed form written out for the four-bar with numpy."""

from __future__ import annotations

import os
import time

import numpy as np

import mbsd
from benchmarks.batch import ANGLES, BAR, CRANK, DESIGNS, GROUND, POINT, PROBLEM, STEPS, closed_form, designs
from benchmarks.rows import Bar, Row

ROUNDS = 5


def model() -> mbsd.Mechanism:
    """The linkage that the designs vary."""
    m = mbsd.Mechanism("designs")
    crank, coupler, rocker = m.bar("crank", CRANK), m.bar("coupler", 3.5), m.bar("rocker", 3.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(GROUND, 0), rocker.start)
    m.drive_angle("motor", crank, mbsd.constant_rate(2 * np.pi))
    m.trace("P", coupler.at(*POINT))
    m.start_near(crank=0, coupler=60, rocker=100)
    return m


def measured() -> tuple[list[Row], list[Bar]]:
    """Both rows, and the bar."""
    lengths, linkage = designs(), model()
    changes = {"coupler": lengths[:, 0], "rocker": lengths[:, 1]}
    last = 1.0 - 1.0 / STEPS
    ours = theirs = float("inf")
    exact = closed_form(lengths)
    result = linkage.batch(lengths=changes, duration=last, steps=STEPS - 1)
    for _ in range(ROUNDS):
        started = time.perf_counter()
        result = linkage.batch(lengths=changes, duration=last, steps=STEPS - 1)
        ours = min(ours, time.perf_counter() - started)
        started = time.perf_counter()
        exact = closed_form(lengths)
        theirs = min(theirs, time.perf_counter() - started)
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
