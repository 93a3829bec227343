"""Words on dark cards, in every look alike, broken and made smaller until they fit."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from render.letters import font_of, width_of

INK, QUIET, CARD = (240, 243, 247), (184, 192, 203), (9, 12, 17)
CARD_ALPHA = 0.74
SIGNAL = 0.68
"""Part of a signal colour in letters."""
LINE = 1.32
"""From one line to the next, in heights of letters."""
SMALLEST = 0.74
"""To this part letters shrink before words count as too long."""


def readable(colour: str) -> tuple[int, int, int]:
    """A signal colour (``#rrggbb``) as letters have it on a card: a part lighter, so that red is read on dark."""
    red, green, blue = (
        round(SIGNAL * int(colour[k : k + 2], 16) + (1 - SIGNAL) * ink) for k, ink in zip((1, 3, 5), INK, strict=True)
    )
    return red, green, blue


@lru_cache(maxsize=64)
def font(size: float, bold: bool = False) -> Any:
    """The letters of a size in pixels."""
    return font_of(size, bold)


def broken(text: str, letters: float, most: int, bold: bool = False) -> list[str]:
    """The text in lines of at most so many ``letters`` heights; raises ValueError if they are more than ``most``.

    Lines are as alike in width as the words let them be.
    """
    words = text.split()
    widths = [width_of(word, bold) for word in words]
    for count in range(1, most + 1):
        lines = _even(words, widths, count, width_of(" ", bold))
        if all(width_of(line, bold) <= letters for line in lines):
            return lines
    raise ValueError(f"it takes {width_of(text, bold) / letters:.1f} lines")


def _even(words: Sequence[str], widths: Sequence[float], count: int, space: float) -> list[str]:
    """Greedy lines towards the mean width."""
    mean = (sum(widths) + space * (len(words) - 1)) / count
    lines: list[list[str]] = [[]]
    length = 0.0
    for word, width in zip(words, widths, strict=True):
        if lines[-1] and length + width / 2 > mean and len(lines) < count:
            lines.append([])
            length = 0.0
        lines[-1].append(word)
        length += width + space
    return [" ".join(line) for line in lines if line]


def fitted(text: str, size: float, wide: float, most: int, bold: bool = False) -> tuple[float, list[str]]:
    """Height of letters (pixels) and lines with which a text is not wider than ``wide`` pixels.

    Raises ValueError where it is too long for ``most`` lines of the smallest letters.
    """
    part = 1.0
    while True:
        try:
            return part * size, broken(text, wide / (part * size), most, bold)
        except ValueError:
            part -= 0.065
            if part < SMALLEST:
                raise


def card(draw: Any, box: tuple[float, float, float, float], size: float, shown: float = 1.0) -> None:
    """A dark card with round corners on an RGBA layer."""
    draw.rounded_rectangle(box, radius=0.45 * size, fill=(*CARD, round(255 * CARD_ALPHA * shown)))
