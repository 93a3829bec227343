"""What stands still on a picture of the machine: card, title, scale bar, legend of arrows and arcs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.quantity import written
from mbsd.drawing.animation.brush import arc, arrow, fresh, rgba
from mbsd.drawing.animation.picture.scales import FULL_TURN
from mbsd.drawing.animation.quantities.arrows import Arc, Arrow
from mbsd.drawing.animation.words import CARD, QUANTITIES, WEIGHTS, round_below
from mbsd.drawing.look import INK, QUIET

if TYPE_CHECKING:
    from mbsd.drawing.animation.picture.panel import Panel


def paint_still(panel: Panel, figure: Any, renderer: Any) -> None:
    """Card, title, scale bar and legend."""
    px, (left, low, width, height) = panel.dpi / 100, panel.box
    card = fresh(panel.brush)
    corners = np.array([(left, low), (left + width, low), (left + width, low + height), (left, low + height)])
    card.plate(corners, rgba(CARD), None, 0.0, 0)
    card.paint(renderer)
    if panel.titled:
        x = left + 14 * px
        for quantity in panel.quantities:
            title = QUANTITIES[quantity].title
            ink = QUANTITIES[quantity].colour
            word = figure.text(0, 0, title, color=ink, fontsize=10.5, fontweight="bold", va="center", transform=None)
            word.set_position((x, low + height - 18 * px))
            word.draw(renderer)
            x += word.get_window_extent(renderer).width + 12 * px
    _scale_bar(panel, figure, renderer, _legend(panel, figure, renderer))
    if panel.bars is not None:
        panel.bars.paint_still(figure, renderer)


def _scale_bar(panel: Panel, figure: Any, renderer: Any, taken: float) -> None:
    """A length of a round number, at the lower right; at the upper right where words reach there (pixels)."""
    px, (left, low, width, height) = panel.dpi / 100, panel.box
    metres = round_below(0.16 * min(width, 500 * px) / panel.brush.view.scale)
    long, x, y = metres * panel.brush.view.scale, left + width - 14 * px, low + 17 * px
    if taken > x - long - 70 * px:
        y = low + height - 18 * px
    bar = fresh(panel.brush)
    bar.stroke(np.array([(x - long, y), (x, y)]), rgba(QUIET), 1.2, 1)
    for end in (x - long, x):
        bar.stroke(np.array([(end, y - 3 * px), (end, y + 3 * px)]), rgba(QUIET), 1.2, 1)
    bar.paint(renderer)
    _word(figure, renderer, written(metres, "m"), x - long - 7 * px, y, QUIET, 8.5, "right")


def _legend(panel: Panel, figure: Any, renderer: Any) -> float:
    """An arrow and an arc of a round number for each quantity; returns where they end (pixels)."""
    px, (left, low, _, _) = panel.dpi / 100, panel.box
    x, y, brush = left + 16 * px, low + 19 * px, fresh(panel.brush)
    several = len(panel.quantities) > 1
    for quantity in panel.quantities:
        words = QUANTITIES[quantity]
        for kind, unit in ((Arrow, words.unit), (Arc, words.turning)):
            mine = [mark for mark in panel.marks if mark.quantity == quantity and isinstance(mark, kind)]
            if not mine or (kind is Arc and unit == words.unit):
                continue
            scale = panel.scales[unit]
            text = written(scale.reference, unit)
            if kind is Arrow:
                long = scale.reference / scale.largest * panel.scene.length * panel.brush.view.scale
                arrow(brush, np.array([x, y]), np.array([long, 0.0]), words.colour, 3.4 * px, head=words.head)
                x += long + 8 * px
                text += f"  {words.title}" if several else ""
            else:
                sweep = scale.reference / scale.largest * FULL_TURN
                arc(brush, np.array([x + 11 * px, y]), 10 * px, sweep, words.arcs or words.colour, 2.8 * px)
                x += 30 * px
            if scale.cut:
                text += ", higher ones cut"
            x += _word(figure, renderer, text, x, y, INK, 9.0, "left") + 22 * px
            if kind is Arrow and any(isinstance(mark, Arrow) and mark.weight for mark in mine):
                arrow(brush, np.array([x, y]), np.array([26 * px, 0.0]), WEIGHTS, 3.4 * px)
                x += 34 * px
                x += _word(figure, renderer, "weights", x, y, INK, 9.0, "left") + 22 * px
    if not panel.marks and panel.quantities and not panel.bars:
        titles = " and ".join(QUANTITIES[quantity].title for quantity in panel.quantities)
        x += _word(figure, renderer, f"no {titles}: nothing acts", x, y, QUIET, 9.0, "left")
    brush.paint(renderer)
    return x


def _word(figure: Any, renderer: Any, text: str, x: float, y: float, ink: str, size: float, side: str) -> float:
    word = figure.text(x, y, text, color=ink, fontsize=size, ha=side, va="center", transform=None, parse_math=False)
    word.draw(renderer)
    return float(word.get_window_extent(renderer).width)
