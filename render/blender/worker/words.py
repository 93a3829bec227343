"""Words on a picture: lines, sizes and places."""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from render.film.scene import ARC, LegendRow, Writing
from render.letters import font_of

# Text over a picture: the legend on a card, the title, the rate, a number that follows the motion.

FINE = 3
"""Letters and legend are drawn so many times larger."""
INK, QUIET, CARD = (240, 243, 247, 255), (172, 181, 192, 255), (9, 12, 17, 205)
"""On the card of a legend, which is dark in every look."""
BRIGHT, DARK = ((240, 243, 247), (196, 204, 214)), ((24, 28, 34), (52, 58, 66))
"""Words and quiet words without a card."""
HALO, HALO_REACH, HALO_SOFT = 0.86, 0.17, 0.08
"""How much of the picture a halo of the opposite tone hides, how far it reaches beyond a letter, and how soft it ends,
in heights of letters. With it the contrast is above 4.5 on whatever is behind."""
HALOS = (9, 12, 17), (250, 251, 252)
"""Halos of bright words and of dark ones."""


def lay_words(page: Any, writing: Writing, number: str) -> None:
    """Write lines and legend over a picture (RGB)."""
    box, halo, words = _written(page.width, page.height, msgspec.json.encode(writing), number)
    if box is not None:
        part = page.crop(box)
        part.paste(HALOS[writing.on_bright], (0, 0), halo)
        part.paste(words, (0, 0), words)
        page.paste(part, box[:2])
    card = _card(page.width, page.height, msgspec.json.encode(writing))
    if card is not None:
        place, drawn = card
        page.paste(drawn, place, drawn)


@lru_cache(maxsize=4)
def _written(wide: int, high: int, writing: bytes, number: str) -> tuple[Any, Any, Any]:
    """Return the lines: the box of the picture that they take, their halo (L) and themselves (RGBA); None without
    lines.
    """
    from PIL import Image, ImageChops, ImageDraw, ImageFilter

    spec, unit = msgspec.json.decode(writing, type=Writing), min(wide, high)
    lines = [(line, line.words or number) for line in spec.lines if line.words or number]
    if not lines:
        return None, None, None
    right = max(unit * (line.x + line.width + line.size) for line, _ in lines)
    lower = max(unit * (line.y + 2 * line.size) for line, _ in lines)
    size = min(wide, math.ceil(right)), min(high, math.ceil(lower))
    halo = Image.new("L", size, 0)
    page = Image.new("RGBA", (FINE * size[0], FINE * size[1]), (0, 0, 0, 0))
    for line, words in lines:
        fine = FINE * unit * line.size
        font, at = font_of(fine, line.bold), (FINE * unit * line.x, FINE * unit * line.y)
        ink = (DARK if spec.on_bright else BRIGHT)[line.quiet]
        ImageDraw.Draw(page).text(at, words, fill=(*ink, 255), font=font, anchor="la")
        behind = Image.new("L", page.size, 0)
        ImageDraw.Draw(behind).text(
            at, words, fill=255, font=font, anchor="la", stroke_width=HALO_REACH * fine, stroke_fill=255
        )
        soft = behind.resize(size, Image.Resampling.BOX).filter(ImageFilter.GaussianBlur(HALO_SOFT * unit * line.size))
        halo = ImageChops.lighter(halo, soft)
    return (0, 0, *size), halo.point([round(HALO * value) for value in range(256)]), _averaged(page, size)


@lru_cache(maxsize=2)
def _card(wide: int, high: int, writing: bytes) -> tuple[tuple[int, int], Any] | None:
    """Return the legend on its card (RGBA) and its place in the picture; None where there is none."""
    from PIL import Image, ImageDraw

    spec, unit = msgspec.json.decode(writing, type=Writing), min(wide, high)
    if spec.card is None:
        return None
    card = spec.card
    place = math.floor(unit * card.left), math.floor(unit * card.top)
    size = math.ceil(unit * (card.left + card.wide)) - place[0], math.ceil(unit * (card.top + card.high)) - place[1]
    page = Image.new("RGBA", (FINE * size[0], FINE * size[1]), (0, 0, 0, 0))
    _legend(ImageDraw.Draw(page), spec, FINE * unit, (FINE * place[0], FINE * place[1]), FINE * wide)
    return place, _averaged(page, size)


def _averaged(page: Any, size: tuple[int, int]) -> Any:
    """Return a page (RGBA), :data:`FINE` times smaller: averaged with alpha premultiplied, else letters have dark
    rims.
    """
    from PIL import Image

    wide, high = size
    fine = np.asarray(page).astype(np.float32) / 255
    fine[..., :3] *= fine[..., 3:]
    mean = fine.reshape(high, FINE, wide, FINE, 4).mean(axis=(1, 3))
    mean[..., :3] = np.divide(mean[..., :3], mean[..., 3:], out=np.zeros_like(mean[..., :3]), where=mean[..., 3:] > 0)
    return Image.fromarray(np.rint(255 * mean).astype(np.uint8), "RGBA")


