"""How high things lie that are drawn over the solids: trails, labels, arrows, springs (m)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from render.clock import Clock
from render.poses import Moment, Poses
from render.scene import Point
from render.stretched import placed
from render.swept import SweptSpace
from shared.contract import Motion, Parts, Shape
from shared.shot import Trail

OVER = 0.001
"""Of trails and arrows over the body that carries them (m)."""
LABEL = 0.012
"""Of a label over its pin, as a part of the size of the swept motion."""
LIES = 1.25
"""Of the middle of a spring over what is below it, in its radii."""


def tops(parts: Parts, body: str) -> list[float]:
    """Of all pieces of a body."""
    solids = parts.bodies.get(body)
    return [piece.z_range[1] for piece in solids.pieces.values()] if solids else []


def trail_heights(motion: Motion, parts: Parts, trails: Iterable[Trail]) -> dict[str, float]:
    """Of each trail, by its point: as the shot says, else just over the body that carries the point."""
    moving = [top for body in motion.bodies for top in tops(parts, body)]
    out = {}
    for trail in trails:
        over = tops(parts, motion.points[trail.point].body) or moving
        out[trail.point] = max(over, default=0.0) + OVER if trail.z is None else trail.z
    return out


class Heights:
    """Of what floats over the bodies of one film."""

    def __init__(self, poses: Poses, parts: Parts, space: SweptSpace, clock: Clock) -> None:
        self.poses, self.parts, self.space, self.clock = poses, parts, space, clock

    def arrow(self, bodies: Iterable[str], x: float, y: float) -> float:
        """On the highest piece where it begins at the start; else over all its bodies."""
        bodies, start = list(bodies), self.clock.moment(0)
        found = [top for body in bodies for top in self.space.tops_at(body, x, y, start)]
        found = found or [top for body in bodies for top in tops(self.parts, body)]
        return max(found, default=float(self.space.moving[:, 2].max())) + OVER

    def spring(self, shape: Shape, radius: float) -> tuple[float, tuple[float, float]]:
        """Of something of that radius that lies over what is at its two ends at the start, and the tops there."""
        at = self.clock.moment(0)
        places = [placed(self.poses.body(b, at), marker) for b, marker in zip(shape.bodies, shape.markers, strict=True)]
        found = []
        for body, place in zip(shape.bodies, places, strict=True):
            beside = tops(self.parts, body) if body != "ground" else []
            floor = float(self.space.all[:, 2].min())
            found.append(max(self.space.tops_at(body, *place, at) or beside or [floor]))
        return max(found) + LIES * radius, (found[0], found[1])

    def label(self, name: str, at: Moment) -> Point:
        """Place of a label: just over the highest piece that its joint or point goes through."""
        motion = self.poses.motion
        if name in motion.points:
            x, y = (float(value) for value in self.poses.point(name, np.array([at.time]))[0])
            bodies = (motion.points[name].body,)
        else:
            x, y = self.poses.joint(name, at)
            bodies = motion.joints[name].bodies
        found = [top for body in bodies for top in self.space.tops_at(body, x, y, at)]
        return x, y, max(found, default=float(self.space.moving[:, 2].max())) + LABEL * self.space.size
