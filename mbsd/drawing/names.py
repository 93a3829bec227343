"""Names placed where they cover nothing: each tries places around its anchor, the least covered one wins."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd.drawing.canvas import Canvas, Label

DIRECTIONS = 16
DISTANCES = (0.0, 0.5, 1.1, 1.9, 3.0, 4.5)
"""Beyond the clearance, in heights of the text."""
MARGIN = 2.0
"""Points kept free around a name."""


def place_names(canvas: Canvas) -> None:
    """Draw all names of a canvas whose limits are set. Joints come before bodies, in the order they were asked for."""
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
    """Centres (pixels) of the name around its anchor, the nearest and those above first."""
    return [anchor + way for way in offsets(label.clearance * unit, size, DIRECTIONS, DISTANCES)]


def offsets(clearance: float, size: np.ndarray, directions: int, distances: Sequence[float]) -> list[np.ndarray]:
    """From an anchor to the middles of a word of ``size`` (2,) around it: ``clearance`` away (pixels), and farther.

    ``directions`` are counted round the anchor, ``distances`` are beyond the clearance, in heights of the word.
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
    """Return the cost of a box (x0, y0, x1, y1) by what it covers: drawn points, other names, the axes' edge."""
    inside = (points[:, 0] > box[0]) & (points[:, 0] < box[2]) & (points[:, 1] > box[1]) & (points[:, 1] < box[3])
    over = (boxes[:, 0] < box[2]) & (boxes[:, 2] > box[0]) & (boxes[:, 1] < box[3]) & (boxes[:, 3] > box[1])
    outside = box[0] < frame.x0 or box[1] < frame.y0 or box[2] > frame.x1 or box[3] > frame.y1
    return float(inside.sum()) + 100.0 * float(over.sum()) + 50.0 * outside
