"""Exudyn: its static solver with the crank's angle as load, the fastest of its ways through a sweep; positions only."""

from __future__ import annotations

import math
import sys
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks.four_bar import STEPS, exact, worst
from benchmarks.four_bar.exudyn_model import four_bar

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn as exu  # noqa: E402
from exudyn import utilities as u  # noqa: E402

VERSION = metadata.version("exudyn")
SETTINGS = "SolveStatic, full Newton, stabilizer 1e-6, positions only"
REPEATS = 5
SPAN = 2 * math.pi * (1 - 1 / STEPS)


def _build(record: bool) -> tuple[Any, list[Any], list[float]]:
    """A fresh system at crank angle 0: the static solver starts from its reference pose."""
    system, nodes, angles = four_bar(lambda t: SPAN * t)
    sensors = []
    if record:
        kind = exu.OutputVariableType.Coordinates
        sensors = [
            system.AddSensor(u.SensorNode(nodeNumber=n, storeInternal=True, outputVariableType=kind)) for n in nodes
        ]
    system.Assemble()
    return system, sensors, angles


def _settings(period: float) -> Any:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period
    settings.staticSolver.numberOfLoadSteps = STEPS
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.stabilizerODE2term = 1e-6
    settings.staticSolver.newton.useModifiedNewton = False
    return settings


class _Once:
    """Each run needs a fresh system, whose making is not timed: they wait in a stock."""

    def __init__(self) -> None:
        self.stock = [_build(False)[0] for _ in range(REPEATS + 1)]
        self.settings = _settings(1e9)

    def __call__(self) -> None:
        self.stock.pop().SolveStatic(self.settings)


def _error(_result: None) -> float:
    system, sensors, angles = _build(True)
    system.SolveStatic(_settings(1 / STEPS))
    out = 0.0
    for k in (1, 2):
        rows = np.array(system.GetSensorStoredData(sensors[k]))
        shown = rows[:, 3]
        if abs(shown[0]) < 1e-2:  # the sensor gives the change against the reference pose
            shown = shown + angles[k]
        out = max(out, worst(shown, exact(SPAN * rows[:, 0])[k - 1]))
    return out


def prepare() -> tuple[Any, Any]:
    """``solve`` and ``error`` for measure.py."""
    return _Once(), _error
