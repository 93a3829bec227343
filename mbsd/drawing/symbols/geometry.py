"""Geometry of the symbols: where a joint is drawn, how far it reaches, rounded outlines of links."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.drawing.carriers import GROUND, Carrier, at_place
from mbsd.drawing.pose import Pose
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mbsd.model.teeth import with_radii

ROOM = math.radians(55)
"""Between ground's sign and the nearest link."""


@dataclass(frozen=True)
class Place:
    """One joint in one pose."""

    joint: Joint
    pose: Pose
    colours: dict[str, str]
    free_side: np.ndarray
    """Unit direction in which the links at this joint leave most room: where ground's sign goes."""

    @property
    def i(self) -> np.ndarray:
        """(2,) of the first marker (m)."""
        return self.pose.place(self.joint.i)

    @property
    def j(self) -> np.ndarray:
        """(2,) of the second marker (m)."""
        return self.pose.place(self.joint.j)

    @property
    def axis(self) -> np.ndarray:
        """(2,) unit x axis of the first marker."""
        return self.pose.axis(self.joint.i)

    @property
    def grounded(self) -> bool:
        """True if one of the two bodies is ground."""
        return "ground" in self.joint.bodies

    @property
    def carrier(self) -> Carrier:
        """Return the carrier of the second marker: ground too, where the joint holds it there."""
        return GROUND if self.grounded else at_place(self.joint.j)

    @property
    def grounded_end(self) -> np.ndarray:
        """(2,) of the marker on ground (m)."""
        return self.i if self.joint.i.body.name == "ground" else self.j

    def range(self, half: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the ends of a guide: the whole travel, at least ``half`` (m) to both sides of marker j."""
        here = float((self.j - self.i) @ self.axis)
        reached = np.append(self.pose.travel.get(self.joint.name, np.zeros(0)), here)
        return self.i + (reached.min() - half) * self.axis, self.i + (reached.max() + half) * self.axis


def free_side(directions: list[float]) -> np.ndarray:
    """Return down, up, left or right: the first with room beside links at these angles (rad)."""
    best, room = -math.pi / 2, -1.0
    for side in (-math.pi / 2, math.pi / 2, math.pi, 0.0):
        nearest = min((abs((side - d + math.pi) % (2 * math.pi) - math.pi) for d in directions), default=math.pi)
        if room < ROOM and nearest > room + 1e-9:
            best, room = side, nearest
    return np.array([round(math.cos(best)), round(math.sin(best))], float)


BESIDE = 1.4
"""Length of the line of a rack or a rolling disc to both sides, in its radii."""
ROUND = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], float)


def reach(joint: Joint, pose: Pose) -> np.ndarray:
    """Return (k, 2) points that a drawing of this joint must hold (m); none for joints without extent."""
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
    """Return points (k, 2) in the axes of a marker, in the world (m)."""
    axis = pose.axis(marker)
    return pose.place(marker) + points @ np.array([axis, [-axis[1], axis[0]]])


def profile_of(params: Any) -> Any:
    """Return the profile of a cam joint."""
    from mbsd.model.cams.followers import cam_from

    return cam_from(params["profile"])


def geneva_radius(joint: Joint, pose: Pose) -> float:
    """Return the radius of the wheel (m): the pin enters the slots at its rim."""
    distance = float(np.hypot(*(pose.place(joint.j) - pose.place(joint.i))))
    return distance * math.cos(math.pi / joint.params["slots"])


ARC_STEP = math.radians(10)


FLAT = 1e-9
"""Height of a corner over its neighbours' line, as a part of the extent, below which it is rounding."""


def hull(points: np.ndarray) -> np.ndarray:
    """Return (k, 2) corners of the convex hull, counter-clockwise; one or two points stay as they are."""
    unique = sorted({(float(x), float(y)) for x, y in points})
    if len(unique) < 3:
        return np.array(unique)
    flat = FLAT * float(np.ptp(points, axis=0).max()) ** 2

    def chain(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
        out: list[tuple[float, float]] = []
        for p in ordered:
            while len(out) > 1 and _turn(out[-2], out[-1], p) <= flat:
                out.pop()
            out.append(p)
        return out[:-1]

    return np.array(chain(unique) + chain(unique[::-1]))


def rounded(points: np.ndarray, radius: float) -> np.ndarray:
    """Return a closed outline (k, 2) at ``radius`` around the hull of ``points``."""
    corners = hull(points)
    if len(corners) == 1:
        return corners[0] + radius * _arc(0.0, 2 * math.pi)
    edges = np.roll(corners, -1, axis=0) - corners
    outward = np.arctan2(-edges[:, 0], edges[:, 1])  # normals of the edges that leave each corner
    parts = []
    for k, corner in enumerate(corners):
        first = outward[k - 1]
        turn = (outward[k] - first) % (2 * math.pi)
        parts.append(corner + radius * _arc(first, first + turn))
    return np.concatenate(parts)


def _arc(first: float, last: float) -> np.ndarray:
    angles = np.linspace(first, last, max(2, math.ceil((last - first) / ARC_STEP) + 1))
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
