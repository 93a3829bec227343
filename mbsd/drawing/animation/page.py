"""A page of an animation: title, time, panels and their legends.

What stands still is drawn once, and picture by picture is drawn over it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.quantity import written
from mbsd.drawing.animation.arrows import FULL_TURN, Arc, Arrow
from mbsd.drawing.animation.brush import arc, arrow, fresh, rgba
from mbsd.drawing.animation.names import paint_word, sprite
from mbsd.drawing.animation.panel import LEGEND_ROW, Box, Panel, common_view
from mbsd.drawing.animation.scene import Scene
from mbsd.drawing.animation.trails import trails_of
from mbsd.drawing.animation.words import CARD, QUANTITIES, WEIGHTS, Head, round_below
from mbsd.drawing.look import INK, QUIET
from mbsd.results.solution import Solution

HEADER = 50.0
"""Pixels at 100 dots an inch."""
GAP = 10.0
WIDE = 1280.0
"""Pixels of a picture whose words are 10 points at 100 dots an inch; in others they grow by the root of the width."""


class Page:
    """All pictures of an animation. ``groups``: the words of ``show`` of each panel."""

    def __init__(
        self,
        whole: Solution,
        scene: Scene,
        groups: Sequence[tuple[str, ...]],
        size: tuple[int, int],
        names: bool | str,
    ) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.scene, self.size = scene, size
        self.dpi = 100.0 * math.sqrt(size[0] / WIDE)
        self.figure = Figure(figsize=(size[0] / self.dpi, size[1] / self.dpi), dpi=self.dpi)
        self.figure.patch.set_facecolor("white")
        self.canvas = FigureCanvasAgg(self.figure)
        trails = trails_of(whole, scene.sol)
        several = len(groups) > 1
        boxes = self._boxes(len(groups))
        self.panels = [
            Panel(scene, tuple(group), box, self.dpi, several, names, trails)
            for group, box in zip(groups, boxes, strict=True)
        ]
        if several:
            filled = [panel for panel in self.panels if not panel.is_empty]
            if len(filled) < len(self.panels):
                self.panels = [
                    Panel(scene, panel.quantities, box, self.dpi, len(filled) > 1, names, trails)
                    for panel, box in zip(filled, self._boxes(len(filled)), strict=True)
                ] or [Panel(scene, (), self._boxes(1)[0], self.dpi, False, names, trails)]
        for panel in self.panels:
            panel.arrange(len(legend_rows(panel)))
        if several:
            common_view(self.panels)
        for panel in self.panels:
            panel.place_names()
        self._begin()

    def picture(self, k: int) -> np.ndarray:
        """Return (H, W, 4) bytes of picture ``k``; the next call changes them."""
        self.renderer.restore_region(self.still)
        self.time.set_text(self._time(k))
        self.time.draw(self.renderer)
        for panel in self.panels:
            panel.paint(self.renderer, self.pixels, k)
        return self.pixels

    def _begin(self) -> None:
        """Draw what stands still, and keep it."""
        px, (width, height) = self.dpi / 100, self.size
        mechanism, clip = self.scene.sol.mechanism, self.scene.clip
        title = mechanism.name.replace("_", " ")
        at = {"transform": None, "va": "center", "parse_math": False}
        y = height - 0.5 * (HEADER + GAP) * px
        words = [
            self.figure.text(18 * px, y, title[:1].upper() + title[1:], color=INK, fontsize=15, fontweight="bold", **at)
        ]
        self.canvas.draw()
        self.renderer: Any = self.canvas.get_renderer()
        x = 18 * px + words[0].get_window_extent(self.renderer).width + 20 * px
        if len(self.panels) == 1:
            for quantity in self.panels[0].quantities:
                words.append(
                    self.figure.text(x, y - px, QUANTITIES[quantity].title, color=QUANTITIES[quantity].colour,
                                     fontsize=11.5, fontweight="bold", **at)
                )  # fmt: skip
                x += words[-1].get_window_extent(self.renderer).width + 14 * px
        right = width - 18 * px
        self.time = self.figure.text(right, y, self._time(len(clip.times) - 1), color=INK, fontsize=13, ha="left", **at)
        wide = self.time.get_window_extent(self.renderer).width
        self.time.set_x(right - wide)
        if clip.words:
            self.figure.text(right - wide - 18 * px, y, clip.words, color=QUIET, fontsize=10.5, ha="right", **at)
        self.time.set_visible(False)
        self.canvas.draw()
        self.time.set_visible(True)
        self.renderer = self.canvas.get_renderer()
        for panel in self.panels:
            paint_still(panel, self.figure, self.renderer)
        self.still = self.canvas.copy_from_bbox(self.figure.bbox)
        self.pixels = np.asarray(self.renderer.buffer_rgba())

    def _time(self, k: int) -> str:
        """Return the time in as many decimals as tell the pictures apart."""
        times = self.scene.clip.times
        step = float(np.ptp(times)) / max(1, len(times) - 1)
        decimals = min(9, max(1, math.ceil(-math.log10(max(step, 1e-12)))))
        longest = len(f"{times[-1]:.{decimals}f}")
        return f"t = {times[k]:.{decimals}f} s".rjust(longest + 6)

    def _boxes(self, count: int) -> list[Box]:
        """Return boxes of panels: one, two in a row, four in two rows; of three the last is as wide as two."""
        px, (width, height) = self.dpi / 100, self.size
        gap, top = GAP * px, height - HEADER * px
        columns = 1 if count == 1 else 2
        rows = math.ceil(count / columns)
        wide, high = (width - (columns + 1) * gap) / columns, (top - rows * gap) / rows
        out: list[Box] = []
        for k in range(count):
            column, row = k % columns, k // columns
            last_alone = count % columns and k == count - 1 and count > 1
            out.append((gap + column * (wide + gap), top - (row + 1) * high - row * gap, wide, high))
            if last_alone:
                out[-1] = (gap, out[-1][1], width - 2 * gap, high)
        return out


def paint_still(panel: Panel, figure: Any, renderer: Any) -> None:
    """Paint what is the same in all pictures: card, title, scale bar and legend."""
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
    """Draw a scale bar of a round length at the lower right.

    It is at the upper right where words reach there (pixels).
    """
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
