"""Exudyn: rigid bodies in the plane, generalised-alpha or the index-2 trapezoidal rule, fixed steps."""

from __future__ import annotations

import itertools
import sys
import time

import numpy as np

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn  # noqa: E402
from exudyn import itemInterface as items  # noqa: E402

from benchmarks.dynamics.problems import Plain, Problem  # noqa: E402

VERSION = exudyn.__version__


def _candidates(steps: tuple[float, ...], ways: tuple[str, ...] = ("trapezoidal", "alpha")) -> list[dict]:
    return [
        {"method": way, "step": step, "radius": 0.95, "modified_newton": modified}
        for step, way, modified in itertools.product(steps, ways, (True, False))
    ]


CANDIDATES = {
    "A01": _candidates((5e-3, 2e-3, 1e-3, 8e-4, 5e-4)),
    "A02 N=1": _candidates((0.02, 0.01, 0.005, 0.002, 0.001), ("alpha",)),
    "A02 N=10": _candidates((0.01, 0.005, 0.002, 0.001, 0.0005), ("alpha",)),
    "A02 N=40": _candidates((0.005, 0.002, 0.001, 0.0005), ("alpha",)),
    "A03": _candidates((5e-5, 2e-5, 1e-5, 5e-6, 2e-6)),
}


def _build(plain: Plain, sensors: bool):
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    ground = system.AddObject(items.ObjectGround())
    bodies, results = [], []
    for mass, inertia, q, v in zip(plain.mass, plain.inertia, plain.q, plain.v, strict=True):
        if len(plain.mass) == 1:  # the point mass on a rod, as in Exudyn's own example
            node = system.AddNode(items.NodePoint2D(referenceCoordinates=list(q[:2]), initialVelocities=list(v[:2])))
            body = system.AddObject(items.MassPoint2D(physicsMass=mass, nodeNumber=node))
            at = system.AddMarker(items.MarkerNodePosition(nodeNumber=node))
            system.AddLoad(items.Force(markerNumber=at, loadVector=[0, -plain.gravity * mass, 0]))
        else:
            node = system.AddNode(items.NodeRigidBody2D(referenceCoordinates=list(q), initialVelocities=list(v)))
            body = system.AddObject(items.ObjectRigidBody2D(nodeNumber=node, physicsMass=mass, physicsInertia=inertia))
            if plain.gravity:
                at = system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
                system.AddLoad(items.LoadMassProportional(markerNumber=at, loadVector=[0, -plain.gravity, 0]))
        bodies.append(body)
        if sensors:
            for variable in (exudyn.OutputVariableType.Coordinates, exudyn.OutputVariableType.Coordinates_t):
                results.append(
                    system.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=variable))
                )

    def marker(body: int, x: float, y: float):
        number = ground if body < 0 else bodies[body]
        return system.AddMarker(items.MarkerBodyPosition(bodyNumber=number, localPosition=[x, y, 0]))

    for i, xi, yi, j, xj, yj in plain.pins:
        if len(bodies) == 1:
            mass = system.AddMarker(items.MarkerBodyPosition(bodyNumber=bodies[0]))
            system.AddObject(
                items.DistanceConstraint(markerNumbers=[marker(-1, 0.0, 0.0), mass], distance=float(np.hypot(xj, yj)))
            )
        else:
            system.AddObject(items.RevoluteJoint2D(markerNumbers=[marker(i, xi, yi), marker(j, xj, yj)]))
    if plain.torque:
        at = system.AddMarker(items.MarkerBodyRigid(bodyNumber=bodies[plain.torque[0]]))
        system.AddLoad(items.Torque(markerNumber=at, loadVector=[0, 0, plain.torque[1]]))
    if plain.spring:
        i, xi, yi, j, xj, yj, stiffness, length = plain.spring
        system.AddObject(
            items.ObjectConnectorSpringDamper(
                markerNumbers=[marker(i, xi, yi), marker(j, xj, yj)], stiffness=stiffness, referenceLength=length
            )
        )
    system.Assemble()
    return container, system, results


def run(problem: Problem, settings: dict, samples: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """See the package."""
    plain, record = problem.plain, samples > 2
    _container, system, results = _build(plain, True)
    s = exudyn.SimulationSettings()
    s.timeIntegration.numberOfSteps = round(problem.duration / settings["step"])
    s.timeIntegration.endTime = problem.duration
    s.solution.file.write = False
    s.solution.sensors.writePeriod = problem.duration / (samples - 1) if record else problem.duration
    s.timeIntegration.verboseMode = 0
    s.timeIntegration.newton.useModifiedNewton = settings["modified_newton"]
    s.timeIntegration.newton.modifiedNewtonJacUpdatePerStep = True
    if problem.name == "A03":
        s.timeIntegration.newton.relativeTolerance, s.timeIntegration.newton.absoluteTolerance = 1e-9, 1e-11
    s.timeIntegration.generalizedAlpha.spectralRadius = settings["radius"]
    s.timeIntegration.generalizedAlpha.computeInitialAccelerations = True
    s.linearSolver.reuseAnalyzedPattern = True
    if len(plain.mass) > 8:
        s.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    kinds = exudyn.DynamicSolverType
    kind = kinds.TrapezoidalIndex2 if settings["method"] == "trapezoidal" else kinds.GeneralizedAlpha
    started = time.perf_counter()
    done = system.SolveDynamic(s, solverType=kind)
    seconds = time.perf_counter() - started
    data = np.stack([np.array(system.GetSensorStoredData(number)) for number in results])
    if not done or data[0, -1, 0] < problem.duration * (1 - 1e-6):
        raise ArithmeticError(f"stopped at t = {data[0, -1, 0]:g} s")
    count = len(plain.mass)
    q, v = np.zeros((2, data.shape[1], count, 3))
    width = data.shape[2] - 1
    q[..., :width] = data[0::2, :, 1:].transpose(1, 0, 2)
    v[..., :width] = data[1::2, :, 1:].transpose(1, 0, 2)
    q += plain.q if np.abs(q[0] - plain.q).max() > 1e-6 else 0.0  # sensors give displacements
    if width == 2:
        q[..., 2] = 0.0
    return seconds, data[0, :, 0], q, v
