"""Heights of bodies along the normal, and the room that they sweep."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.film.clock import Clock, turns_of
from render.film.poses import Moment, Poses
from render.film.scene import Point
from render.film.solids import outermost, prism, read_corners
from render.film.space import SpacePoses
from render.film.tubes.spirals import Site
from render.film.tubes.stretched import placed
from shared.contract import Motion, Parts, Shape
from shared.contract.shot import Label, Trail

# The space a mechanism sweeps over its whole motion: the camera shows it, and it decides the size of the studio.

Array = NDArray[np.float64]
LARGE = 0.3
"""A piece is large if it is longer than this part of all that stands."""
FOOT, SHORT = 0.01, 0.1
"""A piece is the foot if it begins so near to the floor and is longer than that, as parts of the same."""
SAMPLES, MOST = 120, 1200
"""Poses over the motion from which the swept space is taken: of a turn or a second, and of the whole at most."""


class SweptSpace:
    """Points (n, 3) in m around everything that is seen, over the whole motion."""

    def __init__(self, poses: Any, parts: Parts, folder: Path, paths: dict[str, float]) -> None:
        """``poses`` are Poses or SpacePoses, ``folder`` holds the STL files.

        ``paths`` has the height of each traced point that leaves a trail.
        """
        self._poses, self._paths, self._mount = poses, paths, parts.mount
        self._files = {
            body: [folder / piece.stl for piece in solids.pieces.values()] for body, solids in parts.bodies.items()
        }

    @cached_property
    def all(self) -> Array:
        """Everything, the ground with it."""
        return np.concatenate([*self._bodies.values(), *self._trails])

    @cached_property
    def moving(self) -> Array:
        """Return the points that move, with trails; all points if nothing moves."""
        bodies = [cloud for name, cloud in self._bodies.items() if name != "ground"]
        return np.concatenate([*bodies, *self._trails]) if bodies else self.all

    @cached_property
    def machine(self) -> Array:
        """Return the points that move, without trails; all points if nothing moves.

        In space the posts that hold joints belong to it, all of ground but its plate.
        """
        bodies = [cloud for name, cloud in self._bodies.items() if name != "ground"]
        if bodies and isinstance(self._poses, SpacePoses):
            bodies += self._outlines.get("ground", [])[1:]
        return np.concatenate(bodies) if bodies else self.all

    @cached_property
    def around(self) -> Array:
        """Return the points that stand still: the base and all that is fixed to it; none if nothing moves."""
        bodies = [cloud for name, cloud in self._bodies.items() if name == "ground"]
        return np.concatenate(bodies) if bodies and len(bodies) < len(self._bodies) else np.zeros((0, 3))

    @cached_property
    def things(self) -> list[Array]:
        """Points (n, 3) of each large piece that stands, and of the foot of a stand, however small it is."""
        if not len(self.around):
            return []
        size = float(np.linalg.norm(np.ptp(self.around, axis=0)))
        pieces = self._outlines.get("ground", [])
        floor = float((self.around @ self._mount.up).min()) + FOOT * size if self._mount.kind == "stand" else -math.inf
        sizes = [float(np.linalg.norm(np.ptp(piece, axis=0))) / size for piece in pieces]
        feet = [float((piece @ self._mount.up).min()) < floor for piece in pieces]
        return [
            piece for piece, long, foot in zip(pieces, sizes, feet, strict=True) if long > (SHORT if foot else LARGE)
        ]

    def places(self, times: Array) -> Array:
        """Return the outermost points (T, n, 3) of all that moves at ``times`` (T,); none if nothing moves."""
        corners: list[Array] = [np.zeros((len(times), 0, 3))]
        for body, points in self._farthest.items():
            if body != "ground":
                corners.append(self._poses.carried(body, points, times).reshape(len(times), -1, 3))
        return np.concatenate(corners, axis=1)

    def outlines(self, body: str) -> list[Array]:
        """Return the upright prism (n, 3) around each piece of a body, in its frame (m)."""
        return self._outlines.get(body, [])

    @cached_property
    def standing(self) -> Array:
        """Return points that stand still: corners of pieces, and places between any two corners of one piece."""
        between = np.linspace(0, 1, 9)[:, None, None, None]
        inside = [
            (between * box[None, :, None] + (1 - between) * box[None, None, :]).reshape(-1, 3)
            for box in (box[:: max(1, len(box) // 24)] for box in self._outlines.get("ground", []))
        ]
        return np.concatenate(inside) if inside else np.zeros((0, 3))

    @cached_property
    def middle(self) -> Array:
        """Middle (3,) of the box around everything."""
        return (self.all.min(axis=0) + self.all.max(axis=0)) / 2

    @cached_property
    def size(self) -> float:
        """Diagonal (m) of the box around everything."""
        return float(np.linalg.norm(np.ptp(self.all, axis=0)))

    def tops_at(self, body: str, x: float, y: float, at: Moment) -> list[float]:
        """Return heights of the body's pieces whose box holds the point (x, y) at that moment.

        Boxes are in the body's frame.
        """
        return self.tops_under(body, np.array([[x, y]]), at)[0]

    def tops_under(self, body: str, points: Array, at: Moment) -> list[list[float]]:
        """Return the same of each of points (n, 2)."""
        if body not in self._boxes:
            return [[] for _ in points]
        low, high, top = self._boxes[body]
        x0, y0, theta = self._poses.body(body, at)
        turned = cmath.exp(-1j * theta) * (points[:, 0] - x0 + 1j * (points[:, 1] - y0))
        local = np.stack([turned.real, turned.imag], axis=1)[:, None]
        holds = ((low <= local) & (local <= high)).all(axis=2)
        return [top[held].tolist() for held in holds]

    @cached_property
    def _boxes(self) -> dict[str, tuple[Array, Array, Array]]:
        """Lowest and highest x, y (n, 2) and the top (n,) of the pieces of each body, in its frame."""
        boxes = {}
        for body, outlines in self._outlines.items():
            low, high = (
                np.array([side(piece, axis=0) for piece in outlines]).reshape(-1, 3) for side in (np.min, np.max)
            )
            boxes[body] = low[:, :2], high[:, :2], high[:, 2]
        return boxes

    @cached_property
    def _outlines(self) -> dict[str, list[Array]]:
        """The upright prism around each piece, in its body's frame; in space its outermost points."""
        if isinstance(self._poses, SpacePoses):
            return {body: [outermost(read_corners(file)) for file in files] for body, files in self._files.items()}
        return {body: [prism(read_corners(file)) for file in files] for body, files in self._files.items()}

    @cached_property
    def _farthest(self) -> dict[str, Array]:
        """The outermost points of each body that has solids, in its frame."""
        return {body: outermost(np.concatenate(outlines)) for body, outlines in self._outlines.items() if outlines}

    @cached_property
    def _moments(self) -> list[Moment]:
        motion = self._poses.motion
        start, end = motion.time[0], motion.time[-1]
        if motion.period is not None:
            count = min(SAMPLES * turns_of(motion), MOST)
            return [Moment(start + motion.period * (i / count), 0) for i in range(count)]
        count = min(max(SAMPLES, math.ceil(SAMPLES * (end - start))), MOST)
        return [Moment(float(time), 0) for time in np.linspace(start, end, count + 1)]

    @cached_property
    def _bodies(self) -> dict[str, Array]:
        """The swept points of each body."""
        clouds: dict[str, Array] = {}
        times = np.array([at.time for at in self._moments])
        for body, farthest in self._farthest.items():
            if self._poses.is_still(body, times):
                clouds[body] = self._poses.carried(body, np.concatenate(self._outlines[body]), times[:1])
            else:  # a chain of a hundred links would have forty million points
                clouds[body] = self._poses.carried(body, farthest, times)
        return clouds

    @cached_property
    def _trails(self) -> list[Array]:
        times = np.array([at.time for at in self._moments])
        return [self._poses.path(point, times, height) for point, height in self._paths.items()]


