"""What is laid over a rendered picture: arrows with a faint glow, the legend, a title."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np

from render.scene import LegendRow, Writing

SHADE, SHADE_WIDTH = 0.62, 0.0028
"""How far the picture is darkened around an arrow, and how wide, as a part of its width."""
GLOW, GLOW_WIDTH = 0.42, 0.011
FINE = 3
"""Letters and legend are drawn so many times larger."""
INK, QUIET, CARD = (240, 243, 247, 255), (172, 181, 192, 255), (9, 12, 17, 132)
EDGE = 0.026
"""From the picture's edges, as a part of its width."""


def lay(path: Path, over: Path | None, writing: Writing, number: str) -> None:
    """Write the picture at ``path`` anew with all that lies over it; does nothing where that is nothing."""
    if over is None and not (writing.legend or writing.title or writing.rate):
        return
    from PIL import Image

    with Image.open(path) as opened:
        picture = np.asarray(opened.convert("RGB")).astype(np.float64) / 255
    if over is not None:
        with Image.open(over) as opened:
            picture = _with_arrows(picture, np.asarray(opened.convert("RGBA")).astype(np.float64) / 255)
    page = Image.fromarray(np.rint(255 * np.clip(picture, 0, 1)).astype(np.uint8), "RGB")
    words = _written(page.width, page.height, writing, number)
    page.paste(words, (0, 0), words)
    page.save(path, format="PNG", compress_level=4)


def _with_arrows(picture: np.ndarray, arrows: np.ndarray) -> np.ndarray:
    """The picture (h, w, 3) darkened beside the arrows (h, w, 4), with their glow, and themselves on top."""
    colour, alpha = arrows[..., :3], arrows[..., 3:]
    wide = picture.shape[1]
    shade = np.clip(1.6 * _blurred(alpha, SHADE_WIDTH * wide), 0, 1)
    glow = _blurred(colour * alpha, GLOW_WIDTH * wide)
    under = picture * (1 - SHADE * shade)
    under = 1 - (1 - np.clip(under, 0, 1)) * (1 - GLOW * np.clip(glow, 0, 1))
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


def _written(wide: int, high: int, writing: Writing, number: str) -> Any:
    """Letters and legend alone, RGBA at the size of the picture."""
    from PIL import Image, ImageDraw

    page = Image.new("RGBA", (FINE * wide, FINE * high), (0, 0, 0, 0))
    draw = ImageDraw.Draw(page)
    edge = EDGE * FINE * wide
    if writing.legend:
        _legend(draw, page.size, edge, writing)
    _title(draw, page.size, edge, writing, number)
    # Averaged with alpha premultiplied, else letters have dark rims.
    fine = np.asarray(page).astype(np.float64) / 255
    fine[..., :3] *= fine[..., 3:]
    mean = fine.reshape(high, FINE, wide, FINE, 4).mean(axis=(1, 3))
    mean[..., :3] = np.divide(mean[..., :3], mean[..., 3:], out=np.zeros_like(mean[..., :3]), where=mean[..., 3:] > 0)
    return Image.fromarray(np.rint(255 * mean).astype(np.uint8), "RGBA")


def _font(size: float, bold: bool = False) -> Any:
    """Inter, which Blender brings along; Pillow's own where it does not."""
    from PIL import ImageFont

    blender = importlib.util.find_spec("bpy")
    places = Path(blender.origin).parent.glob("*/datafiles/fonts/Inter.woff2") if blender and blender.origin else ()
    for path in places:
        font = ImageFont.truetype(path, max(1.0, size))
        font.set_variation_by_axes([14, 600 if bold else 450])
        return font
    return ImageFont.load_default(max(1.0, size))


def _title(draw: Any, page: tuple[int, int], edge: float, writing: Writing, number: str) -> None:
    """Name and number at the upper left; the rate of time under them, or alone at the upper left."""
    y, shadow = edge, page[1] / 520
    lines = [(writing.title, page[1] / 16, INK), (number, page[1] / 23, INK), (writing.rate, page[1] / 27, QUIET)]
    for words, size, ink in lines:
        if words:
            font = _font(size, bold=words == writing.title)
            draw.text((edge + shadow, y + shadow), words, fill=(0, 0, 0, 150), font=font, anchor="la")
            draw.text((edge, y), words, fill=ink, font=font, anchor="la")
            y += 1.4 * size


def _legend(draw: Any, page: tuple[int, int], edge: float, writing: Writing) -> None:
    """A card in its corner: arrow, number and word in each row."""
    size = page[1] / 25
    font = _font(size)
    row, pad, gap = 1.5 * size, 0.7 * size, 0.8 * size
    arrows = max(one.length * page[0] for one in writing.legend)
    numbers = max(draw.textlength(one.number, font=font) for one in writing.legend)
    words = max(draw.textlength(one.words, font=font) for one in writing.legend)
    wide = 2 * pad + arrows + gap + numbers + gap + words
    high = 2 * pad + row * len(writing.legend) - 0.3 * size
    left = edge if "left" in writing.corner else page[0] - edge - wide
    top = edge if "upper" in writing.corner else page[1] - edge - high
    draw.rounded_rectangle((left, top, left + wide, top + high), radius=0.5 * size, fill=CARD)
    for k, one in enumerate(writing.legend):
        y = top + pad + (k + 0.4) * row
        _reference(draw, left + pad + arrows - one.length * page[0], y, one, page)
        x = left + pad + arrows + gap
        draw.text((x, y), one.number, fill=INK, font=font, anchor="lm")
        draw.text((x + numbers + gap, y), one.words, fill=QUIET, font=font, anchor="lm")


def _reference(draw: Any, x: float, y: float, row: LegendRow, page: tuple[int, int]) -> None:
    """The reference arrow, flat, in the proportions of those in the picture."""
    length, ink = row.length * page[0], tuple(round(255 * c) for c in row.colour)
    point = min(row.point * page[0], 0.45 * length)
    half, shaft = 0.34 * point, 0.11 * point
    draw.rectangle((x, y - shaft, x + length - point, y + shaft), fill=ink)
    draw.polygon([(x + length, y), (x + length - point, y - half), (x + length - point, y + half)], fill=ink)
