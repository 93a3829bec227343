"""What is laid over a rendered picture: arrows with a faint glow, the legend, a title."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from render.blender.worker.words import lay_words
from render.film.scene import Writing

HALO, HALO_WIDTH, HALO_EDGE = 0.9, 0.0013, 4.0
"""How far the picture is darkened around an arrow, how wide, as a part of its width, and how sharply that ends."""
SHADE, SHADE_WIDTH = 0.4, 0.004
"""The same of the soft shade beyond."""
GLOW, GLOW_WIDTH = 0.22, 0.011


def lay(path: Path, over: Path | None, writing: Writing, number: str) -> None:
    """Write the picture at ``path`` anew with all that lies over it; does nothing where that is nothing."""
    if over is None and not (writing.legend or writing.lines):
        return
    from PIL import Image

    with Image.open(path) as opened:
        picture = np.asarray(opened.convert("RGB")).astype(np.float64) / 255
    if over is not None:
        with Image.open(over) as opened:
            picture = _with_arrows(picture, np.asarray(opened.convert("RGBA")).astype(np.float64) / 255)
    page = Image.fromarray(np.rint(255 * np.clip(picture, 0, 1)).astype(np.uint8), "RGB")
    lay_words(page, writing, number)
    page.save(path, format="PNG", compress_level=4)


def _with_arrows(picture: np.ndarray, arrows: np.ndarray) -> np.ndarray:
    """The picture (h, w, 3) with a thin dark halo round the arrows (h, w, 4), their glow, and themselves on top."""
    colour, alpha = arrows[..., :3], arrows[..., 3:]
    wide = picture.shape[1]
    halo = np.clip(HALO_EDGE * _blurred(alpha, HALO_WIDTH * wide), 0, 1)
    shade = np.clip(1.6 * _blurred(alpha, SHADE_WIDTH * wide), 0, 1)
    glow = _blurred(colour * alpha, GLOW_WIDTH * wide)
    under = picture * (1 - SHADE * shade)
    under = 1 - (1 - np.clip(under, 0, 1)) * (1 - GLOW * np.clip(glow, 0, 1))
    under = under * (1 - HALO * halo)
    return under * (1 - alpha) + colour * alpha


def _blurred(picture: np.ndarray, sigma: float) -> np.ndarray:
    """Gaussian over rows and columns of (h, w, n)."""
    reach = max(1, round(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        padding = [(reach, reach) if k == axis else (0, 0) for k in range(3)]
        padded = np.pad(picture, padding, mode="edge")
        length = picture.shape[axis]
        picture = sum(weight * np.take(padded, range(k, k + length), axis=axis) for k, weight in enumerate(weights))  # pyright: ignore[reportAssignmentType]
    return picture
