"""How high things lie that are drawn over the solids: trails, labels, arrows, springs (m)."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from render.film.clock import Clock
from render.film.poses import Moment, Poses
from render.film.scene import Point
from render.film.swept import SweptSpace
from render.film.tubes.spirals import Site
from render.film.tubes.stretched import placed
from shared.contract import Motion, Parts, Shape
from shared.contract.shot import Label, Trail

OVER = 0.001
"""Height of trails and arrows over the body that carries them (m)."""
LABEL = 0.012
"""Height of a label over its pin, as a part of the size of the swept motion."""
LETTER = 0.6
"""Width of a letter of a label, in its height."""
LIES = 1.25
"""Height of the middle of a spring over what is below it, in its radii."""


def tops(parts: Parts, body: str) -> list[float]:
    """Heights of all pieces of a body."""
    solids = parts.bodies.get(body)
    return [piece.z_range[1] for piece in solids.pieces.values()] if solids else []


def trail_heights(motion: Motion, parts: Parts, trails: Iterable[Trail]) -> dict[str, float]:
    """Heights of each trail, by its point: as the shot says, else just over the body that carries the point."""
    moving = [top for body in motion.bodies for top in tops(parts, body)]
    out = {}
    for trail in trails:
        over = tops(parts, motion.points[trail.point].body) or moving
        out[trail.point] = max(over, default=0.0) + OVER if trail.z is None else trail.z
    return out


DIRECTIONS = 72
"""In which a stud may stand beside a pin."""
PASSING = 24
"""Moments at which is looked what passes over a pin."""
Array = NDArray[np.float64]


class Heights:
    """Heights of what floats over the bodies of one film."""

    def __init__(self, poses: Poses, parts: Parts, space: SweptSpace, clock: Clock) -> None:
        self.poses, self.parts, self.space, self.clock = poses, parts, space, clock
        self._passed: dict[Label, float] = {}
        """The highest piece that is ever under each label."""

    def arrow(self, bodies: Iterable[str], x: float, y: float) -> float:
        """On the highest piece where it begins at the start; else over all its bodies."""
        bodies, start = list(bodies), self.clock.moment(0)
        heights = [top for body in bodies for top in self.space.tops_at(body, x, y, start)]
        heights = heights or [top for body in bodies for top in tops(self.parts, body)]
        return max(heights, default=float(self.space.moving[:, 2].max())) + OVER

    def spring(self, shape: Shape, radius: float) -> tuple[float, tuple[float, float]]:
        """Height of something of that radius over what is at its two ends at the start, and the tops there."""
        at = self.clock.moment(0)
        places = [placed(self.poses.body(b, at), marker) for b, marker in zip(shape.bodies, shape.markers, strict=True)]
        ends = []
        for body, place in zip(shape.bodies, places, strict=True):
            beside = tops(self.parts, body) if body != "ground" else []
            floor = float(self.space.all[:, 2].min())
            ends.append(max(self.space.tops_at(body, *place, at) or beside or [floor]))
        return max(ends) + LIES * radius, (ends[0], ends[1])

    def site(self, bodies: tuple[str, str], places: Array, radius: float) -> Site | None:
        """Room for a spiral of that radius (m) over the pin of two bodies, whose places (T, 2) are given.

        The stud is on the body that is higher, where it is solid so far from the pin; None where neither is.
        """
        at, (u, v) = self.clock.moment(0), (float(value) for value in places[0])
        seats = []
        for body in bodies:
            theta = self.poses.body(body, at)[2]
            angles = math.tau * np.arange(DIRECTIONS) / DIRECTIONS
            round_it = np.stack([u + radius * np.cos(theta + angles), v + radius * np.sin(theta + angles)], axis=1)
            for k, under in enumerate(self.space.tops_under(body, round_it, at)):
                seats += [(top, body != "ground", -k, body, float(angles[k])) for top in under]
        if not seats:
            return None
        base, _, _, outer, direction = max(seats)
        hub = max([base, *(top for body in bodies for top in self.space.tops_at(body, u, v, at))])
        return Site(outer, direction, base, hub, max(hub, self._passing(places, radius)))

    def _passing(self, places: Array, radius: float) -> float:
        """The highest piece that is ever over a disc that is at these places (T, 2) of the motion."""
        time = self.poses.time
        turns = math.tau * np.arange(8) / 8
        disc = radius * np.concatenate([[(0.0, 0.0)], np.stack([np.cos(turns), np.sin(turns)], axis=1)])
        over = [0.0]
        for k in np.linspace(0, len(time) - 1, PASSING).round().astype(int):
            at = Moment(float(time[k]), 0)
            for body in self.parts.bodies:
                over += [max(under) for under in self.space.tops_under(body, places[k] + disc, at) if under]
        return max(over)

    def label(self, name: str, at: Moment) -> Point:
        """Just over the highest piece that a joint or traced point goes through."""
        motion = self.poses.motion
        if name in motion.points:
            x, y = (float(value) for value in self.poses.point(name, np.array([at.time]))[0])
            bodies = (motion.points[name].body,)
        else:
            x, y = self.poses.joint(name, at)
            bodies = motion.joints[name].bodies
        heights = [top for body in bodies for top in self.space.tops_at(body, x, y, at)]
        return x, y, max(heights, default=float(self.space.moving[:, 2].max())) + LABEL * self.space.size

    def words(self, label: Label, at: Moment) -> Point:
        """Place of a label of the shot: also over all that ever passes under its words, which nothing cuts through."""
        if label not in self._passed:
            path = self.poses.motion.points.get(label.at) or self.poses.motion.joints[label.at]
            half = LETTER / 2 * len(label.text) * label.size * self.space.size
            self._passed[label] = self._passing(np.column_stack([path.x, path.y]), half)
        x, y, z = self.label(label.at, at)
        return x, y, max(z, self._passed[label] + LABEL * self.space.size)
