"""Exudyn: its static solver with the crank's angle as load, the fastest of its ways through a sweep; positions only."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks.four_bar import COUPLER, CRANK, GROUND, ROCKER, STEPS, exact, worst

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn as exu  # noqa: E402
from exudyn import utilities as u  # noqa: E402

VERSION = metadata.version("exudyn")
SETTINGS = "SolveStatic, full Newton, stabilizer 1e-6, positions only"
REPEATS = 5
SPAN = 2 * math.pi * (1 - 1 / STEPS)


def four_bar(law: Callable[[float], float]) -> tuple[Any, list[Any], list[float]]:
    """A system at crank angle 0, not yet assembled; the nodes of crank, coupler and rocker, and their angles (rad).

    ``law``: angle of the crank (rad) at a time or load factor.
    """
    theta, swing = (float(x[0]) for x in exact(np.zeros(1)))
    system = exu.SystemContainer().AddSystem()
    bodies, nodes, angles = [], [], [0.0, theta, swing]
    for x, angle, length in ((0.0, 0.0, CRANK), (CRANK, theta, COUPLER), (GROUND, swing, ROCKER)):
        pose = [x + length / 2 * math.cos(angle), length / 2 * math.sin(angle), angle]
        nodes.append(system.AddNode(u.NodeRigidBody2D(referenceCoordinates=pose, initialVelocities=[0, 0, 0])))
        bodies.append(system.AddObject(u.RigidBody2D(nodeNumber=nodes[-1], mass=length, inertia=length**3 / 12)))
    ground = system.AddObject(u.ObjectGround())

    def marker(body: Any, x: float) -> Any:
        return system.AddMarker(u.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0, 0]))

    for pair in (
        (marker(ground, 0.0), marker(bodies[0], -CRANK / 2)),
        (marker(bodies[0], CRANK / 2), marker(bodies[1], -COUPLER / 2)),
        (marker(bodies[1], COUPLER / 2), marker(bodies[2], ROCKER / 2)),
        (marker(ground, GROUND), marker(bodies[2], -ROCKER / 2)),
    ):
        system.AddObject(u.RevoluteJoint2D(markerNumbers=list(pair)))
    fixed = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=system.AddNode(u.NodePointGround()), coordinate=0))
    driven = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=2))
    system.AddObject(
        u.CoordinateConstraint(
            markerNumbers=[fixed, driven], offset=0, offsetUserFunction=lambda mbs, t, item, load: law(t)
        )
    )
    return system, nodes, angles


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
