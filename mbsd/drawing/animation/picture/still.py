"""The steady part of a picture: card, title, scale bar, legend of arrows and arcs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.quantity import written
from mbsd.drawing.animation.brush import fresh, rgba
from mbsd.drawing.animation.picture.legend import paint_legend, paint_word
from mbsd.drawing.animation.words import CARD, QUANTITIES, round_below
from mbsd.drawing.look import QUIET

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
    _scale_bar(panel, figure, renderer, paint_legend(panel, figure, renderer))
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
    paint_word(figure, renderer, written(metres, "m"), x - long - 7 * px, y, QUIET, 8.5, "right")
