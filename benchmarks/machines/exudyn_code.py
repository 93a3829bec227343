"""Exudyn: its static solver along the driven angle, positions only; the contact on one coordinate.

It has no gears: the ratios of the train are worked out and given to it, so that its system is the smaller one. The pin
in the Geneva's slot is a prismatic joint free to turn, the cam's roller a rod to the centre of the disc.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks import calls, exudyn_systems, machines
from benchmarks.exudyn_systems import GROUND, STATIC, System, exu, u

VERSION = exudyn_systems.VERSION
CONTACT_SOLVER, CONTACT_STEPS, CONTACT_TOLERANCE = "DOPRI5", 100, 1e-7
"""The quickest of its methods that keeps the limit; steps are the fewest that it takes."""


def settings(problem: str) -> str:
    """In words."""
    if problem == machines.CONTACT:
        return f"one coordinate, force by a function, {CONTACT_SOLVER}, tolerance {CONTACT_TOLERANCE:g}"
    return STATIC


def _planetary(system: System) -> str:
    """Add its bodies and joints; return the driven body."""
    for name, x, angle in (
        ("sun", 0, 0), ("carrier", 0, 0), ("planet", calls.CRANK, 0), ("coupler", calls.CRANK, calls.START[0]),
        ("rocker", calls.GROUND, calls.START[1]),
    ):  # fmt: skip
        system.body(name, (x, 0, angle))
    system.pin(GROUND, (0, 0), "sun", (0, 0))
    system.pin(GROUND, (0, 0), "carrier", (0, 0))
    system.pin("carrier", (calls.CRANK, 0), "planet", (0, 0))
    system.pin("carrier", (calls.CRANK, 0), "coupler", (0, 0))
    system.pin("coupler", (calls.COUPLER, 0), "rocker", (calls.ROCKER, 0))
    system.pin(GROUND, (calls.GROUND, 0), "rocker", (0, 0))
    turns = machines.RATIO - machines.SUN / machines.PLANET * (1 - machines.RATIO)
    for name, ratio in (("carrier", machines.RATIO), ("planet", turns)):
        angles = [system.angle("sun"), system.angle(name)]
        system.own.AddObject(u.CoordinateConstraint(markerNumbers=angles, offset=0, factor1=1 / ratio))
    return "sun"


def _geneva(system: System) -> str:
    start = float(machines.exact(machines.GENEVA, np.array([-machines.INDEX]))[0, 0])
    system.body("crank", (0, 0, -machines.INDEX))
    system.body("wheel", (machines.DISTANCE, 0, start))
    system.pin(GROUND, (0, 0), "crank", (0, 0))
    system.pin(GROUND, (machines.DISTANCE, 0), "wheel", (0, 0))
    rigid = [
        system.own.AddMarker(u.MarkerBodyRigid(bodyNumber=system.bodies[name], localPosition=[x, 0, 0]))
        for name, x in (("crank", machines.RADIUS), ("wheel", 0.0))
    ]
    system.own.AddObject(
        u.PrismaticJoint2D(markerNumbers=rigid, axisMarker0=[1, 0, 0], normalMarker1=[0, 1, 0], constrainRotation=False)
    )
    return "crank"


def _cam(system: System) -> str:
    system.body("cam", (0, 0, 0))
    system.body("arm", (machines.PIVOT, 0, float(machines.exact(machines.CAM, np.zeros(1))[0, 0])))
    system.pin(GROUND, (0, 0), "cam", (0, 0))
    system.pin(GROUND, (machines.PIVOT, 0), "arm", (0, 0))
    ends = [system.point("cam", (machines.ECCENTRIC, 0)), system.point("arm", (machines.ARM, 0))]
    system.own.AddObject(u.DistanceConstraint(markerNumbers=ends, distance=machines.DISC))
    return "cam"


SWEEPS = {machines.PLANETARY: _planetary, machines.GENEVA: _geneva, machines.CAM: _cam}


def prepare(problem: str) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` makes one of its own."""
    if problem == machines.CONTACT:
        return _falling()
    first, last = machines.SPAN[problem]
    span = (last - first) * (1 - 1 / machines.STEPS)
    static = exudyn_systems.settings(machines.STEPS)
    recording = exudyn_systems.settings(machines.STEPS, 1 / machines.STEPS)

    def built() -> System:
        system = System()
        system.drive(SWEEPS[problem](system), lambda t: span * t)
        return system

    def fresh() -> Callable[[], Any]:
        system = built()
        system.own.Assemble()
        return lambda: system.own.SolveStatic(static)

    def error(_: Any) -> float:
        system, out = built(), 0.0
        sensors = system.sensors(machines.WATCHED[problem])
        system.own.Assemble()
        system.own.SolveStatic(recording)
        for k, (number, name) in enumerate(zip(sensors, machines.WATCHED[problem], strict=True)):
            rows = system.recorded(number)
            phi = first + span * rows[:, 0]
            out = max(out, machines.worst(rows[:, 3] + system.start[name][2], machines.exact(problem, phi)[:, k]))
        return out

    return fresh, error


def _falling() -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    s = exudyn_systems.settings(CONTACT_STEPS, duration=machines.DURATION)
    s.timeIntegration.automaticStepSize = True
    s.timeIntegration.absoluteTolerance = s.timeIntegration.relativeTolerance = CONTACT_TOLERANCE
    kind = getattr(exu.DynamicSolverType, CONTACT_SOLVER)
    last: list[Any] = []

    def fresh() -> Callable[[], Any]:
        system = exu.SystemContainer().AddSystem()
        node = system.AddNode(u.Node1D(referenceCoordinates=[0.0], initialCoordinates=[machines.HEIGHT]))
        system.AddObject(u.Mass1D(mass=1.0, nodeNumber=node))
        moving = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        base = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=system.AddNode(u.NodePointGround()), coordinate=0))
        system.AddLoad(u.LoadCoordinate(markerNumber=moving, load=-machines.GRAVITY))
        system.AddObject(
            u.CoordinateSpringDamper(
                markerNumbers=[base, moving], stiffness=0.0, damping=0.0,
                springForceUserFunction=lambda mbs, t, item, x, v, k, d, offset: min(machines.STIFFNESS * x, 0.0),
            )
        )  # fmt: skip
        system.Assemble()
        last[:] = [system, node]
        return lambda: system.SolveDynamic(s, solverType=kind)

    def error(_: Any) -> float:
        system, node = last
        coordinates = system.GetNodeOutput(node, exu.OutputVariableType.Coordinates)
        return abs(float(np.ravel(coordinates)[0]) - machines.height(machines.DURATION))

    return fresh, error
