"""What is written over a picture: the legend on a card, the title, the rate, a number that follows the motion."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from typing import Any

import numpy as np

from render.film.scene import EDGE, LEGEND, LINE, SIZES, LegendRow, Writing

FINE = 3
"""Letters and legend are drawn so many times larger."""
INK, QUIET, CARD = (240, 243, 247, 255), (172, 181, 192, 255), (9, 12, 17, 132)
SHADOW = (0, 0, 0, 120)
ARC = 0.6
"""Radius of an arc of the legend, in heights of its letters."""


def written(wide: int, high: int, writing: Writing, number: str) -> Any:
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


def font_of(size: float, bold: bool = False) -> Any:
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
    for words, part, ink in zip((writing.title, number, writing.rate), SIZES, (INK, INK, QUIET), strict=True):
        if words:
            size = part * page[1]
            font = font_of(size, bold=words == writing.title)
            draw.text(
                (edge + shadow, y + shadow), words, fill=SHADOW, font=font, anchor="la",
                stroke_width=size / 14, stroke_fill=SHADOW,
            )  # fmt: skip
            draw.text((edge, y), words, fill=ink, font=font, anchor="la")
            y += LINE * size


def _legend(draw: Any, page: tuple[int, int], edge: float, writing: Writing) -> None:
    """A card in its corner: arrow, number and word in each row."""
    size = LEGEND * page[1]
    font = font_of(size)
    row, pad, gap = 1.5 * size, 0.7 * size, 0.8 * size
    arrows = max(2.6 * ARC * size if one.sweep else one.length * page[0] for one in writing.legend)
    numbers = max(draw.textlength(one.number, font=font) for one in writing.legend)
    words = max(draw.textlength(one.words, font=font) for one in writing.legend)
    wide = 2 * pad + arrows + gap + numbers + gap + words
    high = 2 * pad + row * len(writing.legend) - 0.3 * size
    left = edge if "left" in writing.corner else page[0] - edge - wide
    top = edge if "upper" in writing.corner else page[1] - edge - high
    draw.rounded_rectangle((left, top, left + wide, top + high), radius=0.5 * size, fill=CARD)
    for k, one in enumerate(writing.legend):
        y = top + pad + (k + 0.4) * row
        if one.sweep:
            _arc(draw, left + pad + arrows - 1.3 * ARC * size, y, ARC * size, one)
        else:
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


def _arc(draw: Any, x: float, y: float, radius: float, row: LegendRow) -> None:
    """The reference arc about (x, y), flat; it reaches as far round as those in the picture do."""
    ink, half, shaft = tuple(round(255 * c) for c in row.colour), 0.27 * radius, 0.085 * radius
    head = min(0.55, 0.6 * row.sweep)
    y -= radius * (1 + math.cos(min(row.sweep / 2, math.pi))) / 2  # its middle stands in the row's
    start, end = math.pi / 2 + row.sweep / 2, math.pi / 2 - row.sweep / 2  # y goes down: counter-clockwise falls

    def at(angle: float, r: float) -> tuple[float, float]:
        return x + r * math.cos(angle), y + r * math.sin(angle)

    angles = [start + (end + head - start) * k / 48 for k in range(49)]
    ring = [at(a, radius + shaft) for a in angles] + [at(a, radius - shaft) for a in reversed(angles)]
    draw.polygon(ring, fill=ink)
    draw.polygon([at(end + head, radius + half), at(end, radius), at(end + head, radius - half)], fill=ink)
