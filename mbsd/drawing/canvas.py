"""Axes with a unit, and names on them.

All symbols are drawn in multiples of the unit. What is drawn is kept as an obstacle: each name tries places around its
anchor, and the least covered one wins.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mbsd.drawing.carriers import Carrier
from mbsd.drawing.look import INK, PAPER

Point = np.ndarray
TOGETHER = 0.2
"""Names whose places are nearer (units) are written as one."""


@dataclass(frozen=True)
class Label:
    """A name to be placed near ``anchor``, at least ``clearance`` units away from it."""

    text: str
    anchor: Point
    clearance: float
    colour: str
    size: float
    carrier: Carrier | None = None
    """Carrier of it through a motion; None if nothing carries it."""


@dataclass(eq=False)
class Canvas:
    """Where symbols are drawn. ``unit`` (m) is about the radius of a pin's outer circle."""

    ax: Any
    """matplotlib.axes.Axes; a canvas that only records has none."""
    unit: float
    obstacles: list[Point] = field(default_factory=list)
    """(k, 2) points of what is drawn (m)."""
    supports: list[Point] = field(default_factory=list)
    """Pins that have ground's sign already."""
    wheels: dict[tuple[str, float], tuple[int, float]] = field(default_factory=dict)
    """Teeth and phase (rad) of the gears drawn, by body and radius."""
    pulleys: set[tuple[str, float, float, float]] = field(default_factory=set)
    """Wheels of cables that are drawn, by body, centre and radius (m)."""
    turned: dict[tuple[str, float], tuple[int, float]] = field(default_factory=dict)
    """The same of gears that will be drawn, in a motion: as their teeth stood at its start."""
    coils: dict[str, int] = field(default_factory=dict)
    """Turns of the springs drawn, by force: a spring that moves keeps them."""
    labels: list[Label] = field(default_factory=list)
    carrier: Carrier | None = None
    """Carrier through a motion of all that is being drawn; None if it is drawn anew in every pose."""
    sign: str | None = None
    """Name of the sign that is being drawn, if shown on demand: a canvas that records keeps it."""

    anew: bool = False
    """True if nothing carries what is being drawn, whatever its symbol says."""

    @contextmanager
    def on(self, carrier: Carrier | None) -> Iterator[None]:
        """Let ``carrier`` carry what is drawn within this context."""
        before, self.carrier = self.carrier, None if self.anew else carrier
        try:
            yield
        finally:
            self.carrier = before

    @contextmanager
    def uncarried(self, anew: bool) -> Iterator[None]:
        """Let nothing carry what is drawn within this context, if ``anew``: it is not there in every pose."""
        self.anew = anew
        try:
            yield
        finally:
            self.anew = False

    def leave_out(self, name: str, anchor: Point, driver: bool) -> None:
        """Leave out a joint or driver that an event has released."""

    def line(
        self,
        points: Sequence[Point] | Point,
        colour: str = INK,
        width: float = 1.4,
        order: float = 4,
        alpha: float = 1.0,
        dash: Sequence[float] = (),
    ) -> None:
        """Draw a polyline (m); ``width`` in points, strokes and gaps of ``dash`` in widths."""
        self._draw(np.asarray(points, float), False, colour, None, alpha, width, order, dash)

    def shape(
        self,
        points: Point,
        edge: str = INK,
        fill: str = PAPER,
        width: float = 1.4,
        order: float = 4,
        alpha: float = 1.0,
    ) -> None:
        """Draw a closed outline (m), filled; ``alpha`` is that of the filling."""
        self._draw(np.asarray(points, float), True, edge, fill, alpha, width, order)

    def _draw(
        self,
        path: Point,
        closed: bool,
        ink: str,
        fill: str | None,
        alpha: float,
        width: float,
        order: float,
        dash: Sequence[float] = (),
    ) -> None:
        """Draw a polyline, or an outline (k, 2) that may be filled."""
        if fill is None:
            self.keep(path)
            more = {"linestyle": (0, tuple(dash))} if dash else {}
            look = {"color": ink, "linewidth": width, "zorder": order, "alpha": None if alpha == 1.0 else alpha}
            self.ax.plot(*path.T, solid_capstyle="round", **look, **more)
            return
        from matplotlib.colors import to_rgba

        self.keep(np.vstack([path, path[:1]]))
        look = {"facecolor": to_rgba(fill, alpha), "edgecolor": ink, "linewidth": width, "zorder": order}
        self.ax.fill(*path.T, joinstyle="round", **look)

    def circle(self, centre: Point, radius: float, **look: Any) -> None:
        """Draw a circle of ``radius`` units."""
        turn = np.linspace(0.0, 2 * math.pi, 49)[:-1]
        self.shape(centre + radius * self.unit * np.stack([np.cos(turn), np.sin(turn)], axis=1), **look)

    def band(self, outer: Point, inner: Point, colour: str) -> None:
        """Fill the area between two closed outlines (m)."""
        from matplotlib.colors import to_rgba
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path

        self.keep(outer)
        self.keep(inner)
        ring = Path.make_compound_path(Path(outer, closed=True), Path(inner[::-1], closed=True))
        self.ax.add_patch(PathPatch(ring, facecolor=to_rgba(colour, 0.12), edgecolor=colour, linewidth=1.3, zorder=1.7))

    def head(self, tip: Point, direction: Point, colour: str) -> None:
        """Draw the head of an arrow."""
        along = direction / np.hypot(*direction) * self.unit
        across = np.array([-along[1], along[0]])
        points = np.array([tip, tip - 0.85 * along + 0.36 * across, tip - 0.85 * along - 0.36 * across])
        self.shape(points, edge=colour, fill=colour, width=0.6, order=9.6)

    def hatched(self, a: Point, b: Point, side: Point, order: float = 1.5) -> None:
        """Draw the sign of ground: a line from a to b (m) with strokes on ``side`` (a direction)."""
        self.line([a, b], order=order)
        along = b - a
        length = float(np.hypot(*along))
        count = max(3, round(length / (0.62 * self.unit)))
        lean = (side - along / length) * 0.55 * self.unit
        for k in range(count):
            root = a + along * (k + 0.8) / count
            self.line([root, root + lean], width=0.9, order=order)

    def label(self, text: str, anchor: Point, clearance: float, colour: str = INK, size: float = 10.0) -> None:
        """Ask for a name; it is placed when all is drawn. Names that share a place are one: ``A, B``."""
        for k, other in enumerate(self.labels):
            if other.colour == colour and float(np.hypot(*(other.anchor - anchor))) < TOGETHER * self.unit:
                self.labels[k] = replace(other, text=f"{other.text}, {text}")
                return
        self.labels.append(Label(text, anchor, clearance, colour, size, self.carrier))

    def keep(self, path: Point) -> None:
        """Remember a polyline as an obstacle, sampled every half unit."""
        for a, b in itertools.pairwise(path):
            steps = max(1, math.ceil(float(np.hypot(*(b - a))) / (0.5 * self.unit)))
            self.obstacles.append(a + (b - a) * np.linspace(0.0, 1.0, min(steps, 400) + 1)[:, None])


