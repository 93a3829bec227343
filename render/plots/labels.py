"""Names beside the points they belong to, each on the side where most room is.

Where points lie so close that names would cover each other, some stand farther away, at the end of a thin line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from render.plots.style import HALO

DISTANCE = 15.0
"""Pixels between a point and its name."""
DIRECTIONS = np.radians(np.arange(45, 405, 45))
NEAR, FAR = (1.0, 2.0), (3.5, 5.0, 7.0, 9.0, 12.0, 16.0)
"""How far names are away, in distances: as a rule, and where there is no room."""
CLASH, OUTSIDE = 1000.0, 500.0
"""Costs of a name over another, and over the frame's edge, beside which points of lines under a name count one each."""


@dataclass(frozen=True)
class _Label:
    text: str
    at: tuple[float, float]
    colour: str
    size: float
    weight: str
    clearance: float


class Labels:
    """Collects names and what they must not cover, then places them one by one."""

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self.labels: list[_Label] = []
        self.lines: list[np.ndarray] = []

    def add(
        self,
        text: str,
        at: tuple[float, float],
        colour: str,
        size: float = 10.5,
        weight: str = "normal",
        clearance: float = 0.0,
    ) -> None:
        """A name for the point ``at``, ``clearance`` away from it at least (data coordinates)."""
        self.labels.append(_Label(text, at, colour, size, weight, clearance))

    def avoid_lines(self, corners: list[tuple[float, float]]) -> None:
        """A line that the names should leave free (data coordinates)."""
        self.lines.append(np.asarray(corners, dtype=float))

    def write(self) -> None:
        """Place every name; the limits of the axes must be final in all but their aspect."""
        self.axes.apply_aspect()
        to_pixels = self.axes.transData.transform
        obstacles = np.concatenate(
            [_sampled(to_pixels(line)) for line in self.lines] + [to_pixels([label.at]) for label in self.labels]
            or [np.empty((0, 2))]
        )
        frame = self.axes.get_window_extent()
        boxes: list[np.ndarray] = []
        scale = self.axes.get_figure(root=True).dpi / 72  # type: ignore[union-attr]
        for label in self.labels:
            half = np.array([0.32 * label.size * len(label.text) + 2.0, 0.55 * label.size + 1.0]) * scale
            origin = to_pixels(label.at)
            away = max(DISTANCE, 4.0 + float(to_pixels((label.clearance, 0))[0] - to_pixels((0, 0))[0]))

            def cost(middle: np.ndarray, half: np.ndarray = half) -> float:
                return _cost(middle, half, obstacles, boxes, np.asarray(frame.extents))

            middle = min(_around(origin, half, [far * away for far in NEAR]), key=cost)
            if cost(middle) >= OUTSIDE:
                near = middle
                middle = min([near, *_around(origin, half, [far * DISTANCE for far in FAR])], key=cost)
                if middle is not near:
                    self._lead(origin, middle, half, label.colour)
            boxes.append(np.array([middle - half, middle + half]))
            x, y = self.axes.transData.inverted().transform(middle)
            self.axes.text(
                x, y, label.text, ha="center", va="center", color=label.colour, fontsize=label.size,
                fontweight=label.weight, path_effects=HALO, zorder=10,
            )  # fmt: skip

    def _lead(self, origin: np.ndarray, middle: np.ndarray, half: np.ndarray, colour: str) -> None:
        """Draw a thin line from a point to its name (pixels)."""
        way = origin - middle
        part = float(np.min(half / np.maximum(np.abs(way), 1e-9)))
        ends = self.axes.transData.inverted().transform([middle + min(part, 1.0) * way, origin])
        self.axes.plot(*ends.T, color=colour, linewidth=0.7, alpha=0.8, zorder=9, scalex=False, scaley=False)


def _around(origin: np.ndarray, half: np.ndarray, distances: Sequence[float]) -> list[np.ndarray]:
    """Return middles of names of a ``half`` size around a point at distances (pixels), the nearest first."""
    ways = [np.array([np.cos(a), np.sin(a)]) for a in DIRECTIONS]
    return [origin + way * (distance + half * np.abs(way)) for distance in distances for way in ways]


def _cost(
    middle: np.ndarray, half: np.ndarray, obstacles: np.ndarray, boxes: list[np.ndarray], frame: np.ndarray
) -> float:
    """Return how bad a place is: 1 for each point of a line under the name, much more for names and edges."""
    covered = float((np.abs(obstacles - middle) < half).all(axis=1).sum())
    near = float((np.abs(obstacles - middle) < half + 6.0).all(axis=1).sum())
    low, high = middle - half, middle + half
    clashes = sum(bool((low < box[1]).all() and (high > box[0]).all()) for box in boxes)
    outside = bool((low < frame[:2]).any() or (high > frame[2:]).any())
    return covered + 0.3 * near + CLASH * clashes + OUTSIDE * outside


def _sampled(corners: np.ndarray, step: float = 4.0) -> np.ndarray:
    """Points every ``step`` pixels along a line."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
    at = np.arange(0.0, lengths[-1] + step, step)
    return np.stack([np.interp(at, lengths, corners[:, k]) for k in range(2)], axis=1)
