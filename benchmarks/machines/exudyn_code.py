"""Exudyn: its static solver along the driven angle, positions only; the contact on one coordinate.

It has no gears: the ratios of the train are worked out and given to it, so that its system is the smaller one. The pin
in the Geneva's slot is a prismatic joint free to turn, the cam's roller a rod to the centre of the disc.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks import four_bar, machines

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn as exu  # noqa: E402
from exudyn import utilities as u  # noqa: E402

exu.config.printToConsole = False
VERSION = metadata.version("exudyn")
CONTACT_SOLVER, CONTACT_STEPS, CONTACT_TOLERANCE = "DOPRI5", 100, 1e-7
"""The quickest of its methods that keeps the limit; steps are the fewest that it takes."""


def settings(problem: str) -> str:
    """In words."""
    if problem == machines.CONTACT:
        return f"one coordinate, force by a function, {CONTACT_SOLVER}, tolerance {CONTACT_TOLERANCE:g}"
    return "SolveStatic, full Newton, stabilizer 1e-6, positions only"


class _Machine:
    """A system at the first angle."""

    def __init__(self, problem: str) -> None:
        self.problem = problem
        self.system = exu.SystemContainer().AddSystem()
        self.ground = self.system.AddObject(u.ObjectGround())
        self.base = self.system.AddMarker(
            u.MarkerNodeCoordinate(nodeNumber=self.system.AddNode(u.NodePointGround()), coordinate=0)
        )
        self.nodes: dict[str, Any] = {}
        self.bodies: dict[str, Any] = {"ground": self.ground}
        self.start: dict[str, float] = {}

    def body(self, name: str, x: float, y: float, angle: float) -> None:
        """With its frame at (x, y)."""
        self.nodes[name] = self.system.AddNode(
            u.NodeRigidBody2D(referenceCoordinates=[x, y, angle], initialVelocities=[0, 0, 0])
        )
        self.bodies[name] = self.system.AddObject(u.RigidBody2D(nodeNumber=self.nodes[name], mass=1.0, inertia=1.0))
        self.start[name] = angle

    def point(self, name: str, x: float, y: float) -> Any:
        """A marker in the axes of a body."""
        return self.system.AddMarker(u.MarkerBodyPosition(bodyNumber=self.bodies[name], localPosition=[x, y, 0]))

    def pin(self, a: str, at: tuple[float, float], b: str, of: tuple[float, float]) -> None:
        """A hinge."""
        self.system.AddObject(u.RevoluteJoint2D(markerNumbers=[self.point(a, *at), self.point(b, *of)]))

    def angle(self, name: str) -> Any:
        """A marker on its angle."""
        return self.system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=self.nodes[name], coordinate=2))

    def drive(self, name: str) -> None:
        """Along the angles of the problem, from 0 to 1 of the load."""
        first, last = machines.SPAN[self.problem]
        span = (last - first) * (1 - 1 / machines.STEPS)
        self.system.AddObject(
            u.CoordinateConstraint(
                markerNumbers=[self.base, self.angle(name)], offset=0,
                offsetUserFunction=lambda mbs, t, item, load: span * t,
            )
        )  # fmt: skip

    def ratio(self, first: str, second: str, factor: float) -> None:
        """Angle of the first is ``factor`` times that of the second."""
        self.system.AddObject(
            u.CoordinateConstraint(markerNumbers=[self.angle(first), self.angle(second)], offset=0, factor1=factor)
        )


def _planetary() -> _Machine:
    made = _Machine(machines.PLANETARY)
    theta, swing = (float(x[0]) for x in four_bar.exact(np.zeros(1)))
    made.body("sun", 0, 0, 0)
    made.body("carrier", 0, 0, 0)
    made.body("planet", four_bar.CRANK, 0, 0)
    made.body("coupler", four_bar.CRANK, 0, theta)
    made.body("rocker", four_bar.GROUND, 0, swing)
    made.pin("ground", (0, 0), "sun", (0, 0))
    made.pin("ground", (0, 0), "carrier", (0, 0))
    made.pin("carrier", (four_bar.CRANK, 0), "planet", (0, 0))
    made.pin("carrier", (four_bar.CRANK, 0), "coupler", (0, 0))
    made.pin("coupler", (four_bar.COUPLER, 0), "rocker", (four_bar.ROCKER, 0))
    made.pin("ground", (four_bar.GROUND, 0), "rocker", (0, 0))
    made.drive("sun")
    made.ratio("sun", "carrier", 1 / machines.RATIO)
    turns = machines.RATIO - machines.SUN / machines.PLANET * (1 - machines.RATIO)
    made.ratio("sun", "planet", 1 / turns)
    return made


def _geneva() -> _Machine:
    made = _Machine(machines.GENEVA)
    made.body("crank", 0, 0, -machines.INDEX)
    made.body("wheel", machines.DISTANCE, 0, float(machines.exact(machines.GENEVA, np.array([-machines.INDEX]))[0, 0]))
    made.pin("ground", (0, 0), "crank", (0, 0))
    made.pin("ground", (machines.DISTANCE, 0), "wheel", (0, 0))
    rigid = [
        made.system.AddMarker(u.MarkerBodyRigid(bodyNumber=made.bodies[name], localPosition=[x, 0, 0]))
        for name, x in (("crank", machines.RADIUS), ("wheel", 0.0))
    ]
    made.system.AddObject(
        u.PrismaticJoint2D(markerNumbers=rigid, axisMarker0=[1, 0, 0], normalMarker1=[0, 1, 0], constrainRotation=False)
    )
    made.drive("crank")
    return made


def _cam() -> _Machine:
    made = _Machine(machines.CAM)
    made.body("cam", 0, 0, 0)
    made.body("arm", machines.PIVOT, 0, float(machines.exact(machines.CAM, np.zeros(1))[0, 0]))
    made.pin("ground", (0, 0), "cam", (0, 0))
    made.pin("ground", (machines.PIVOT, 0), "arm", (0, 0))
    made.system.AddObject(
        u.DistanceConstraint(
            markerNumbers=[made.point("cam", machines.ECCENTRIC, 0), made.point("arm", machines.ARM, 0)],
            distance=machines.DISC,
        )
    )
    made.drive("cam")
    return made


SWEEPS = {machines.PLANETARY: _planetary, machines.GENEVA: _geneva, machines.CAM: _cam}
WATCHED = {machines.PLANETARY: ("coupler", "rocker"), machines.GENEVA: ("wheel",), machines.CAM: ("arm",)}


def prepare(problem: str) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` makes one of its own."""
    if problem == machines.CONTACT:
        return _falling()
    static = exu.SimulationSettings()
    static.solution.file.write = False
    static.parallel.numberOfThreads = 1
    static.staticSolver.numberOfLoadSteps = machines.STEPS
    static.staticSolver.verboseMode = 0
    static.staticSolver.stabilizerODE2term = 1e-6
    static.staticSolver.newton.useModifiedNewton = False
    static.solution.sensors.writePeriod = 1e9

    def fresh() -> Callable[[], Any]:
        made = SWEEPS[problem]()
        made.system.Assemble()
        return lambda: made.system.SolveStatic(static)

    def error(_: Any) -> float:
        made, out = SWEEPS[problem](), 0.0
        kind = exu.OutputVariableType.Coordinates
        sensors = [
            made.system.AddSensor(u.SensorNode(nodeNumber=made.nodes[n], storeInternal=True, outputVariableType=kind))
            for n in WATCHED[problem]
        ]
        made.system.Assemble()
        static.solution.sensors.writePeriod = 1 / machines.STEPS
        made.system.SolveStatic(static)
        static.solution.sensors.writePeriod = 1e9
        first, last = machines.SPAN[problem]
        for k, (sensor, name) in enumerate(zip(sensors, WATCHED[problem], strict=True)):
            rows = np.array(made.system.GetSensorStoredData(sensor))
            phi = first + (last - first) * (1 - 1 / machines.STEPS) * rows[:, 0]
            out = max(out, machines.worst(rows[:, 3] + made.start[name], machines.exact(problem, phi)[:, k]))
        return out

    return fresh, error


def _falling() -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    s = exu.SimulationSettings()
    s.solution.file.write = False
    s.parallel.numberOfThreads = 1
    s.solution.sensors.writePeriod = 1e9
    s.timeIntegration.numberOfSteps = CONTACT_STEPS
    s.timeIntegration.endTime = machines.DURATION
    s.timeIntegration.automaticStepSize = True
    s.timeIntegration.absoluteTolerance = s.timeIntegration.relativeTolerance = CONTACT_TOLERANCE
    s.timeIntegration.verboseMode = 0
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