DIRECTIONS = 16
DISTANCES = (0.0, 0.5, 1.1, 1.9, 3.0, 4.5)
"""Distances beyond the clearance, in heights of the text."""
MARGIN = 2.0
"""Points kept free around a name."""


def place_names(canvas: Canvas) -> None:
    """Draw all names of a canvas whose limits are set.

    Joints come before bodies, in the order they were added.
    """
    from matplotlib.patheffects import withStroke

    ax = canvas.ax
    ax.apply_aspect()
    points = ax.transData.transform(np.concatenate(canvas.obstacles)) if canvas.obstacles else np.zeros((0, 2))
    unit = float(ax.transData.transform((canvas.unit, 0))[0] - ax.transData.transform((0, 0))[0])
    pixels = ax.figure.dpi / 72
    frame = ax.get_window_extent()
    boxes = np.zeros((0, 4))
    for label in canvas.labels:
        halo = [withStroke(linewidth=2.5, foreground="white")]
        text = ax.text(
            0, 0, label.text, color=label.colour, fontsize=label.size, ha="center", va="center", zorder=20,
            path_effects=halo, clip_on=False,
        )  # fmt: skip
        extent = text.get_window_extent()
        size = np.array([extent.width, extent.height]) + 2 * MARGIN * pixels
        anchor = ax.transData.transform(label.anchor)
        centres = _candidates(anchor, label, size, unit)
        costs = [
            _cost(np.concatenate([c - size / 2, c + size / 2]), points, boxes, frame)
            + 0.02 * (k % DIRECTIONS)
            + k // DIRECTIONS
            for k, c in enumerate(centres)
        ]
        best = centres[int(np.argmin(costs))]
        text.set_position(tuple(ax.transData.inverted().transform(best)))
        boxes = np.vstack([boxes, np.concatenate([best - size / 2, best + size / 2])])


def _candidates(anchor: np.ndarray, label: Label, size: np.ndarray, unit: float) -> list[np.ndarray]:
    """Return centres (pixels) of the name around its anchor, the nearest and those above first."""
    return [anchor + way for way in offsets(label.clearance * unit, size, DIRECTIONS, DISTANCES)]


def offsets(clearance: float, size: np.ndarray, directions: int, distances: Sequence[float]) -> list[np.ndarray]:
    """Return the offsets from an anchor to middles of a word of ``size`` (2,).

    They are ``clearance`` away (pixels) and farther. ``directions`` are counted round the anchor, ``distances`` are
    beyond the clearance, in heights of the word.
    """
    out = []
    order = sorted(range(directions), key=lambda k: abs(k - directions * 3 / 16))
    for far in distances:
        for k in order:
            angle = 2 * math.pi * k / directions
            way = np.array([math.cos(angle), math.sin(angle)])
            half = min(size[0] / 2 / max(abs(way[0]), 1e-9), size[1] / 2 / max(abs(way[1]), 1e-9))
            out.append((clearance + half + far * size[1]) * way)
    return out


def _cost(box: np.ndarray, points: np.ndarray, boxes: np.ndarray, frame) -> float:
    """Return the cost of a box (x0, y0, x1, y1) by what it covers: points, other names, the axes' edge."""
    inside = (points[:, 0] > box[0]) & (points[:, 0] < box[2]) & (points[:, 1] > box[1]) & (points[:, 1] < box[3])
    over = (boxes[:, 0] < box[2]) & (boxes[:, 2] > box[0]) & (boxes[:, 1] < box[3]) & (boxes[:, 3] > box[1])
    outside = box[0] < frame.x0 or box[1] < frame.y0 or box[2] > frame.x1 or box[3] > frame.y1
    return float(inside.sum()) + 100.0 * float(over.sum()) + 50.0 * outside