# How high things lie that are drawn over the solids: trails, labels, arrows, springs (m).

OVER = 0.001
"""Height of trails and arrows over the body that carries them (m)."""
LABEL = 0.012
"""Height of a label over its pin, as a part of the size of the swept motion."""
LETTER = 0.6
"""Width of a letter of a label, in its height."""
LIES = 1.25
"""Height of the middle of a spring over what is below it, in its radii."""


def tops(parts: Parts, body: str) -> list[float]:
    """Return heights of all pieces of a body."""
    solids = parts.bodies.get(body)
    return [piece.z_range[1] for piece in solids.pieces.values()] if solids else []


def trail_heights(motion: Motion, parts: Parts, trails: Iterable[Trail]) -> dict[str, float]:
    """Return heights of each trail, by its point.

    The shot gives them, else they are just over the body that carries the point.
    """
    moving = [top for body in motion.bodies for top in tops(parts, body)]
    out = {}
    for trail in trails:
        over = tops(parts, motion.points[trail.point].body) or moving
        out[trail.point] = max(over, default=0.0) + OVER if trail.z is None else trail.z
    return out


DIRECTIONS = 72
"""Directions in which a stud may stand beside a pin."""
PASSING = 24
"""Moments at which is looked what passes over a pin."""


class Heights:
    """Heights of what floats over the bodies of one film."""

    def __init__(self, poses: Poses, parts: Parts, space: SweptSpace, clock: Clock) -> None:
        self.poses, self.parts, self.space, self.clock = poses, parts, space, clock
        self._passed: dict[Label, float] = {}
        """The highest piece that is ever under each label."""

    def arrow(self, bodies: Iterable[str], x: float, y: float) -> float:
        """Return the height on the highest piece where it begins at the start; else over all its bodies.

        Ground counts where nothing else is: an arrow on a bridge over a pin would begin beside it in the picture.
        """
        bodies, start = list(bodies), self.clock.moment(0)
        under = {body: self.space.tops_at(body, x, y, start) for body in bodies}
        heights = [top for body, tops_there in under.items() if body != "ground" for top in tops_there]
        heights = heights or under.get("ground", [])
        heights = heights or [top for body in bodies for top in tops(self.parts, body)]
        return max(heights, default=float(self.space.moving[:, 2].max())) + OVER

    def spring(self, shape: Shape, radius: float) -> tuple[float, tuple[float, float]]:
        """Return the height of a spring of that radius over what is at its two ends, and the tops there.

        Both are those at the start.
        """
        at = self.clock.moment(0)
        places = [placed(self.poses.body(b, at), marker) for b, marker in zip(shape.bodies, shape.markers, strict=True)]
        ends = []
        for body, place in zip(shape.bodies, places, strict=True):
            beside = tops(self.parts, body) if body != "ground" else []
            floor = float(self.space.all[:, 2].min())
            ends.append(max(self.space.tops_at(body, *place, at) or beside or [floor]))
        return max(ends) + LIES * radius, (ends[0], ends[1])

    def site(self, bodies: tuple[str, str], places: Array, radius: float) -> Site | None:
        """Return the room for a spiral of that radius (m) over the pin of two bodies.

        Places (T, 2) of both bodies are given. The stud is on the body that is higher, where it is solid so far from
        the pin; None where neither is.
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
        """Return the highest piece that is ever over a disc that is at these places (T, 2) of the motion."""
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
        """Return the height just over the highest piece that a joint or traced point goes through."""
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
        """Return the place of a label of the shot, over all that ever passes under its words.

        So nothing cuts through them.
        """
        if label not in self._passed:
            path = self.poses.motion.points.get(label.at) or self.poses.motion.joints[label.at]
            half = LETTER / 2 * len(label.text) * label.size * self.space.size
            self._passed[label] = self._passing(np.column_stack([path.x, path.y]), half)
        x, y, z = self.label(label.at, at)
        return x, y, max(z, self._passed[label] + LABEL * self.space.size)
