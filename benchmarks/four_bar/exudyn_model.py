"""The four-bar in Exudyn, with a law for its crank's angle."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.four_bar import COUPLER, CRANK, GROUND, ROCKER, exact

sys.exudynFast = True  # type: ignore[attr-defined]  # the build without range checks
import exudyn as exu  # noqa: E402
from exudyn import utilities as u  # noqa: E402


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
