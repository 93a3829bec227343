"""Words as small pictures: drawn once, laid over each picture where they belong."""

from __future__ import annotations

from functools import lru_cache

import numpy as np


@lru_cache(maxsize=512)
def sprite(text: str, size: float, colour: str, dpi: float, bold: bool = False) -> np.ndarray:
    """(h, w, 4) bytes of a word with a white rim; ``size`` in points."""
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
    """``word`` over ``picture`` (H, W, 4), its middle at (x, y) pixels from the lower left."""
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
