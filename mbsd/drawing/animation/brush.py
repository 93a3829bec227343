"""A canvas on the Agg renderer, in pixels and sorted by order, with arrows and arcs.

Artists of matplotlib cost more than the strokes they make: an animation draws some hundred strokes a picture.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mbsd.drawing.animation.words import Head
from mbsd.drawing.canvas import Canvas, Label, Point
from mbsd.drawing.look import INK, MOVED, PAPER

Colour = tuple[float, float, float, float]
HALO = "#ffffff"
"""Round arrows, on light paper."""
BEHIND = 0.72
"""Distance of a head's second point behind the first, in its length."""


@dataclass(frozen=True)
class View:
    """Metres to pixels, y upwards."""

    scale: float
    """Pixels a metre."""
    left: float
    low: float
    """Pixels of the world's origin."""

    def pixels(self, points: Point | Sequence[Point]) -> np.ndarray:
        """Return (k, 2) of points in metres."""
        return np.asarray(points, float) * self.scale + (self.left, self.low)


@dataclass(frozen=True)
class Mark:
    """One path in pixels."""

    order: float
    path: Any
    edge: Colour | None
    fill: Colour | None
    width: float
    """Points."""
    dash: Sequence[float]
    """Strokes and gaps in widths; empty: solid."""


@dataclass(eq=False)
class Brush(Canvas):
    """Collects paths; ``paint`` draws them."""

    view: View = field(default_factory=lambda: View(1.0, 0.0, 0.0))
    marks: list[Mark] = field(default_factory=list)
    tints: dict[str, tuple[str, float]] = field(default_factory=dict)
    """Another filling for what is drawn in a colour: colour and alpha."""
    driver: str = MOVED
    """Colour of the signs of drivers: quiet beside arrows."""
    dpi: float = 100.0
    thin: float = 1.0
    """Factor on the widths of lines in metres: less where symbols are small."""
    remembers: bool = False
    """True if obstacles for names are kept."""

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
        """Collect a polyline, or an outline (k, 2) that may be filled."""
        self.keep(path)
        edge, filled = rgba(self._own(ink), 1.0 if closed else alpha), None
        if fill is not None:
            if order == 2 and ink in self.tints:
                fill, alpha = self.tints[ink]
            filled = rgba(self._own(fill), alpha) if alpha > 0 else None
            edge = edge if width > 0 else None
        self._add(self.view.pixels(path), closed, edge, filled, self.thin * width, order, dash)

    def _own(self, colour: str) -> str:
        return self.driver if colour == MOVED else colour

    def band(self, outer: Point, inner: Point, colour: str) -> None:
        """Fill the area between two closed outlines (m)."""
        from matplotlib.path import Path

        self.keep(outer)
        ring = Path.make_compound_path(
            Path(self.view.pixels(outer), closed=True), Path(self.view.pixels(inner[::-1]), closed=True)
        )
        self.marks.append(Mark(1.7, ring, rgba(colour), rgba(colour, 0.12), 1.3 * self.thin, ()))

    def label(self, text: str, anchor: Point, clearance: float, colour: str = INK, size: float = 10.0) -> None:
        """Keep a name, even if others share its place, because they may part. Drivers, which turn, get none."""
        if colour != MOVED:
            self.labels.append(Label(text, anchor, clearance, colour, size))

    def leave_out(self, name: str, anchor: Point, driver: bool) -> None:
        """Keep its number among the names, which come in the same order in all pictures."""
        if not driver:
            self.labels.append(Label(name, anchor, 0.0, INK, 0.0))

    def keep(self, path: Point) -> None:
        """Keep a point every half unit as an obstacle, while places for names are sought."""
        if not self.remembers or len(path) < 2:
            return
        path = np.asarray(path, float)
        gaps = np.diff(path, axis=0)
        counts = np.clip(np.ceil(np.hypot(*gaps.T) / (0.5 * self.unit)), 1, 400).astype(int)
        piece = np.repeat(np.arange(len(gaps)), counts)
        part = (np.arange(len(piece)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[piece]
        self.obstacles.append(np.vstack([path[piece] + part[:, None] * gaps[piece], path[-1:]]))

    def plate(self, pixels: np.ndarray, fill: Colour | None, edge: Colour | None, width: float, order: float) -> None:
        """Collect a closed outline in pixels."""
        self._add(pixels, True, edge, fill, width, order)

    def stroke(self, pixels: np.ndarray, colour: Colour, width: float, order: float) -> None:
        """Collect a polyline in pixels."""
        self._add(pixels, False, colour, None, width, order)

    def paint(self, renderer: Any, others: Sequence[Mark] = (), shift: tuple[float, float] = (0.0, 0.0)) -> None:
        """Draw all, lower orders first, those of one order as they came.

        ``others`` are drawn too, moved by ``shift`` pixels.
        """
        from matplotlib.transforms import Affine2D

        still, moved = Affine2D(), Affine2D().translate(*shift)
        every = [*((mark, moved) for mark in others), *((mark, still) for mark in self.marks)]
        for mark, way in sorted(every, key=lambda pair: pair[0].order):
            gc = renderer.new_gc()
            gc.set_linewidth(renderer.points_to_pixels(mark.width) if mark.edge else 0.0)
            gc.set_foreground(mark.edge or (0, 0, 0, 0), isRGBA=True)
            gc.set_capstyle("round")
            gc.set_joinstyle("round")
            if mark.dash:
                scale = renderer.points_to_pixels(mark.width)
                gc.set_dashes(0, [length * scale for length in mark.dash])
                gc.set_capstyle("butt")
            renderer.draw_path(gc, mark.path, way, mark.fill)
            gc.restore()
        self.marks.clear()

    def _add(
        self,
        pixels: np.ndarray,
        closed: bool,
        edge: Colour | None,
        fill: Colour | None,
        width: float,
        order: float,
        dash: Sequence[float] = (),
    ) -> None:
        from matplotlib.path import Path

        if closed:
            pixels = np.vstack([pixels, pixels[:1]])
        path = Path(pixels, closed=closed)
        path.should_simplify = False
        self.marks.append(Mark(order, path, edge, fill, width, dash))


def rgba(colour: str, alpha: float = 1.0) -> Colour:
    """Return red, green, blue and alpha of a hexadecimal colour, 0 .. 1."""
    return (int(colour[1:3], 16) / 255, int(colour[3:5], 16) / 255, int(colour[5:7], 16) / 255, alpha)


def arrow(
    brush: Brush,
    tail: np.ndarray,
    vector: np.ndarray,
    colour: str,
    size: float,
    cut: bool = False,
    head: Head = "solid",
) -> None:
    """Draw an arrow of ``vector`` pixels with a thin halo; ``size``: thickness of its shaft (pixels).

    ``cut``: two strokes across say that it is longer. Its head says what it stands for (words.py).
    """
    length = float(np.hypot(*vector))
    if length < 0.8 * size:
        return
    along = vector / length
    frame = np.array([along, [-along[1], along[0]]])
    point = min(4.6 * size, (0.72 if "double" not in head else 0.44) * length)
    half = 0.5 * size * min(1.0, length / (4.0 * size))
    outlines = [tail + outline @ frame for outline in _outlines(length, point, half, head)]
    for outline in outlines:
        brush.plate(outline, None, rgba(HALO, 0.9), 2.8, 10.0)
    for outline in outlines:
        brush.plate(outline, rgba(colour), None, 0.0, 10.1)
    for back in (1.4, 2.1) if cut else ():
        middle = tail + vector - (back + 0.5) * point * along
        slant = frame[1] + 0.5 * along
        brush.stroke(np.array([middle - 1.6 * size * slant, middle + 1.6 * size * slant]), rgba(PAPER), 2.2, 10.2)


def _outlines(length: float, point: float, half: float, head: Head) -> list[np.ndarray]:
    """Return closed outlines of an arrow along x: shaft, then points; ``half``: of the shaft's thickness."""
    solid, wide = head.startswith("solid"), 0.36 * point
    neck = length - (point if solid else 1.2 * half)
    out = [np.array([(0.0, half), (neck, half), (neck, -half), (0.0, -half)])]
    for back in (0.0, BEHIND * point) if head.endswith("double") else (0.0,):
        tip = length - back
        if solid:
            out.append(np.array([(tip, 0.0), (tip - point, wide), (tip - point, -wide)]))
        else:
            far, barb = tip - point, 2.4 * half
            out.append(np.array([
                (tip, 0.0), (far, 1.3 * wide), (far - barb, 1.3 * wide),
                (tip - 1.5 * barb, 0.0), (far - barb, -1.3 * wide), (far, -1.3 * wide),
            ]))  # fmt: skip
    return out


def arc(brush: Brush, centre: np.ndarray, radius: float, sweep: float, colour: str, size: float) -> None:
    """Draw an arc of ``sweep`` rad about ``centre`` (pixels) from below, with a head.

    Counter-clockwise is positive.
    """
    if abs(sweep) * radius < 1.5 * size:
        return
    head = min(4.2 * size, 0.7 * abs(sweep) * radius)
    way = math.copysign(1.0, sweep)
    start = -math.pi / 2 - 0.5 * sweep
    end = start + sweep - way * head / radius
    turn = np.linspace(start, end, max(3, int(abs(sweep) * 14)))
    path = centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    out = np.array([math.cos(end), math.sin(end)])
    along = way * np.array([-out[1], out[0]])
    wing = 0.36 * head * out
    tip = path[-1] + head * along - 0.12 * head * out
    triangle = np.array([tip, path[-1] + wing, path[-1] - wing])
    brush.stroke(path, rgba(HALO, 0.9), size * 72 / brush.dpi + 2.2, 10.0)
    brush.plate(triangle, None, rgba(HALO, 0.9), 2.2, 10.0)
    brush.stroke(path, rgba(colour, 0.95), size * 72 / brush.dpi, 10.1)
    brush.plate(triangle, rgba(colour, 0.95), None, 0.0, 10.1)


def fresh(brush: Brush, **more: Any) -> Brush:
    """Return a brush like this one with nothing on it."""
    return replace(brush, obstacles=[], supports=[], labels=[], marks=[], **more)
