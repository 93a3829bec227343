"""Bars beside the mechanism: kinetic, potential and total energy; power of each driver and force."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.base.quantity import live
from mbsd.drawing.animation.brush import Brush, Colour, rgba
from mbsd.drawing.animation.flow import Balance
from mbsd.drawing.animation.names import lay, paint_word, sprite
from mbsd.drawing.animation.words import KINETIC, POTENTIAL, TAKEN
from mbsd.drawing.look import INK, QUIET

ROWS = 4
"""Powers that are shown at most, the largest ones; fewer where there is no room."""
TRACK = "#e6e9ed"
WIDE, NARROW = 26.0, 14.0
"""Pixels (at 100 dpi) from one power to the next: below WIDE words and bars are small, and NARROW is the least."""
NOTHING = 1e-9
"""Fraction of the largest power: smaller ones are not shown."""


class Bars:
    """In a box of pixels (left, low, width, height)."""

    def __init__(self, balance: Balance, box: tuple[float, float, float, float], dpi: float) -> None:
        self.balance, self.box, self.dpi = balance, box, dpi
        peaks = {name: float(np.abs(power).max(initial=0.0)) for name, power in balance.powers.items()}
        most = max(peaks.values(), default=0.0)
        order = sorted(peaks, key=lambda name: -peaks[name])
        self.powers = [name for name in order if peaks[name] > NOTHING * most] if most > 1e-15 else []
        self.largest_power = most
        self.total = balance.kinetic + balance.potential
        self.largest = float(self.total.max(initial=0.0))
        px, (left, low, width, height) = dpi / 100, box
        head = 22 * px
        self.powers = self.powers[: min(ROWS, max(1, int((0.52 * height - head) / (NARROW * px))))]
        self.pitch = min(40 * px, (0.52 * height - head) / max(len(self.powers), 1))
        is_narrow = self.pitch < WIDE * px
        self.letters, self.half, self.above = (7.0, 1.5 * px, 7.5 * px) if is_narrow else (8.5, 5 * px, 15 * px)
        self.rows = len(self.powers) * self.pitch + head if self.powers else 0.0
        self.columns = (left, low + self.rows + 30 * px, width, height - self.rows - 62 * px)

    @property
    def has_energy(self) -> bool:
        """True if there is energy to show."""
        return self.largest > 1e-15

    def paint_still(self, figure: Any, renderer: Any) -> None:
        """Paint the words that do not change."""
        px, (left, low, width, _) = self.dpi / 100, self.box
        if self.has_energy:
            for k, word in enumerate(("kinetic", "potential", "sum")):
                paint_word(figure, renderer, word, self._column(k), self.columns[1] - 13 * px, QUIET, 8.5, "center")
        if self.powers:
            paint_word(figure, renderer, "takes", left + 2 * px, low + self.rows - 8 * px, TAKEN, 8.5, "left")
            paint_word(
                figure, renderer, "gives", left + width - 2 * px, low + self.rows - 8 * px, KINETIC, 8.5, "right"
            )
            for k, name in enumerate(self.powers):
                paint_word(figure, renderer, name, left + 2 * px, self._row(k) + self.above, INK, self.letters, "left")

    def draw(self, brush: Brush, k: int) -> None:
        """Draw the bars at picture ``k``."""
        left, _, width, _ = self.box
        kinetic, potential = float(self.balance.kinetic[k]), float(self.balance.potential[k])
        if self.has_energy:
            stacks = (((kinetic, KINETIC),), ((potential, POTENTIAL),), ((potential, POTENTIAL), (kinetic, KINETIC)))
            for number, stack in enumerate(stacks):
                self._stack(brush, self._column(number), stack)
        for number, name in enumerate(self.powers):
            y, middle = self._row(number), left + width / 2
            half = self.half
            _plate(brush, left, y - half, width, 2 * half, rgba(TRACK))
            part = float(self.balance.powers[name][k]) / self.largest_power * width / 2
            _plate(brush, middle + min(part, 0.0), y - half, abs(part), 2 * half, rgba(KINETIC if part > 0 else TAKEN))
            brush.stroke(np.array([(middle, y - 1.5 * half), (middle, y + 1.5 * half)]), rgba(QUIET), 1.0, 11)

    def lay_words(self, picture: np.ndarray, k: int) -> None:
        """Lay the numbers of picture ``k`` over it."""
        px, (left, _, width, _) = self.dpi / 100, self.box
        if self.has_energy:
            values = (self.balance.kinetic[k], self.balance.potential[k], self.total[k])
            top = self.columns[1] + self.columns[3] + 12 * px
            in_joules = live([self.largest], "J", 3)
            for number, value in enumerate(values):
                lay(picture, sprite(in_joules(float(value)), 8.5, INK, self.dpi), self._column(number), top)
        in_watts = live([self.largest_power], "W", 3)
        for number, name in enumerate(self.powers):
            word = sprite(in_watts(float(self.balance.powers[name][k])), self.letters, INK, self.dpi)
            lay(picture, word, left + width - word.shape[1] / 2 - 2 * px, self._row(number) + self.above)

    def _column(self, k: int) -> float:
        return self.columns[0] + self.columns[2] * (k + 0.5) / 3

    def _row(self, k: int) -> float:
        return self.box[1] + self.rows - 22 * self.dpi / 100 - (k + 0.72) * self.pitch

    def _stack(self, brush: Brush, x: float, stack: tuple[tuple[float, str], ...]) -> None:
        px, (_, low, _, height) = self.dpi / 100, self.columns
        half, y = 13 * px, low
        _plate(brush, x - half, low, 2 * half, height, rgba(TRACK))
        for value, ink in stack:
            high = max(value, 0.0) / self.largest * height
            _plate(brush, x - half, y, 2 * half, high, rgba(ink))
            y += high


def _plate(brush: Brush, x: float, y: float, width: float, height: float, ink: Colour) -> None:
    corners = np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])
    brush.plate(corners, ink, None, 0.0, 10.5)
