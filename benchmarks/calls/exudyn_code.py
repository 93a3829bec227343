"""Exudyn: SolveStatic with the crank's angle as load, and a kinematic tree by an explicit method; sensors record.

Again is ``Assemble`` and the solver: it puts the system back to its start.
"""

from __future__ import annotations

import itertools
import math
import sys
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks.calls import (
    CHANGED,
    DURATION,
    GRAVITY,
    LENGTH,
    MASS,
    OUTPUTS,
    SIMULATION,
    STEPS,
    SWEEP,
    Call,
    energy_drift,
    rocker_error,
)
from benchmarks.four_bar.exudyn_code import four_bar

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn as exu  # noqa: E402
from exudyn import utilities as u  # noqa: E402

exu.config.printToConsole = False

VERSION = metadata.version("exudyn")


def calls() -> list[Call]:
    """By problem."""
    return [*_sweeps(), _simulation()]


def _settings(steps: int, period: float) -> Any:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period
    settings.staticSolver.numberOfLoadSteps = steps
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.stabilizerODE2term = 1e-6
    settings.staticSolver.newton.useModifiedNewton = False
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = DURATION
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.automaticStepSize = False
    return settings


def _sweeps() -> list[Call]:
    turns, speeds = [1.0], itertools.count()
    system, nodes, (_, _, swing) = four_bar(lambda t: 2 * math.pi * turns[0] * t)
    kind = exu.OutputVariableType.Coordinates
    sensors = [
        system.AddSensor(u.SensorNode(nodeNumber=nodes[k], storeInternal=True, outputVariableType=kind)) for k in (0, 2)
    ]
    settings = _settings(STEPS, 0.5 / STEPS)

    def again() -> list[np.ndarray]:
        system.Assemble()
        system.SolveStatic(settings)
        return [np.array(system.GetSensorStoredData(sensor)) for sensor in sensors]

    def changed() -> list[np.ndarray]:
        turns[0] = 1.0 + 1e-6 * next(speeds)
        return again()

    def error(result: list[np.ndarray]) -> float:
        return rocker_error(result[0][:, 3], result[1][:, 3] + swing)  # sensors give the change against the start

    way = "SolveStatic, full Newton, stabilizer 1e-6, positions only"
    return [Call(SWEEP, f"Assemble, {way}", again, error), Call(CHANGED, f"Assemble, {way}", changed, error)]


def _simulation() -> Call:
    system = exu.SystemContainer().AddSystem()
    node = system.AddNode(
        u.NodeGenericODE2(
            referenceCoordinates=[0.0], initialCoordinates=[0.0], initialCoordinates_t=[0.0], numberOfODE2Coordinates=1
        )
    )
    system.AddObject(
        u.ObjectKinematicTree(
            nodeNumber=node, jointTypes=[exu.JointType.RevoluteZ], linkParents=[-1],
            jointTransformations=exu.Matrix3DList([np.eye(3)]), jointOffsets=exu.Vector3DList([[0, 0, 0]]),
            linkInertiasCOM=exu.Matrix3DList([np.diag([0.0, 0.0, MASS * LENGTH**2 / 12])]),
            linkCOMs=exu.Vector3DList([[LENGTH / 2, 0, 0]]), linkMasses=[MASS], gravity=[0, -GRAVITY, 0],
        )
    )  # fmt: skip
    kinds = (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
    sensors = [
        system.AddSensor(u.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind)) for kind in kinds
    ]
    settings = _settings(OUTPUTS, 0.5 * DURATION / OUTPUTS)

    def again() -> list[np.ndarray]:
        system.Assemble()
        system.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
        return [np.array(system.GetSensorStoredData(sensor))[:, 1] for sensor in sensors]

    return Call(SIMULATION, f"Assemble, tree, RK44, steps {OUTPUTS}", again, lambda result: energy_drift(*result))
