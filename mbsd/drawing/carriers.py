"""Carriers of strokes of the skeleton through a motion; each symbol names those of its strokes.

ground    it stays where it is
body      it moves with a body's frame
place     it moves with a point of a body, and does not turn
line      it moves with the line from one point to another: it is stretched along it, not across
shapes    nothing of these: it is drawn anew in many poses, and what is between two is a mean of both
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from mbsd.drawing.pose import Tracks
from mbsd.model.body import Marker

Kind = Literal["ground", "body", "place", "line", "shapes"]


@dataclass(frozen=True)
class End:
    """A point of a body, in its frame (m); ``z`` of bodies in space."""

    body: str
    x: float = 0.0
    y: float = 0.0
    z: float | None = None


class Frames:
    """Where the bodies are at one output."""

    def __init__(self, tracks: Tracks, step: int) -> None:
        self._pose = tracks.pose(step)

    def frame(self, body: str) -> tuple[np.ndarray, float]:
        """Place (2,) and angle of a body's frame (m, rad)."""
        x, y, theta = self._pose.frames[body]
        return np.array([x, y]), theta

    def place(self, end: End) -> np.ndarray:
        """Return (2,) in the world (m)."""
        return self._pose.point(end.body, end.x, end.y)


@dataclass(frozen=True)
class Carrier:
    """One of the kinds; ``ends``: none of ground, the body's frame, a place, or the two ends of a line."""

    kind: Kind
    ends: tuple[End, ...] = ()

    def moved(self, points: np.ndarray | None, start: Frames, now: Frames) -> np.ndarray:
        """Return points (k, 2) from where they are at the start to where they are carried to (m)."""
        if points is None or self.kind == "ground":
            return np.zeros((0, 2)) if points is None else points
        if self.kind == "body":
            (a, first), (b, last) = start.frame(self.ends[0].body), now.frame(self.ends[0].body)
            return b + (points - a) @ _turn(last - first)
        if self.kind == "place":
            return points + now.place(self.ends[0]) - start.place(self.ends[0])
        (a, b), (c, d) = ([frames.place(end) for end in self.ends] for frames in (start, now))
        before, after = b - a, d - c
        length, longer = float(np.hypot(*before)), float(np.hypot(*after))
        if length == 0 or longer == 0:
            return points + c - a
        along, across = _axes(before / length)
        u, v = (points - a) @ along, (points - a) @ across
        along, across = _axes(after / longer)
        return c + (u * longer / length)[:, None] * along + v[:, None] * across


GROUND = Carrier("ground")


def on_body(name: str) -> Carrier:
    """Return a body's frame."""
    return GROUND if name == "ground" else Carrier("body", (End(name),))


def at_place(marker: Marker) -> Carrier:
    """Return the place of a marker."""
    return GROUND if marker.body.name == "ground" else Carrier("place", (_end(marker),))


def along_line(i: Marker, j: Marker) -> Carrier:
    """Return the line from marker i to marker j."""
    return Carrier("line", (_end(i), _end(j)))


def along_axes(i: Marker, j: Marker) -> Carrier | None:
    """Return the place of marker j, to draw along the axes of marker i; None where these turn otherwise."""
    if i.body is j.body:
        return on_body(i.body.name)
    return at_place(j) if i.body.name == "ground" else None


def _end(marker: Marker) -> End:
    return End(marker.body.name, marker.x, marker.y)


def _turn(angle: float) -> np.ndarray:
    """Return the matrix that turns rows by ``angle``, counter-clockwise."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s], [-s, c]])


def _axes(along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return along, np.array([-along[1], along[0]])
