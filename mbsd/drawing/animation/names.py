"""Names that move with the mechanism, each on the least covered side of its anchor.

A name keeps its side over the whole clip. A word is drawn once as a small picture and laid over each picture of the
clip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from mbsd.drawing.animation.brush import Brush
from mbsd.drawing.canvas import offsets
from mbsd.model.mechanism import Model

DIRECTIONS = 12
DISTANCES = (0.0, 0.6, 1.4)
"""Distances beyond the clearance, in heights of the word."""
MARGIN = 2.0
"""Pixels."""


@dataclass(frozen=True)
class Placed:
    """One name."""

    number: int
    """Among the labels that the machine asks for, which come in the same order each time."""
    word: np.ndarray
    """The word as a small picture, see :func:`sprite`."""
    off: np.ndarray
    """(2,) pixels from its anchor to its middle."""


def place_names(
    drawn: Sequence[Brush], frame: tuple[float, float, float, float], wanted: Sequence[int]
) -> list[Placed]:
    """Return places of the ``wanted`` labels from pictures that kept obstacles.

    ``frame``: left, low, right, top.
    """
    first = drawn[0]
    points = [brush.view.pixels(np.concatenate(brush.obstacles)) for brush in drawn]
    anchors = [brush.view.pixels([label.anchor for label in brush.labels]) for brush in drawn]
    out: list[Placed] = []
    taken: list[list[np.ndarray]] = [[] for _ in drawn]
    for number in wanted:
        label = first.labels[number]
        word = sprite(label.text, 0.92 * label.size, label.colour, first.dpi)
        size = np.array([word.shape[1], word.shape[0]]) + 2 * MARGIN
        offs = offsets(label.clearance * first.unit * first.view.scale, size, DIRECTIONS, DISTANCES)
        costs = np.arange(len(offs)) * 0.4
        for k in range(len(drawn)):
            costs += _costs(anchors[k][number] + np.array(offs), size, points[k], taken[k], frame)
        best = offs[int(np.argmin(costs))]
        for k in range(len(drawn)):
            taken[k].append(
                np.concatenate([anchors[k][number] + best - size / 2, anchors[k][number] + best + size / 2])
            )
        out.append(Placed(number, word, best))
    return out


def that_matter(m: Model) -> list[str]:
    """Return names by importance: the driven body, the output, traced points, then all other bodies."""
    driven = [name for driver in m.drivers.values() for name in driver.bodies if name != "ground"]
    grounded = [name for joint in m.joints.values() if "ground" in joint.bodies for name in joint.bodies[::-1]]
    out = [name for name in grounded if name != "ground" and name not in driven][-1:]
    first, others = (
        [*driven[:1], *out, *list(m.traces)[:1]],
        [*m.traces, *(name for name in m.bodies if name != "ground")],
    )
    return list(dict.fromkeys([*first, *others]))


def _costs(
    middles: np.ndarray,
    size: np.ndarray,
    points: np.ndarray,
    taken: list[np.ndarray],
    frame: tuple[float, float, float, float],
) -> np.ndarray:
    """Return (c,) of words with these middles (c, 2): what they cover, other words, the edge of the frame."""
    inside = (np.abs(points - middles[:, None]) < size / 2).all(axis=-1).sum(axis=1)
    low, high = middles - size / 2, middles + size / 2
    boxes = np.array(taken).reshape(-1, 1, 4)
    over = ((low < boxes[..., 2:]) & (high > boxes[..., :2])).all(axis=-1).sum(axis=0)
    outside = (low < frame[:2]).any(axis=1) | (high > frame[2:]).any(axis=1)
    return inside + 60.0 * over + 50.0 * outside


@lru_cache(maxsize=512)
def sprite(text: str, size: float, colour: str, dpi: float, bold: bool = False) -> np.ndarray:
    """Return (h, w, 4) bytes of a word with a white rim; ``size`` in points."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patheffects import withStroke

    figure = Figure(figsize=(0.2 + 0.011 * size * (len(text) + 1), 0.035 * size), dpi=dpi)
    canvas = FigureCanvasAgg(figure)
    figure.patch.set_alpha(0.0)
    figure.text(
        0.5, 0.5, text, color=colour, fontsize=size, ha="center", va="center", parse_math=False,
        fontweight="bold" if bold else "normal", path_effects=[withStroke(linewidth=2.6, foreground="white")],
    )  # fmt: skip
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba())
    rows, columns = (np.flatnonzero(picture[..., 3].any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return np.zeros((1, 1, 4), np.uint8)
    return picture[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].copy()


def lay(picture: np.ndarray, word: np.ndarray, x: float, y: float) -> None:
    """Lay ``word`` over ``picture`` (H, W, 4), its middle at (x, y) pixels from the lower left."""
    height, width = picture.shape[:2]
    h, w = word.shape[:2]
    left, top = round(x - w / 2), round(height - y - h / 2)
    x0, x1, y0, y1 = max(left, 0), min(left + w, width), max(top, 0), min(top + h, height)
    if x0 >= x1 or y0 >= y1:
        return
    part = word[y0 - top : y1 - top, x0 - left : x1 - left].astype(np.uint16)
    below = picture[y0:y1, x0:x1]
    cover = part[..., 3:]
    below[..., :3] = ((part[..., :3] * cover + below[..., :3] * (255 - cover)) // 255).astype(np.uint8)


def paint_word(figure: Any, renderer: Any, text: str, x: float, y: float, ink: str, size: float, side: str) -> None:
    """Write words with their ``side`` at x, their middle at height y (pixels)."""
    word = figure.text(x, y, text, color=ink, fontsize=size, ha=side, va="center", transform=None, parse_math=False)
    word.draw(renderer)
