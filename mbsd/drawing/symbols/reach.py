"""How far joints of machines reach beyond their markers, so that the drawing holds all of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mbsd.drawing.pose import Pose
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mbsd.model.teeth import with_radii

BESIDE = 1.4
"""How far the line of a rack or a rolling disc goes on to both sides, in its radii."""
ROUND = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], float)


def reach(joint: Joint, pose: Pose) -> np.ndarray:
    """(k, 2) points that a drawing of this joint must hold (m); none for joints without extent."""
    params = with_radii(joint.params)
    out = [np.zeros((0, 2))]
    discs = ((joint.i, params.get("radius_i")), (joint.j, params.get("radius_j")), (joint.j, params.get("radius")))
    for marker, radius in discs:
        if isinstance(radius, float) and joint.kind.drawn_as != "geneva":
            out.append(pose.place(marker) + radius * ROUND)
    if joint.kind.drawn_as == "geneva":
        wheel = geneva_radius(joint, pose)
        out += [pose.place(joint.i) + params["radius"] * ROUND, pose.place(joint.j) + wheel * ROUND]
    if joint.kind.drawn_as in ("rolling_disc", "rack_and_pinion"):
        start, axis = pose.place(joint.i), pose.axis(joint.i)
        travel = np.append(pose.travel.get(joint.name, np.zeros(0)), float((pose.place(joint.j) - start) @ axis))
        ends = np.array([travel.min(), travel.max()]) + BESIDE * params["radius"] * np.array([-1.0, 1.0])
        out.append(start + ends[:, None] * axis)
    if "points" in params:
        out.append(placed(pose, joint.i, np.array(params["points"], float)))
    if "profile" in params:
        out.append(placed(pose, joint.i, profile_of(params).outline))
    return np.concatenate(out)


def placed(pose: Pose, marker: Marker, points: np.ndarray) -> np.ndarray:
    """Points (k, 2) in the axes of a marker, in the world (m)."""
    axis = pose.axis(marker)
    return pose.place(marker) + points @ np.array([axis, [-axis[1], axis[0]]])


def profile_of(params: Any) -> Any:
    """The profile of a cam joint."""
    from mbsd.model.cams.followers import cam_from

    return cam_from(params["profile"])


def geneva_radius(joint: Joint, pose: Pose) -> float:
    """Radius of the wheel (m): the pin enters the slots at its rim."""
    distance = float(np.hypot(*(pose.place(joint.j) - pose.place(joint.i))))
    return distance * math.cos(math.pi / joint.params["slots"])
