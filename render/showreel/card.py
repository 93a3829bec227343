"""The title before a film: its first picture, dark and blurred, with its name; then it becomes sharp."""

from __future__ import annotations

import io
import math
import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from render.blender.worker.words import INK, QUIET
from render.letters import font_of

if TYPE_CHECKING:
    from PIL.Image import Image

SECONDS = 2.6
FADE = 0.45
"""Seconds in which the words come, and in which they go and the picture becomes sharp."""
DARK = 0.34
"""Light that is left behind the words."""
BLUR = 1 / 40
"""Fraction of the picture's width."""
LEFT, MIDDLE = 0.085, 0.5
"""Place of the words, as parts of width and height."""
LINES = 3
"""The most lines under the name, in a picture that is wider than tall; taller ones have room for more."""
LETTER = 0.56
"""Width of a letter, in its height, on average and with some to spare."""
ACCENT = (255, 142, 62)
"""The colour of a trail."""


@dataclass(frozen=True)
class Title:
    """A name, and what it is."""

    name: str
    said: str = ""


def pictures(first: Image, title: Title, fps: int) -> Iterator[bytes]:
    """Yield PNGs of a title of :data:`SECONDS`; ``first`` is the film's first picture, to which they lead."""
    sharp = np.asarray(first.convert("RGB")).astype(np.float32)
    behind, words = _behind(first), _words(first.size, title)
    count, fade = number(fps), max(1, round(FADE * fps))
    kept: tuple[tuple[float, float], bytes] | None = None
    for k in range(count):
        shown = min(1.0, (k + 1) / fade, max(0.0, 2 * (count - 1 - k) / fade - 1))  # gone before the picture is sharp
        focus = max(0.0, 1.0 - (count - k) / (fade + 1))
        state = (_eased(shown), _eased(focus))
        if kept is None or kept[0] != state:  # most of a title stands still
            ground = behind + (sharp - behind) * state[1]
            alpha = words[..., 3:] / 255 * state[0]
            kept = state, _png(ground + (words[..., :3] - ground) * alpha)
        yield kept[1]


def number(fps: int) -> int:
    """Return pictures of a title."""
    return round(SECONDS * fps)


def _eased(part: float) -> float:
    """Return 0 .. 1 with a slow start and end."""
    return part * part * (3 - 2 * part)


def _behind(first: Image) -> np.ndarray:
    """Return the picture out of focus and dark, darkest on the left, where the words stand."""
    from PIL import ImageFilter

    soft = np.asarray(first.convert("RGB").filter(ImageFilter.GaussianBlur(BLUR * first.width))).astype(np.float32)
    across = np.linspace(0.62, 1.25, first.width, dtype=np.float32)[None, :, None]
    grain = np.random.default_rng(0).uniform(-0.5, 0.5, soft.shape[:2]).astype(np.float32)  # or dark slopes show bands
    return soft * DARK * across + grain[..., None]


def _words(size: tuple[int, int], title: Title) -> np.ndarray:
    """Return the name, a short line and what it is: RGBA, floats 0..255."""
    from PIL import Image, ImageDraw

    wide, high = size
    unit = min(size)
    page = Image.new("RGBA", size, (*INK[:3], 0))
    draw = ImageDraw.Draw(page)
    large = _fitting(draw, title.name, unit / 9.5, wide * (1 - 2 * LEFT))
    small = font_of(unit / 29)
    letters = math.floor(wide * (1 - 2 * LEFT) / (LETTER * unit / 29))
    lines = _lines(title.said, letters, round(LINES * max(1.0, high / wide * 16 / 9)))
    x, y = wide * LEFT, high * MIDDLE - unit * 0.02 * len(lines)
    draw.text((x, y - unit * 0.028), title.name, fill=INK, font=large, anchor="ls")
    draw.rectangle((x, y, x + unit * 0.107, y + max(1, round(unit / 240))), fill=(*ACCENT, 255))
    for k, line in enumerate(lines):
        draw.text((x, y + unit * (0.068 + 0.05 * k)), line, fill=QUIET, font=small, anchor="ls")
    return np.asarray(page).astype(np.float32)


def _lines(said: str, letters: int, most: int) -> list[str]:
    """Return as many whole sentences as fit into so many lines of so many letters."""
    sentences = re.split(r"(?<=[.!?])\s+(?=[A-Z0-9])", said)
    for count in range(len(sentences), 0, -1):
        lines = textwrap.wrap(" ".join(sentences[:count]), letters)
        if len(lines) <= most:
            return lines
    return textwrap.wrap(said, letters, max_lines=most, placeholder=" ...")


def _fitting(draw: Any, words: str, size: float, width: float) -> Any:
    """Return bold letters of this height, or smaller ones where the words would be too wide."""
    font = font_of(size, bold=True)
    length = draw.textlength(words, font=font)
    return font if length <= width else font_of(size * width / length, bold=True)


def _png(picture: np.ndarray) -> bytes:
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(np.rint(np.clip(picture, 0, 255)).astype(np.uint8)).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()
