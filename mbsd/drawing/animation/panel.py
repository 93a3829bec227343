"""One picture of the mechanism within a page: its place, its content, and what each frame adds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd.drawing.animation.arrows import FULL_TURN, LONGEST, Arc, Arrow, Scale, scales_of, unit_of
from mbsd.drawing.animation.bars import Bars
from mbsd.drawing.animation.brush import Brush, View, arc, arrow, fresh
from mbsd.drawing.animation.names import Placed, lay, place_names, that_matter
from mbsd.drawing.animation.scene import Scene
from mbsd.drawing.animation.trails import Trail, draw_impacts, draw_trails, impacts_of
from mbsd.drawing.animation.words import QUANTITIES, WEIGHTS
from mbsd.drawing.look import MOVED, QUIET, neutral_inks

Box = tuple[float, float, float, float]
"""Left, low, width, height in pixels."""
AROUND = 2.8
"""Room beside the machine, in units of its symbols."""
LEGEND_ROW = 20.0
"""Height of a row of the legend (pixels at 100 dots an inch)."""
NAMED_AT = 8
"""Pictures in which the places of names are tried."""
FEW_NAMES, MOST_NAMES = 3, 16
"""In a panel: those that matter, and all; of a mechanism with more, traced points alone."""
FINE = 5.0
"""Pixels of a unit below which lines are thinner."""


@dataclass(eq=False)
class Panel:
    """Where it is, and what it shows."""

    scene: Scene
    quantities: tuple[str, ...]
    box: Box
    dpi: float
    titled: bool
    """True if its own quantities stand above it: one of several."""
    names: bool | str
    """True if there are any: those that matter, or ``"all"``."""
    trails: list[Trail]
    marks: list[Arrow | Arc] = field(init=False)
    scales: dict[str, Scale] = field(init=False)
    bars: Bars | None = field(init=False, default=None)
    placed: list[Placed] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self.marks = self.scene.marks(self.quantities)
        self.scales = scales_of(self.marks, self.scene.floor)
        self.marks = [mark for mark in self.marks if self._seen(mark)]
        self.colours = neutral_inks(self.scene.tracks.views) if self.quantities else self.scene.inks
        self.brush = Brush(None, self.scene.steady.unit, dpi=self.dpi, driver=QUIET if self.quantities else MOVED)
        self.arrange(1)
        self.impacts = impacts_of(self.scene)

    def arrange(self, rows: int) -> None:
        """Divide the box into machine, bars and a legend of so many rows, and look at the machine."""
        px, (left, low, width, height) = self.dpi / 100, self.box
        top = low + height - (34 * px if self.titled else 10 * px)
        bottom = low + ((44 + LEGEND_ROW * (rows - 1)) * px if self.marks else 30 * px)
        right = left + width - 12 * px
        if "energy" in self.quantities:
            wide = min(0.36 * width, 250 * px)
            self.bars = Bars(self.scene.balance, (right - wide, bottom, wide, top - bottom), self.dpi)
            right -= wide + 8 * px
        self.room = (left + 12 * px, bottom, right, top)
        self._look_at(self._view())

    @property
    def is_empty(self) -> bool:
        """True if all its quantities are zero."""
        return not self.marks and not (self.bars is not None and self.bars.has_energy)

    def _seen(self, mark: Arrow | Arc) -> bool:
        scale = self.scales.get(unit_of(mark))
        return scale is not None and float(mark.size.max()) > 2e-3 * scale.largest

    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Return lowest and highest x, y (m) of machine and arrows."""
        scene, tips = self.scene, [np.zeros((0, 2))]
        for mark in self.marks:
            if isinstance(mark, Arrow):
                vector = self._drawn(mark)
                back = 0.5 * vector if mark.middle else 0.0
                tips += [mark.place + vector - back, mark.place - back]
        points = np.concatenate(
            [
                scene.steady.low[None] - AROUND * scene.steady.unit,
                scene.steady.high[None] + AROUND * scene.steady.unit,
                *tips,
            ]
        )
        return points.min(axis=0), points.max(axis=0)

    def _drawn(self, mark: Arrow) -> np.ndarray:
        """Return (T, 2) of an arrow as it is drawn (m)."""
        size = mark.size
        part = self.scales[unit_of(mark)].part(size) * self.scene.length
        return mark.vector * np.divide(part, size, out=np.zeros_like(size), where=size > 0)[:, None]

    def _view(self) -> View:
        left, low, right, top = self.room
        least, most = self.extent()
        size = np.maximum(most - least, 1e-9)
        scale = float(min((right - left) / size[0], (top - low) / size[1]))
        middle = (least + most) / 2
        return View(scale, (left + right) / 2 - scale * middle[0], (low + top) / 2 - scale * middle[1])

    def scale_to(self, scale: float) -> None:
        """Take another scale (pixels a metre), so that the machine is as large as in another panel."""
        least, most = self.extent()
        left, low, right, top = self.room
        middle = (least + most) / 2
        self._look_at(View(scale, (left + right) / 2 - scale * middle[0], (low + top) / 2 - scale * middle[1]))

    def _look_at(self, view: View) -> None:
        self.brush.view = view
        self.brush.thin = min(1.0, max(0.3, self.scene.steady.unit * view.scale * 100 / self.dpi / FINE))

    def place_names(self) -> None:
        """Find places for the names; the view is final."""
        if not self.names:
            return
        looked = self.scene.looked_at()
        drawn: list[Brush] = []
        for k in looked[:: max(1, len(looked) // NAMED_AT)]:
            brush = fresh(self.brush, wheels={}, turned={}, coils={}, remembers=True)
            self.scene.draw(brush, int(k), self.colours)
            drawn.append(brush)
        texts = [label.text for label in drawn[0].labels]
        if self.names == "all" and len(texts) <= MOST_NAMES:
            wanted = list(range(len(texts)))
        else:
            m = self.scene.sol.mechanism
            names = that_matter(m) if len(texts) <= MOST_NAMES else list(m.traces)
            wanted = [texts.index(name) for name in names if name in texts][:FEW_NAMES]
        self.placed = place_names(drawn, self.room, wanted)

    def paint(self, renderer: Any, picture: np.ndarray, k: int) -> None:
        """Paint machine, trails, arrows and names of picture ``k``."""
        px, scene = self.dpi / 100, self.scene
        brush = fresh(self.brush, tints=self._tints(k))
        machine = scene.drawn(brush, k, self.colours)
        draw_trails(brush, self.trails, scene.clip, k)
        draw_impacts(brush, self.impacts, scene.clip, k)
        for mark in self.marks:
            scale, words = self.scales[unit_of(mark)], QUANTITIES[mark.quantity]
            size = float(mark.size[k])
            if size == 0.0:
                continue
            part = float(scale.part(size))
            at = brush.view.pixels(mark.place[k])
            if isinstance(mark, Arc):
                radius = max(2.9 * scene.steady.unit * brush.view.scale, 15 * px)
                arc(
                    brush,
                    at,
                    radius,
                    math.copysign(part * FULL_TURN, mark.value[k]),
                    words.arcs or words.colour,
                    3.6 * px,
                )
            else:
                vector = mark.vector[k] / size * part * scene.length * brush.view.scale
                ink = WEIGHTS if mark.weight else words.colour
                tail = at - 0.5 * vector if mark.middle else at
                arrow(brush, tail, vector, ink, 3.4 * px, part >= LONGEST, words.head)
        if self.bars is not None:
            self.bars.draw(brush, k)
        corner = brush.view.left, brush.view.low
        brush.paint(renderer, machine.marks, corner)
        for name in self.placed:
            lay(picture, name.word, *(machine.anchors[name.number] + corner + name.off))
        if self.bars is not None:
            self.bars.lay_words(picture, k)

    def _tints(self, k: int) -> dict[str, tuple[str, float]]:
        """Return fillings by colour: in the picture of the energy, bodies glow with their kinetic energy."""
        if self.bars is None or not self.bars.has_energy:
            return {}
        bodies = self.scene.balance.bodies
        most = max((float(energy.max()) for energy in bodies.values()), default=0.0)
        if most <= 0.0:
            return {}
        glow = QUANTITIES["energy"].colour
        return {self.colours[n]: (glow, 0.06 + 0.6 * float(energy[k]) / most) for n, energy in bodies.items()}


def common_view(panels: Sequence[Panel]) -> None:
    """Let the machine be as large in all panels without bars."""
    alike = [panel for panel in panels if panel.bars is None]
    for panel in alike:
        panel.scale_to(min(other.brush.view.scale for other in alike))
