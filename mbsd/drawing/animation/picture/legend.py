"""The legend of a picture of the machine: an arrow and an arc of a round number for each quantity, in rows that fit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.quantity import written
from mbsd.drawing.animation.brush import arc, arrow, fresh
from mbsd.drawing.animation.picture.panel import LEGEND_ROW, Panel
from mbsd.drawing.animation.picture.scales import FULL_TURN
from mbsd.drawing.animation.picture.sprites import sprite
from mbsd.drawing.animation.quantities.arrows import Arc, Arrow
from mbsd.drawing.animation.words import QUANTITIES, WEIGHTS, Head
from mbsd.drawing.look import INK, QUIET

MARGIN, BETWEEN = 16.0, 22.0
"""Beside a row, and between two entries (pixels at 100 dots an inch, as all lengths here)."""
POINTS = 9.0
"""Size of the words."""
RADIUS, ROOM = 10.0, 30.0
"""Radius of an arc, and the width that it takes."""


@dataclass(frozen=True)
class Entry:
    """One sign with its words; lengths in pixels."""

    text: str
    words: float
    """Width of the words."""
    ink: str = QUIET
    arrow: float | None = None
    """Length of an arrow."""
    head: Head = "solid"
    sweep: float | None = None
    """Angle of an arc (rad)."""

    def sign(self, px: float) -> float:
        """Return the width of the sign with the gap behind it."""
        if self.arrow is not None:
            return self.arrow + 8 * px
        return ROOM * px if self.sweep is not None else 0.0

    def width(self, px: float) -> float:
        """Return the width of sign and words."""
        return self.sign(px) + self.words


def legend_rows(panel: Panel) -> list[list[Entry]]:
    """Return the entries in rows that are no wider than the panel; the first row is the upper one."""
    px = panel.dpi / 100
    room, rows, taken = panel.box[2] - 2 * MARGIN * px, [[]], 0.0
    for entry in _entries(panel):
        wide = entry.width(px)
        if rows[-1] and taken + wide > room:
            rows.append([])
            taken = 0.0
        rows[-1].append(entry)
        taken += wide + BETWEEN * px
    return rows


def paint_legend(panel: Panel, figure: Any, renderer: Any) -> float:
    """Draw the rows above the panel's lower edge, and return where the lowest one ends (pixels)."""
    px, (left, low, _, _), brush = panel.dpi / 100, panel.box, fresh(panel.brush)
    rows = legend_rows(panel)
    x = left + MARGIN * px
    for number, row in enumerate(rows):
        x, y = left + MARGIN * px, low + (19 + LEGEND_ROW * (len(rows) - 1 - number)) * px
        for entry in row:
            if entry.arrow is not None:
                arrow(brush, np.array([x, y]), np.array([entry.arrow, 0.0]), entry.ink, 3.4 * px, head=entry.head)
            elif entry.sweep is not None:
                arc(brush, np.array([x + (RADIUS + 1) * px, y]), RADIUS * px, entry.sweep, entry.ink, 2.8 * px)
            ink = QUIET if entry.arrow is None and entry.sweep is None else INK
            paint_word(figure, renderer, entry.text, x + entry.sign(px), y, ink, POINTS, "left")
            x += entry.width(px) + BETWEEN * px
    brush.paint(renderer)
    return x


def paint_word(figure: Any, renderer: Any, text: str, x: float, y: float, ink: str, size: float, side: str) -> None:
    """Write words with their ``side`` at x, their middle at height y (pixels)."""
    word = figure.text(x, y, text, color=ink, fontsize=size, ha=side, va="center", transform=None, parse_math=False)
    word.draw(renderer)


def _entries(panel: Panel) -> list[Entry]:
    """Return an entry for each kind of mark that is drawn; words alone where nothing is."""
    px, several, out = panel.dpi / 100, len(panel.quantities) > 1, list[Entry]()

    def wide(text: str) -> float:
        return float(sprite(text, POINTS, INK, panel.dpi).shape[1])

    for quantity in panel.quantities:
        words = QUANTITIES[quantity]
        for kind, unit in ((Arrow, words.unit), (Arc, words.turning)):
            mine = [mark for mark in panel.marks if mark.quantity == quantity and isinstance(mark, kind)]
            if not mine or (kind is Arc and unit == words.unit):
                continue
            scale = panel.scales[unit]
            text, part = written(scale.reference, unit), scale.reference / scale.largest
            cut = ", higher ones cut" if scale.cut else ""
            if kind is Arc:
                text += cut
                out.append(Entry(text, wide(text), words.arcs or words.colour, sweep=part * FULL_TURN))
                continue
            long = part * panel.scene.length * panel.brush.view.scale
            are_weights = {isinstance(mark, Arrow) and mark.weight for mark in mine}
            if False in are_weights:
                text += (f"  {words.title}" if several else "") + cut
                out.append(Entry(text, wide(text), words.colour, arrow=long, head=words.head))
            if are_weights == {True}:
                text += f"  weights{cut}"
                out.append(Entry(text, wide(text), WEIGHTS, arrow=long))
            elif True in are_weights:
                out.append(Entry("weights", wide("weights"), WEIGHTS, arrow=26 * px))
    if not panel.marks and panel.quantities and not panel.bars:
        titles = " and ".join(QUANTITIES[quantity].title for quantity in panel.quantities)
        text = f"no {titles}: nothing acts"
        out.append(Entry(text, wide(text)))
    return out