def _legend(draw: Any, writing: Writing, unit: float, origin: tuple[int, int], wide: int) -> None:
    """A card with arrow, number and word in each row; ``unit`` is the picture's shorter side in pixels, ``wide`` its
    width, ``origin`` the pixel of the picture that is this page's first.
    """
    card = writing.card
    assert card is not None
    left, top = unit * card.left - origin[0], unit * card.top - origin[1]
    size = unit * card.size
    font = font_of(size)
    box = left, top, left + unit * card.wide, top + unit * card.high
    draw.rounded_rectangle(box, radius=0.5 * size, fill=CARD)
    for k, row in enumerate(writing.legend):
        y = top + unit * card.pad + (k + 0.4) * unit * card.row
        end = left + unit * card.arrows
        if row.sweep:
            _arc(draw, end - 1.3 * ARC * size, y, ARC * size, row)
        else:
            _reference(draw, end - row.length * wide, y, row, wide)
        draw.text((left + unit * card.numbers, y), row.number, fill=INK, font=font, anchor="lm")
        draw.text((left + unit * card.words, y), row.words, fill=QUIET, font=font, anchor="lm")


def _reference(draw: Any, x: float, y: float, row: LegendRow, wide: int) -> None:
    """Add the reference arrow, flat, in the proportions of those in the picture."""
    length, ink = row.length * wide, tuple(round(255 * c) for c in row.colour)
    point = min(row.point * wide, 0.45 * length)
    half, shaft = 0.34 * point, 0.11 * point
    end = x + length
    if row.tip.startswith("solid"):
        draw.rectangle((x, y - shaft, end - point, y + shaft), fill=ink)
        for back in (0.0, 0.72 * point) if row.tip.endswith("double") else (0.0,):
            draw.polygon([(end - back, y), (end - back - point, y - half), (end - back - point, y + half)], fill=ink)
        return
    draw.rectangle((x, y - shaft, end - 0.5 * shaft, y + shaft), fill=ink)
    for back in (0.0, 0.72 * point) if row.tip.endswith("double") else (0.0,):
        for side in (-1.45 * half, 1.45 * half):
            draw.line((end - back - point, y + side, end - back, y), fill=ink, width=max(1, round(2 * shaft)))


def _arc(draw: Any, x: float, y: float, radius: float, row: LegendRow) -> None:
    """Add the reference arc about (x, y), flat; it reaches as far round as those in the picture."""
    ink, half, shaft = tuple(round(255 * c) for c in row.colour), 0.27 * radius, 0.085 * radius
    head = min(0.55, 0.6 * row.sweep)
    y -= radius * (1 + math.cos(min(row.sweep / 2, math.pi))) / 2  # its middle stands in the row's
    start, end = math.pi / 2 + row.sweep / 2, math.pi / 2 - row.sweep / 2  # y goes down: counter-clockwise falls

    def place(angle: float, r: float) -> tuple[float, float]:
        return x + r * math.cos(angle), y + r * math.sin(angle)

    angles = [start + (end + head - start) * k / 48 for k in range(49)]
    ring = [place(a, radius + shaft) for a in angles] + [place(a, radius - shaft) for a in reversed(angles)]
    draw.polygon(ring, fill=ink)
    draw.polygon([place(end + head, radius + half), place(end, radius), place(end + head, radius - half)], fill=ink)


# The overlay of a rendered picture: arrows with a faint glow, the legend, a title.

ARROW_HALO, HALO_WIDTH, HALO_EDGE = 0.9, 0.0013, 4.0
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
    """Return the picture (h, w, 3) with a thin dark halo round the arrows (h, w, 4), their glow, and themselves on
    top.
    """
    colour, alpha = arrows[..., :3], arrows[..., 3:]
    wide = picture.shape[1]
    halo = np.clip(HALO_EDGE * _blurred(alpha, HALO_WIDTH * wide), 0, 1)
    shade = np.clip(1.6 * _blurred(alpha, SHADE_WIDTH * wide), 0, 1)
    glow = _blurred(colour * alpha, GLOW_WIDTH * wide)
    under = picture * (1 - SHADE * shade)
    under = 1 - (1 - np.clip(under, 0, 1)) * (1 - GLOW * np.clip(glow, 0, 1))
    under = under * (1 - ARROW_HALO * halo)
    return under * (1 - alpha) + colour * alpha


def _blurred(picture: np.ndarray, sigma: float) -> np.ndarray:
    """Return a Gaussian blur over rows and columns of (h, w, n)."""
    reach = max(1, round(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        padding = [(reach, reach) if k == axis else (0, 0) for k in range(3)]
        padded = np.pad(picture, padding, mode="edge")
        length = picture.shape[axis]
        picture = sum(weight * np.take(padded, range(k, k + length), axis=axis) for k, weight in enumerate(weights))  # pyright: ignore[reportAssignmentType]
    return picture
