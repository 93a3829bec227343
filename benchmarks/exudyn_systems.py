"""Systems of Exudyn that benchmarks share: bodies on pins, a hinge as a tree, sensors, settings."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from importlib import metadata
from typing import Any

import numpy as np

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn as exu  # noqa: E402
from exudyn import utilities as u  # noqa: E402

exu.config.printToConsole = False

VERSION = metadata.version("exudyn")
STATIC = "SolveStatic, full Newton, stabilizer 1e-6, positions only"
GROUND = -1
Place = Sequence[float]


class System:
    """A system in the making; bodies by a key, ``GROUND`` among them.

    Sensors give changes against the start.
    """

    def __init__(self) -> None:
        self.own = exu.SystemContainer().AddSystem()
        self.bodies: dict[Any, Any] = {GROUND: self.own.AddObject(u.ObjectGround())}
        self.nodes: dict[Any, Any] = {}
        self.start: dict[Any, np.ndarray] = {}
        self._base: Any = None

    def body(self, key: Any, pose: Place, mass: float = 1.0, inertia: float = 1.0, velocity: Place = (0, 0, 0)) -> None:
        """Add a body whose frame is at ``pose`` (m, m, rad)."""
        self.nodes[key] = self.own.AddNode(
            u.NodeRigidBody2D(referenceCoordinates=list(pose), initialVelocities=list(velocity))
        )
        self.bodies[key] = self.own.AddObject(u.RigidBody2D(nodeNumber=self.nodes[key], mass=mass, inertia=inertia))
        self.start[key] = np.array(pose)

    def point(self, key: Any, place: Place) -> Any:
        """Return a marker in the axes of a body."""
        return self.own.AddMarker(u.MarkerBodyPosition(bodyNumber=self.bodies[key], localPosition=[*place, 0]))

    def pin(self, first: Any, place: Place, second: Any, other: Place) -> None:
        """Add a hinge between a place on one body and a place on another."""
        self.own.AddObject(u.RevoluteJoint2D(markerNumbers=[self.point(first, place), self.point(second, other)]))

    def angle(self, key: Any) -> Any:
        """Return a marker on the angle of a body."""
        return self.own.AddMarker(u.MarkerNodeCoordinate(nodeNumber=self.nodes[key], coordinate=2))

    def base(self) -> Any:
        """Return a marker on a coordinate of the ground."""
        if self._base is None:
            ground = self.own.AddNode(u.NodePointGround())
            self._base = self.own.AddMarker(u.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        return self._base

    def drive(self, key: Any, law: Callable[[float], float]) -> None:
        """Turn a body by ``law``: its angle (rad) at a time or load factor."""
        self.own.AddObject(
            u.CoordinateConstraint(
                markerNumbers=[self.base(), self.angle(key)], offset=0,
                offsetUserFunction=lambda mbs, t, item, load: law(t),
            )
        )  # fmt: skip

    def sensors(self, keys: Iterable[Any], kind: str = "Coordinates") -> list[Any]:
        """Return sensors that record coordinates of bodies, or other numbers of their nodes."""
        return [sensor(self.own, self.nodes[key], kind) for key in keys]

    def recorded(self, number: Any) -> np.ndarray:
        """Return what a sensor has recorded: (T, 1 + k) times and numbers."""
        return np.array(self.own.GetSensorStoredData(number))


def sensor(system: Any, node: Any, kind: str = "Coordinates") -> Any:
    """Return a sensor that records numbers of a node."""
    output = getattr(exu.OutputVariableType, kind)
    return system.AddSensor(u.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=output))


def hinge(system: Any, centre: float, mass: float, inertia: float, gravity: float, angle: float = 0.0) -> Any:
    """Return the node of a body on one hinge, a kinematic tree.

    Its centre of mass is ``centre`` (m) from the hinge.
    """
    node = system.AddNode(
        u.NodeGenericODE2(
            referenceCoordinates=[0.0], initialCoordinates=[angle], initialCoordinates_t=[0.0],
            numberOfODE2Coordinates=1,
        )
    )  # fmt: skip
    system.AddObject(
        u.ObjectKinematicTree(
            nodeNumber=node, jointTypes=[exu.JointType.RevoluteZ], linkParents=[-1],
            jointTransformations=exu.Matrix3DList([np.eye(3)]), jointOffsets=exu.Vector3DList([[0, 0, 0]]),
            linkInertiasCOM=exu.Matrix3DList([np.diag([0.0, 0.0, inertia])]),
            linkCOMs=exu.Vector3DList([[centre, 0, 0]]), linkMasses=[mass], gravity=[0, -gravity, 0],
        )
    )  # fmt: skip
    return node


def settings(steps: int, period: float = 1e9, duration: float = 1.0) -> Any:
    """Return settings of one thread that write no file; sensors record every ``period`` (s)."""
    chosen = exu.SimulationSettings()
    chosen.solution.file.write = False
    chosen.solution.sensors.writePeriod = period
    chosen.parallel.numberOfThreads = 1
    chosen.staticSolver.numberOfLoadSteps = steps
    chosen.staticSolver.verboseMode = 0
    chosen.staticSolver.stabilizerODE2term = 1e-6
    chosen.staticSolver.newton.useModifiedNewton = False
    chosen.timeIntegration.numberOfSteps = steps
    chosen.timeIntegration.endTime = duration
    chosen.timeIntegration.verboseMode = 0
    chosen.timeIntegration.automaticStepSize = False
    return chosen
