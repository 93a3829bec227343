"""Bodies round the joints in space: where else they are held, and how they lie to an axis."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mechanisms.stages.automatic.space.moves import MM, Array, Moves
from mechanisms.stages.automatic.space.round import across, unit
from shared.stage.errors import UserError

AXIAL = 0.85
"""Cosine to the axis of a joint above which a body runs along it."""


class Surroundings:
    """Places of all joints on their bodies, and their middle. Raises UserError where two joints are on one place."""

    def __init__(self, moves: Moves) -> None:
        self.moves, self.sizes = moves, moves.sizes
        joints = self.joints = [joint for joint in moves.joints() if joint.kind.name != "rolling"]
        self.anchors: dict[str, dict[str, Array]] = {name: {} for name in moves.m.bodies}
        for joint in joints:
            for marker in (joint.j,) if joint.kind.name == "point_on_plane" else (joint.i, joint.j):
                self.anchors[marker.body.name][joint.name] = moves.place(marker)
        self._refuse_meeting_joints()
        places = [moves.world(marker.body.name, moves.place(marker))[:, 0] for j in joints for marker in (j.i, j.j)]
        self.middle = np.mean(np.concatenate(places), axis=0) if places else np.zeros(3)

    def _refuse_meeting_joints(self) -> None:
        for body, anchors in self.anchors.items():
            for (name, place), (other, another) in combinations(anchors.items(), 2):
                if body != "ground" and np.linalg.norm(place - another) < self.sizes.rod:
                    raise UserError(
                        f"{self.moves.m.name}: joints '{name}' and '{other}' of '{body}' are on one place, where their "
                        "parts would meet. Move one aside (a hinge or slide acts anywhere along its axis, a slide also "
                        "beside it), or write a parts.py"
                    )

    def sides(self, joint: Joint) -> tuple[Marker, Marker]:
        """Return the markers of a joint on the moving body and on ground."""
        return (joint.j, joint.i) if joint.i.body.name == "ground" else (joint.i, joint.j)

    def others(self, marker: Marker) -> list[Array]:
        """Return the places of a body's other joints, and of its disc, ball or mass where it has few."""
        own = self.moves.place(marker)
        body = marker.body
        near = [p for p in self.anchors[body.name].values() if np.linalg.norm(p - own) > 0.5 * self.sizes.rod]
        shape = body.shape
        if shape is not None and shape.kind == "rod":
            near += [
                p
                for p in (np.zeros(3), np.array([MM * shape.length, 0.0, 0.0]))
                if np.linalg.norm(p - own) > self.sizes.rod
            ]
        elif shape is not None and np.linalg.norm(own) > self.sizes.rod:
            near.append(np.zeros(3))
        elif not near and np.linalg.norm(MM * np.array(body.com) - own) > self.sizes.rod:
            near.append(MM * np.array(body.com))
        return near

    def has_rest(self, marker: Marker) -> bool:
        """Return True if a body has another joint, a shape or a mass elsewhere."""
        return bool(self.others(marker))

    def toward(self, marker: Marker) -> Array:
        """Return the place to which a body's rod leads from a joint."""
        others = self.others(marker)
        return np.mean(others, axis=0) if others else self.moves.place(marker) + across(np.array(marker.axis))

    def runs_along(self, marker: Marker) -> bool:
        """Return True if a body runs along the axis of a joint."""
        axis, own = np.array(marker.axis), self.moves.place(marker)
        others = self.others(marker)
        return all(abs(unit(other - own) @ axis) > AXIAL for other in others)

    def is_arm(self, joint: Joint) -> bool:
        """Return True if a joint with ground holds a body that stands across its axis."""
        if "ground" not in joint.bodies or joint.kind.name not in ("revolute", "cylindrical", "prismatic"):
            return False
        return not self.runs_along(self.sides(joint)[0])

    def side(self, joint: Joint) -> float:
        """Return the side of an arm's bearing along its axis: away from the mechanism's middle."""
        ground = self.sides(joint)[1]
        return 1.0 if (MM * np.array(ground.place) - self.middle) @ np.array(ground.axis) >= -1e-6 else -1.0

    def side_of_arm(self, marker: Marker, axis: Array | None = None) -> float:
        """Return the side of the bearing of a body that is an arm about a parallel axis; 0 if it is none."""
        along = np.array(marker.axis) if axis is None else axis
        for joint in self.moves.joints():
            if marker.body.name in joint.bodies and joint.kind.name == "revolute" and self.is_arm(joint):
                own = np.array(self.sides(joint)[0].axis)
                if abs(own @ along) > AXIAL:
                    return self.side(joint) * float(np.sign(own @ along))
        return 0.0

    def shaft_radius(self, marker: Marker) -> float:
        """Return the radius of a body about the axis of a joint (mm)."""
        shape = marker.body.shape
        along = shape is not None and shape.kind == "rod" and abs(marker.axis[0]) > AXIAL
        return MM * shape.radius if along and shape is not None and shape.radius > 0.0 else self.sizes.rod

    def is_shaft(self, body: str, joint: Joint) -> bool:
        """Return True if a body is a shaft on ground whose axis meets that of a joint at 90 degrees."""
        for bearing in self.moves.joints():
            if bearing.kind.name == "revolute" and {body, "ground"} == {*bearing.bodies}:
                own = self.sides(bearing)[0]
                at = joint.i if joint.i.body.name == body else joint.j
                way, axis = self.moves.place(at) - self.moves.place(own), np.array(own.axis)
                meets = np.linalg.norm(np.cross(way, axis)) < 0.1 * self.sizes.rod
                return bool(meets and abs(axis @ np.array(at.axis)) < 1e-3)
        return False

    def seen_rest(self, joint: Joint) -> Array:
        """Return where the rest of the second body of a joint is, as the first sees it at the start."""
        rest = self.moves.world(joint.j.body.name, self.toward(joint.j))[:, 0]
        return self.moves.seen(joint.i.body.name, rest)[0]
