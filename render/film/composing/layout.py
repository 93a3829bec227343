"""Where words stand in a picture of any shape: title, number and rate at the upper left, the legend in a corner.

Lengths are parts of the picture's shorter side, so that letters have the same pixels in every shape of a preset.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from render.film.scene import ARC, Card, LegendRow, LineSpec
from render.letters import width_of

EDGE = 0.046
"""Distance of what is written, from the picture's edges."""
TITLE, NUMBER, RATE, LEGEND = 1 / 16, 1 / 23, 1 / 27, 1 / 25
"""Heights of letters."""
LINE = 1.4
"""From one line to the next, in heights of letters."""
SMALLER = 0.72
"""To this part letters shrink where a line is too wide, before it is broken into two."""
LEAST = 0.3
"""Nothing is smaller, as a part of its usual size."""
HALF = 0.5
"""Part of the picture's height that words at the upper left take at most."""
ROW, PAD, GAP = 1.5, 0.7, 0.8
"""Distances within the legend, in heights of letters: from row to row, around its rows, between its columns."""
Box = tuple[float, float, float, float]
"""Left, upper, right and lower edge, in parts of the picture's shorter side."""


def sides(aspect: float) -> tuple[float, float]:
    """Width and height of a picture, in its shorter side."""
    return max(1.0, aspect), max(1.0, 1 / aspect)


def lines(title: str, numbers: Sequence[str], rate: str, aspect: float) -> list[LineSpec]:
    """The lines at the upper left: the title, the number that lives (with no words, and as large as its widest value in
    ``numbers`` allows), the rate. None leaves the picture.
    """
    wide = sides(aspect)[0] - 2 * EDGE
    widest = max(numbers, key=width_of, default="")
    kept_lines: list[tuple[str, str, float, bool, bool]] = []
    if title:
        size, broken = _broken(title, TITLE, wide)
        kept_lines += [(words, words, size, True, False) for words in broken]
    if widest:
        kept_lines.append(("", widest, _fitting(widest, NUMBER, wide), False, False))
    if rate:
        kept_lines.append((rate, rate, _fitting(rate, RATE, wide), False, True))
    out, y = [], EDGE
    for words, measured, size, bold, quiet in kept_lines:
        width = size * width_of(measured, bold)
        out.append(LineSpec(words=words, x=EDGE, y=y, width=width, size=size, bold=bold, quiet=quiet))
        y += LINE * size
    return out


def box_of(lines: Sequence[LineSpec]) -> Box:
    """The place that the lines at the upper left take, from the picture's corner on; empty without lines."""
    if not lines:
        return 0.0, 0.0, 0.0, 0.0
    return 0.0, 0.0, max(line.x + line.width for line in lines), max(line.y + LINE * line.size for line in lines)


def cards(rows: Sequence[LegendRow], over: Box, aspect: float) -> dict[str, Card]:
    """The places in which a legend may be, by their corners: in the picture, and clear of the words at ``over``.

    Its letters shrink where there is no such place.
    """
    if not rows:
        return {}
    part = 1.0
    while True:
        cards_of_rows = _cards(rows, part * LEGEND, aspect)
        free = {corner: card for corner, card in cards_of_rows.items() if _is_free(card, over, aspect)}
        if free or part < LEAST:
            return free or cards_of_rows
        part *= 0.92


def _cards(rows: Sequence[LegendRow], size: float, aspect: float) -> dict[str, Card]:
    wide, high = sides(aspect)
    pad, gap = PAD * size, GAP * size
    arrows = max(2.6 * ARC * size if row.sweep else row.length * wide for row in rows)
    numbers = size * max(width_of(row.number) for row in rows)
    words = size * max(width_of(row.words) for row in rows)
    width, height = 2 * pad + arrows + gap + numbers + gap + words, 2 * pad + (ROW * len(rows) - 0.3) * size
    left, right, upper, lower = EDGE, wide - EDGE - width, EDGE, high - EDGE - height
    card = Card(
        left=left, top=lower, wide=width, high=height, size=size, pad=pad, row=ROW * size, arrows=pad + arrows,
        numbers=pad + arrows + gap, words=pad + arrows + gap + numbers + gap,
    )  # fmt: skip
    places = {"lower left": (left, lower), "lower right": (right, lower), "upper right": (right, upper)}
    return {corner: msgspec.structs.replace(card, left=x, top=y) for corner, (x, y) in places.items()}


def _is_free(card: Card, over: Box, aspect: float) -> bool:
    """Whether a card is in the picture and apart from the words."""
    wide, high = sides(aspect)
    right, lower, edge = card.left + card.wide, card.top + card.high, EDGE / 2
    inside = card.left >= edge and card.top >= edge and right <= wide - edge and lower <= high - edge
    return inside and not (card.left < over[2] + EDGE / 2 and card.top < over[3] + EDGE / 2 and over[2] > 0)


def in_picture(box: Box, aspect: float) -> Box:
    """A box in parts of the picture's width and height."""
    wide, high = sides(aspect)
    return box[0] / wide, box[1] / high, box[2] / wide, box[3] / high


def around(card: Card) -> Box:
    """The place that a legend keeps free: its card, out to the picture's edges."""
    return card.left - EDGE, card.top - EDGE, card.left + card.wide + EDGE, card.top + card.high + EDGE


def _fitting(words: str, size: float, wide: float) -> float:
    """The size of letters with which a line is not wider than that."""
    return min(size, wide / width_of(words))


def _broken(words: str, size: float, wide: float) -> tuple[float, list[str]]:
    """Size and lines of a title: in one line, if need be smaller; else in two that are as alike as they can be."""
    alone = min(size, wide / width_of(words, True))
    spaces = [k for k, letter in enumerate(words) if letter == " "]
    if alone >= SMALLER * size or not spaces:
        return alone, [words]
    at = min(spaces, key=lambda k: max(width_of(words[:k], True), width_of(words[k + 1 :], True)))
    both = [words[:at], words[at + 1 :]]
    return min(size, *(wide / width_of(line, True) for line in both)), both
