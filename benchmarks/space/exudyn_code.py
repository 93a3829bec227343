"""Exudyn: rigid bodies by implicit methods; chains as kinematic trees by explicit ones.

The closing hinge of Bricard's loop leaves out the row that repeats others. A sweep is its static solver along the turn
of the crank, positions alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks import exudyn_systems, space
from benchmarks.exudyn_systems import STATIC, exu, sensor, u

VERSION = exudyn_systems.VERSION
SOLVERS = dict(
    zip(
        space.PROBLEMS[:-1],
        ("TrapezoidalIndex2", "TrapezoidalIndex2", "RK67", "RK67", "RK44"),
        strict=True,
    )
)
COUNTS = dict(zip(space.PROBLEMS, (11000, 2300, 135, 270, 700, space.STEPS), strict=True))
"""Steps of each problem, the fewest that keep its limit."""
Built = tuple[Any, Callable[[], np.ndarray]]


def settings(problem: str) -> str:
    """Return the settings of a run in words."""
    if problem == space.SWEEP:
        return STATIC
    return f"{'tree, ' * (problem in space.CHAINS)}{SOLVERS[problem]}, {COUNTS[problem]} steps"


def _body(system: Any, mass: float, moments: Any, place: Any, w: Any, gravity: Any) -> tuple[Any, Any]:
    """Add a body whose frame is at its centre of mass; return its node and itself."""
    rates = [*np.cross(w, place), *u.AngularVelocity2EulerParameters_t(w, [1, 0, 0, 0])]
    node = system.AddNode(
        u.NodeRigidBodyEP(
            referenceCoordinates=[*map(float, place), 1.0, 0.0, 0.0, 0.0], initialVelocities=[*map(float, rates)]
        )
    )
    inertia = [*map(float, moments), 0.0, 0.0, 0.0]
    body = system.AddObject(u.ObjectRigidBody(nodeNumber=node, physicsMass=mass, physicsInertia=inertia))
    if any(gravity):
        marker = system.AddMarker(u.MarkerBodyMass(bodyNumber=body))
        system.AddLoad(u.LoadMassProportional(markerNumber=marker, loadVector=list(gravity)))
    return node, body


def _marker(system: Any, body: Any, place: Any) -> Any:
    return system.AddMarker(u.MarkerBodyRigid(bodyNumber=body, localPosition=[*map(float, place)]))


def _frame(axis: Any) -> np.ndarray:
    """Return axes by column, z along ``axis``."""
    z = np.array(axis, float) / np.linalg.norm(axis)
    x = np.cross(z, np.eye(3)[int(np.argmin(np.abs(z)))])
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _join(system: Any, first: Any, second: Any, rows: Any, axes: np.ndarray) -> None:
    system.AddObject(
        u.GenericJoint(
            markerNumbers=[first, second], constrainedAxes=list(rows), rotationMarker0=axes, rotationMarker1=axes
        )
    )


def _ended(system: Any, node: Any, arm: Any) -> Callable[[], np.ndarray]:
    def read() -> np.ndarray:
        place = np.array(system.GetNodeOutput(node, exu.OutputVariableType.Position))
        turned = np.array(system.GetNodeOutput(node, exu.OutputVariableType.RotationMatrix)).reshape(3, 3)
        return place + turned @ arm

    return read


def _top() -> Built:
    system = exu.SystemContainer().AddSystem()
    place = np.array([0.0, 1.0, 0.0])
    node, body = _body(system, space.TOP_MASS, space.TOP_MOMENTS, place, np.array(space.SPIN), (0, 0, -9.81))
    ground = system.AddObject(u.ObjectGround())
    ends = [_marker(system, ground, (0, 0, 0)), _marker(system, body, -place)]
    system.AddObject(u.SphericalJoint(markerNumbers=ends))
    system.Assemble()
    return system, _ended(system, node, np.zeros(3))


def _bricard() -> Built:
    system = exu.SystemContainer().AddSystem()
    corners = np.array(space.CORNERS, float)
    ground = system.AddObject(u.ObjectGround())
    links, nodes, centres = [ground], [None], [np.zeros(3)]
    for k in range(1, 6):
        centre = (corners[k - 1] + corners[k]) / 2
        node, body = _body(system, 1.0, space.moments_of_rod(k), centre, np.zeros(3), (0, -9.81, 0))
        links.append(body)
        nodes.append(node)
        centres.append(centre)
    for k in range(6):
        other = (k + 1) % 6
        ends = [_marker(system, links[n], corners[k] - centres[n]) for n in (k, other)]
        rows = [1, 1, 1, 1, 1, 0] if k < 5 else [1, 1, 1, 1, 0, 0]
        _join(system, ends[0], ends[1], rows, _frame(space.AXES[k]))
    system.Assemble()
    return system, _ended(system, nodes[3], corners[3] - centres[3])


def _chain(count: int) -> Built:
    """Return the chain with a link without mass between the two hinges of each joint."""
    system = exu.SystemContainer().AddSystem()
    joints = [exu.JointType.RevoluteY, exu.JointType.RevoluteZ] * count
    zero, rates = [0.0] * 2 * count, [0.0, 3.0] + [0.0] * (2 * count - 2)
    node = system.AddNode(
        u.NodeGenericODE2(
            referenceCoordinates=zero, initialCoordinates=zero, initialCoordinates_t=rates,
            numberOfODE2Coordinates=2 * count,
        )
    )  # fmt: skip
    offsets = [[space.LINK if k % 2 == 0 and k > 0 else 0.0, 0.0, 0.0] for k in range(2 * count)]
    tree = system.AddObject(
        u.ObjectKinematicTree(
            nodeNumber=node, jointTypes=joints, linkParents=list(range(-1, 2 * count - 1)),
            jointTransformations=exu.Matrix3DList([np.eye(3)] * 2 * count), jointOffsets=exu.Vector3DList(offsets),
            linkInertiasCOM=exu.Matrix3DList([np.zeros((3, 3)), np.diag(space.LINK_MOMENTS)] * count),
            linkCOMs=exu.Vector3DList([[0.0, 0.0, 0.0], [space.LINK / 2, 0.0, 0.0]] * count),
            linkMasses=[0.0, space.LINK_MASS] * count, gravity=[0.0, 0.0, -9.81],
        )
    )  # fmt: skip
    end = system.AddSensor(
        u.SensorKinematicTree(
            objectNumber=tree, linkNumber=2 * count - 1, localPosition=[space.LINK, 0.0, 0.0],
            outputVariableType=exu.OutputVariableType.Position,
        )
    )  # fmt: skip
    system.Assemble()
    return system, lambda: np.array(system.GetSensorValues(end))


def _slider_crank() -> Built:
    """Return the slider-crank with its crank as a body whose turn about x is driven."""
    system = exu.SystemContainer().AddSystem()
    bearing, pin, eye = (np.array(place) for place in (space.BEARING, space.PIN, space.EYE))
    ground = system.AddObject(u.ObjectGround())
    none = np.zeros(3)
    _, crank = _body(system, 0.12, (1e-4, 1e-4, 1e-4), bearing, none, none)
    _, rod = _body(system, 0.5, (0.004, 0.004, 0.004), (pin + eye) / 2, none, none)
    node, slider = _body(system, 2.0, (1e-4, 1e-4, 1e-4), eye, none, none)
    axes = _frame((1, 0, 0))
    hinge = u.GenericJoint(
        markerNumbers=[_marker(system, ground, bearing), _marker(system, crank, none)], constrainedAxes=[1] * 6,
        rotationMarker0=axes, rotationMarker1=axes,
        offsetUserFunction=lambda mbs, t, item, offsets: [0.0, 0.0, 0.0, 0.0, 0.0, space.RATE * t],
    )  # fmt: skip
    system.AddObject(hinge)
    half = (pin - eye) / 2
    system.AddObject(
        u.SphericalJoint(markerNumbers=[_marker(system, crank, pin - bearing), _marker(system, rod, half)])
    )
    second = np.cross((0, 0, 1), pin - eye)
    across = np.column_stack([np.array([0.0, 0, 1]), second / np.linalg.norm(second), np.zeros(3)])
    across[:, 2] = np.cross(across[:, 0], across[:, 1])
    _join(system, _marker(system, slider, none), _marker(system, rod, -half), [1, 1, 1, 0, 0, 1], across)
    _join(system, _marker(system, ground, eye), _marker(system, slider, none), [0, 1, 1, 1, 1, 1], np.eye(3))
    system.Assemble()
    return system, _ended(system, node, none)


def _built(problem: str) -> Built:
    return {space.TOP: _top, space.BRICARD: _bricard, space.SWEEP: _slider_crank}.get(
        problem, lambda: _chain(space.CHAINS[problem])
    )()


def prepare(problem: str, count: int = 0) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` makes one of its own."""
    steps = count or COUNTS[problem]

    def run(system: Any, period: float) -> Callable[[], Any]:
        chosen = exudyn_systems.settings(steps, period, space.DURATION[problem])
        if problem == space.SWEEP:
            return lambda: system.SolveStatic(chosen)
        chosen.timeIntegration.adaptiveStep = False
        chosen.timeIntegration.newton.useModifiedNewton = True
        kind = getattr(exu.DynamicSolverType, SOLVERS[problem])
        return lambda: system.SolveDynamic(chosen, solverType=kind)

    def fresh() -> Callable[[], Any]:
        return run(_built(problem)[0], 1e9)

    def error(_: Any) -> float:
        system, read = _built(problem)
        if problem != space.SWEEP:
            run(system, 1e9)()
            return space.error_at_end(problem, read())
        number = sensor(system, _last_node(system), "Position")
        system.Assemble()
        run(system, 1.0 / steps)()
        rows = np.array(system.GetSensorStoredData(number))
        return float(np.abs(rows[:, 1] - space.slide(space.RATE * rows[:, 0])).max())

    return fresh, error


def _last_node(system: Any) -> int:
    """Return the number of the slider's node, which is the last."""
    return system.systemData.NumberOfNodes() - 1
