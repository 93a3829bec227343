"""Cables over pulleys: one tube along their strands, the arcs on their wheels and what drums hold.

A strand that hangs slack sags by what it is longer than its way. A drum at an end is wound about by nearly a turn.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Poses
from render.film.scene import Point, TubeSpec
from render.film.tubes.stretched import FIBRE, ROPE, ROPE_POINTS, placed, sagging
from shared.contract import ContactMotion, Held, JointMotion, Motion, Shape
from shared.contract.geometry import rows_of_spans, span_ends

Array = NDArray[np.float64]
ARC_POINTS = 25
"""Points of the cable on a wheel."""
WOUND = 0.92 * math.tau
"""Angle (rad) of the cable that is seen on a drum at its end."""


@dataclass(frozen=True)
class Span:
    """One straight piece: its wheels, and how much it hangs slack (T,) (m)."""

    shape: Shape
    gap: Array | None

    @property
    def radii(self) -> tuple[float, float]:
        """Signed radii (m), 0 at points."""
        sizes = self.shape.radius_first or 0.0, self.shape.radius_second or 0.0
        first, second = (-size if way else size for size, way in zip(sizes, self.shape.clockwise, strict=True))
        return first, second

    @property
    def wheels(self) -> tuple[tuple[str, float, float, float] | None, tuple[str, float, float, float] | None]:
        """Bodies, places and radii of its wheels; None for points."""
        first, second = (
            (body, x, y, radius) if radius else None
            for body, (x, y, _), radius in zip(self.shape.bodies, self.shape.markers, self.radii, strict=True)
        )
        return first, second


@dataclass(frozen=True)
class Cable:
    """A cable: its spans in their order, and how it looks."""

    name: str
    spans: tuple[Span, ...]
    z: float
    radius: float
    down: Array
    """Direction of gravity (3,)."""
    closed: bool

    @property
    def specs(self) -> list[TubeSpec]:
        """Description of its tube."""
        strands = sum(2 if span.gap is None else ROPE_POINTS for span in self.spans)
        first, last = self.spans[0].radii[0], self.spans[-1].radii[1]
        arcs = len(self.spans) - 1 + (1 if self.closed else (first != 0.0) + (last != 0.0))
        points = strands + arcs * ARC_POINTS + self.closed
        return [TubeSpec(name=self.name, surface=FIBRE, radius=self.radius, points=points)]

    def paths(self, poses: Poses, at: Moment) -> list[list[Point]]:
        """Return the path of its tube at that moment."""
        ends = [span_ends(*self._centres(span, poses, at), span.radii) for span in self.spans]
        pieces = [self._strand(span, end, poses, at) for span, end in zip(self.spans, ends, strict=True)]
        ways = [pieces[0]]
        for k, (span, other) in enumerate(pairwise(self.spans)):
            centre = self._centres(other, poses, at)[0]
            ways += [_arc(centre, span.radii[1], ends[k][1], ends[k + 1][0]), pieces[k + 1]]
        first, last = self.spans[0], self.spans[-1]
        if self.closed:
            ways += [_arc(self._centres(first, poses, at)[0], first.radii[0], ends[-1][1], ends[0][0]), ends[0][:1]]
        else:
            if first.radii[0]:
                ways.insert(0, _wound(self._centres(first, poses, at)[0], -first.radii[0], ends[0][0])[::-1])
            if last.radii[1]:
                ways.append(_wound(self._centres(last, poses, at)[1], last.radii[1], ends[-1][1]))
        return [[(x, y, self.z) for x, y in np.concatenate(ways).tolist()]]

    def _centres(self, span: Span, poses: Poses, at: Moment) -> tuple[Array, Array]:
        """Return the centres (2,) of a span's wheels."""
        first, second = (
            np.array(placed(poses.body(body, at), marker))
            for body, marker in zip(span.shape.bodies, span.shape.markers, strict=True)
        )
        return first, second

    def _strand(self, span: Span, ends: Array, poses: Poses, at: Moment) -> Array:
        if span.gap is None:
            return ends
        slack = float(np.interp(at.time, poses.time, span.gap))
        length = float(np.hypot(*(ends[1] - ends[0]))) + max(slack, 0.0)
        level = np.column_stack([ends, np.zeros(2)])
        return sagging(level[0], level[1], length, self.down)[:, :2]


def _arc(centre: Array, radius: float, start: Array, end: Array) -> Array:
    """Return (ARC_POINTS, 2) between two places on a wheel, in the sense of its signed radius."""
    angles = [math.atan2(*(place - centre)[::-1]) for place in (start, end)]
    sense = math.copysign(1.0, radius)
    turn = sense * ((sense * (angles[1] - angles[0])) % math.tau)
    return _on_wheel(centre, radius, angles[0], turn * ARC_POINTS / (ARC_POINTS + 1))


def _wound(centre: Array, radius: float, start: Array) -> Array:
    """Return (ARC_POINTS, 2) of what is wound on a drum from the place where the cable meets it."""
    return _on_wheel(centre, radius, math.atan2(*(start - centre)[::-1]), math.copysign(WOUND, radius))


def _on_wheel(centre: Array, radius: float, begin: float, turn: float) -> Array:
    """Return (ARC_POINTS, 2) on a wheel, the last of them turned on by ``turn`` (rad)."""
    angles = begin + np.linspace(0.0, turn, ARC_POINTS + 1)[1:]
    return centre + abs(radius) * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def cables(
    motion: Motion,
    size: float,
    height: Callable[[Shape, float], tuple[float, tuple[float, float]]],
    held: Mapping[str, Held],
) -> Iterator[Cable]:
    """Yield all cables. ``held``: where they lie, by the names of their spans; ``height`` says it of the others."""
    gravity = np.array([*motion.gravity, 0.0])
    strength = float(np.linalg.norm(gravity))
    down = gravity / strength if strength > 0 else np.zeros(3)
    connections: dict[str, JointMotion | ContactMotion] = {**motion.joints, **motion.contacts}
    spans = {
        name: Span(joint.shape, np.asarray(joint.gap) if isinstance(joint, ContactMotion) else None)
        for name, joint in connections.items()
        if joint.look == "cord" and joint.shape is not None and joint.shape.clockwise
    }
    for row in rows_of_spans({name: span.wheels for name, span in spans.items()}):
        own = [spans[name] for name in row]
        known = [held[name] for name in row if name in held]
        radius = known[0].radius if known else ROPE * size
        z = known[0].z if known else max(height(span.shape, radius)[0] for span in own)
        first, last = own[0].wheels[0], own[-1].wheels[1]
        yield Cable(row[0], tuple(own), z, radius, down, closed=first is not None and first == last)
