"""Exudyn: rigid bodies with pin constraints and implicit integrators.

The pendulum has two shorter ways.

The pendulum as a point mass on a distance constraint, which is Exudyn's own example of A01, or as a kinematic tree of
one hinge, which has no constraint and so allows the explicit integrators.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from benchmarks import exudyn_systems
from benchmarks.dynamics.cases import Case
from benchmarks.dynamics.pins import Record
from benchmarks.dynamics.settings import steps_of
from benchmarks.exudyn_systems import System, exu, hinge, sensor, u

VERSION = exudyn_systems.VERSION
SAMPLES = 1000


def ladders(case: Case) -> Iterator[list[dict[str, Any]]]:
    """Settings to try, each ladder from cheap to exact."""
    if case.name.startswith("A01"):
        for solver, first in (("RK67", 20), ("RK44", 100), ("VelocityVerlet", 500)):
            yield [{"model": "tree", "solver": solver, "steps": n} for n in steps_of(first, 20000)]
        for solver in ("GeneralizedAlpha", "TrapezoidalIndex2"):
            yield [
                {"model": "distance", "solver": solver, "steps": n, "rho": 1.0 if solver[0] == "T" else 0.95}
                for n in steps_of(2000, 40000)
            ]
        return
    large = len(case.model.solids) > 8  # where a run takes seconds, what was worst on the small ones is left out
    linear, first, last, ratio = ("EigenSparse", 1500, 10_000, 1.25) if large else ("EXUdense", 1000, 20_000, 1.15)
    for newton in ("each step", "full"):
        for solver, rho in (("GeneralizedAlpha", 0.95), ("GeneralizedAlpha", 0.8), ("TrapezoidalIndex2", 1.0)):
            if large and rho != 0.95:
                continue
            for tolerance in (1e-5, 1e-8) if case.name.startswith("A02") else (1e-8, 1e-10):
                yield [
                    {"model": "pins", "solver": solver, "rho": rho, "newton": newton, "linear": linear,
                     "tolerance": tolerance, "steps": n}
                    for n in steps_of(first, last, ratio)
                ]  # fmt: skip


def prepare(case: Case, settings: dict[str, Any]) -> tuple[Callable[[], Callable[[], Any]], Callable[[], Record]]:
    """``fresh`` gives a run that starts anew, whose making is not timed; ``record`` what it computes."""
    kind = getattr(exu.DynamicSolverType, settings["solver"])
    build = {"pins": _pins, "distance": _distance, "tree": _tree}[settings["model"]]

    def fresh(period: float = 1e9) -> Callable[[], Any]:
        system = build(case, False)[0]
        chosen = _settings(case, settings, period)
        return lambda: system.SolveDynamic(chosen, solverType=kind)

    def record() -> Record:
        system, read = build(case, True)
        chosen = _settings(case, settings, case.duration / min(SAMPLES, settings["steps"]))
        with contextlib.suppress(exu.SolverError):  # where it gives up, the record ends before the time does
            system.SolveDynamic(chosen, solverType=kind)
        return read()

    return fresh, record


def _settings(case: Case, settings: dict[str, Any], period: float) -> Any:
    s = exudyn_systems.settings(settings["steps"], period, case.duration)
    s.timeIntegration.adaptiveStep = False
    s.timeIntegration.generalizedAlpha.spectralRadius = settings.get("rho", 0.9)
    newton = settings.get("newton", "each step")
    s.timeIntegration.newton.useModifiedNewton = newton != "full"
    s.timeIntegration.newton.modifiedNewtonJacUpdatePerStep = newton == "each step"
    tolerance = settings.get("tolerance", 1e-8)
    s.timeIntegration.newton.relativeTolerance = tolerance
    s.timeIntegration.newton.absoluteTolerance = tolerance * 1e-2
    s.linearSolver.solverType = getattr(exu.LinearSolverType, settings.get("linear", "EXUdense"))
    s.linearSolver.reuseAnalyzedPattern = True
    return s


Built = tuple[Any, Callable[[], Record]]


def _pins(case: Case, recorded: bool) -> Built:
    system, model = System(), case.model
    own = system.own
    for key, solid in enumerate(model.solids):
        system.body(key, solid.pose, solid.mass, solid.inertia, solid.velocity)
        if model.gravity:
            mass = own.AddMarker(u.MarkerBodyMass(bodyNumber=system.bodies[key]))
            own.AddLoad(u.LoadMassProportional(markerNumber=mass, loadVector=[0, -model.gravity, 0]))
    for p in model.pins:
        system.pin(p.i, p.a, p.j, p.b)
    for body, torque in model.torques:
        turned = own.AddMarker(u.MarkerBodyRigid(bodyNumber=system.bodies[body]))
        own.AddLoad(u.Torque(markerNumber=turned, loadVector=[0, 0, torque]))
    for s in model.springs:
        ends = [system.point(s.i, s.a), system.point(s.j, s.b)]
        own.AddObject(u.SpringDamper(markerNumbers=ends, stiffness=s.stiffness, referenceLength=s.length))
    keys = range(len(model.solids)) if recorded else ()
    places, speeds = (system.sensors(keys, kind) for kind in ("Coordinates", "Coordinates_t"))
    own.Assemble()

    def read() -> Record:
        change, velocities = (np.stack([system.recorded(k) for k in of], axis=1) for of in (places, speeds))
        return Record(change[:, 0, 0], change[:, :, 1:4] + model.start[0], velocities[:, :, 1:4])

    return own, read


def _distance(case: Case, recorded: bool) -> Built:
    system = exu.SystemContainer().AddSystem()
    (solid,) = case.model.solids
    node = system.AddNode(u.NodePoint2D(referenceCoordinates=list(solid.pose[:2])))
    system.AddObject(u.MassPoint2D(mass=solid.mass, nodeNumber=node))
    place = system.AddMarker(u.MarkerNodePosition(nodeNumber=node))
    pivot = system.AddMarker(u.MarkerBodyPosition(bodyNumber=system.AddObject(u.ObjectGround())))
    length = -case.model.pins[0].b[0]
    system.AddObject(u.DistanceConstraint(markerNumbers=[pivot, place], distance=length))
    system.AddLoad(u.Force(markerNumber=place, loadVector=[0, -solid.mass * case.model.gravity, 0]))
    sensors = [sensor(system, node, kind) for kind in ("Coordinates", "Coordinates_t") if recorded]
    system.Assemble()

    def read() -> Record:
        change, velocity = (np.array(system.GetSensorStoredData(k)) for k in sensors)
        poses, velocities = np.zeros((2, len(change), 1, 3))
        poses[:, 0, :2] = change[:, 1:3] + solid.pose[:2]
        velocities[:, 0, :2] = velocity[:, 1:3]
        return Record(change[:, 0], poses, velocities)

    return system, read


def _tree(case: Case, recorded: bool) -> Built:
    system = exu.SystemContainer().AddSystem()
    (solid,) = case.model.solids
    length = -case.model.pins[0].b[0]
    node = hinge(system, length, solid.mass, 0.0, case.model.gravity, solid.pose[2])
    sensors = [sensor(system, node, kind) for kind in ("Coordinates", "Coordinates_t") if recorded]
    system.Assemble()

    def read() -> Record:
        angle, speed = (np.array(system.GetSensorStoredData(k)) for k in sensors)
        theta, omega = angle[:, 1], speed[:, 1]
        c, s = length * np.cos(theta), length * np.sin(theta)
        poses, velocities = np.stack([c, s, theta], axis=1), np.stack([-s * omega, c * omega, omega], axis=1)
        return Record(angle[:, 0], poses[:, None], velocities[:, None])

    return system, read
