"""The strip beside the picture of a story: letters, curves and notes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from render.film.story import frame
from render.film.story.story import Curve
from render.film.story.words import plain
from render.letters import font_of, width_of
from shared.contract.quantity import live

# Words on dark cards, in every look alike, broken and made smaller until they fit.

INK, QUIET, CARD = (240, 243, 247), (184, 192, 203), (9, 12, 17)
CARD_ALPHA = 0.74
SIGNAL = 0.68
"""Part of a signal colour in letters."""
LINE = 1.32
"""From one line to the next, in heights of letters."""
SMALLEST = 0.74
"""To this part letters shrink before words count as too long."""


def readable(colour: str) -> tuple[int, int, int]:
    """Return a signal colour (``#rrggbb``) as letters have it on a card: a part lighter, so that red is read on
    dark.
    """
    red, green, blue = (
        round(SIGNAL * int(colour[k : k + 2], 16) + (1 - SIGNAL) * ink) for k, ink in zip((1, 3, 5), INK, strict=True)
    )
    return red, green, blue


@lru_cache(maxsize=64)
def font(size: float, bold: bool = False) -> Any:
    """Return the letters of a size in pixels."""
    return font_of(size, bold)


def broken(text: str, letters: float, most: int, bold: bool = False) -> list[str]:
    """Return the text in lines of at most so many ``letters`` heights; raises ValueError if they are more than
    ``most``.

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
    """Return lines of words, filled greedily towards the mean width."""
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
    """Return the height of letters (pixels) and lines with which a text is not wider than ``wide`` pixels.

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
    """Draw a dark card with round corners on an RGBA layer."""
    draw.rounded_rectangle(box, radius=0.45 * size, fill=(*CARD, round(255 * CARD_ALPHA * shown)))


# The strip under a story, or beside a tall machine: a panel a curve, with a playhead and marks of events.

FINE = 3
"""Curves are drawn so many times larger."""
POINTS = 500
NARROW = 1.2
"""Pictures with a smaller aspect have room for two panels."""


@dataclass
class Strip:
    """The strip of one story, for pictures of a size in pixels."""

    curves: Sequence[Curve]
    marks: Sequence[float]
    """Times (s) of events."""
    start: float
    end: float
    repeats: bool
    wide: int
    high: int
    others: Sequence[Curve] = ()
    """Curves of another variant, each drawn thinner over that of the same place."""
    side: bool = False
    """True if its panels stand over each other at the right edge of the picture, instead of in a row under it."""

    @cached_property
    def unit(self) -> int:
        """The picture's shorter side."""
        return min(self.wide, self.high)

    @cached_property
    def across(self) -> int:
        """Pixels of its width."""
        return round(frame.SIDE * self.unit) if self.side else self.wide

    @cached_property
    def tall(self) -> int:
        """Pixels of its height."""
        if self.side:
            return round(len(self.shown) * self._each + 0.6 * frame.EDGE * self.unit)
        return round(frame.STRIP * self.unit)

    @property
    def place(self) -> tuple[int, int]:
        """Its upper left corner in the picture (pixels)."""
        return self.wide - self.across, 0 if self.side else self.high - self.tall

    @property
    def _each(self) -> float:
        """Height of a panel that stands over others, with its name (pixels)."""
        room = self.high - (frame.UNDER + 0.6 * frame.EDGE) * self.unit
        return min(frame.PANEL * self.unit, room / max(len(self.shown), 1))

    @cached_property
    def shown(self) -> list[Curve]:
        """As many curves as there is room for."""
        return list(self.curves)[: 2 if self.wide / self.high < NARROW else 3]

    @cached_property
    def panels(self) -> list[tuple[float, float, float, float]]:
        """Left, upper, right and lower edge of each plot (pixels of the strip)."""
        edge, gap = frame.EDGE * self.unit, 0.05 * self.unit
        top = 1.75 * frame.SMALL * self.unit
        if self.side:
            rows = [k * self._each for k in range(len(self.shown))]
            return [(edge, row + top, self.across - edge, row + self._each - 0.2 * edge) for row in rows]
        each = (self.wide - 2 * edge - gap * (len(self.shown) - 1)) / max(len(self.shown), 1)
        low = self.tall - 0.6 * frame.EDGE * self.unit
        return [(edge + k * (each + gap), top, edge + k * (each + gap) + each, low) for k in range(len(self.shown))]

    def drawn(self, time: float) -> Any:
        """Return the strip (RGBA) with its playhead at a time of the motion (s)."""
        from PIL import Image, ImageDraw

        page = self._still.copy()
        span = self.end - self.start
        inside = self.start + (time - self.start) % span if self.repeats else min(max(time, self.start), self.end)
        head = Image.new("RGBA", (FINE * self.across, FINE * self.tall), (0, 0, 0, 0))
        fine = ImageDraw.Draw(head)
        for k, panel in enumerate(self.panels):
            x = panel[0] + (inside - self.start) / span * (panel[2] - panel[0])
            line = max(1.0, self.unit / 360) / 2
            fine.rectangle(_times((x - line, panel[1], x + line, panel[3])), fill=(*INK, 235))
            right = panel[2]
            both = (*self.others[k : k + 1], self.shown[k])
            for curve in both:
                value = float(np.interp(inside, curve.time, curve.values))
                self._dot(fine, x, self._height(k, value), _rgb(curve.colour))
                ink = _rgb(curve.colour) if self.others else (*INK, 255)
                right -= self._number(fine, k, value, right, ink, curve is not both[0])
        page.alpha_composite(head.reduce(FINE))
        return page

    def _height(self, k: int, value: float) -> float:
        """Return where a value is in a panel (pixels)."""
        low, high = self._ranges[k]
        return self.panels[k][3] - (value - low) / (high - low) * (self.panels[k][3] - self.panels[k][1])

    def _dot(self, draw: Any, x: float, y: float, ink: tuple[int, ...]) -> None:
        for radius, fill in ((0.011 * self.unit, (*INK, 255)), (0.0066 * self.unit, ink)):
            draw.ellipse(_times((x - radius, y - radius, x + radius, y + radius)), fill=fill)

    def _number(self, draw: Any, k: int, value: float, right: float, ink: tuple[int, ...], bare: bool) -> float:
        """Write the value that lives, ``bare`` of its unit; how much room (pixels) it takes, whatever it will be."""
        size = frame.SMALL * self.unit
        letters = font(FINE * size, True)
        words = self._words(k, value, bare)
        draw.text((FINE * right, FINE * self._name_height(k)), words, fill=ink, font=letters, anchor="ra")
        return self._room(k, bare)

    def _name_height(self, k: int) -> float:
        """Return where the words over a panel begin (pixels)."""
        return self.panels[k][1] - 1.3 * frame.SMALL * self.unit

    def _words(self, k: int, value: float, bare: bool) -> str:
        words = self._writers[k](value)
        return words.partition(" ")[0] if bare else words

    def _room(self, k: int, bare: bool = False) -> float:
        widest = self._words(k, -max(abs(value) for value in self._ranges[k]), bare)
        return frame.SMALL * self.unit * (width_of(widest, True) + 0.7)

    @cached_property
    def _writers(self) -> list[Any]:
        return [
            live([value for each in (curve, *self.others[k : k + 1]) for value in each.values.tolist()], curve.unit, 3)
            for k, curve in enumerate(self.shown)
        ]

    @cached_property
    def _ranges(self) -> list[tuple[float, float]]:
        """Lowest and highest value of each panel; 0 is in it."""
        out = []
        for k, curve in enumerate(self.shown):
            both = [curve.values, *([self.others[k].values] if k < len(self.others) else [])]
            low = min(0.0, *(float(values.min()) for values in both))
            high = max(0.0, *(float(values.max()) for values in both))
            out.append((low - 0.04 * (high - low), high + 0.04 * (high - low)))
        return out

    @cached_property
    def _still(self) -> Any:
        """Everything that does not move."""
        from PIL import Image, ImageDraw

        fine = Image.new("RGBA", (FINE * self.across, FINE * self.tall), (0, 0, 0, 0))
        draw = ImageDraw.Draw(fine)
        for k, (curve, panel, span) in enumerate(zip(self.shown, self.panels, self._ranges, strict=True)):
            self._axes(draw, panel, span)
            if k < len(self.others):
                self._curve(draw, self.others[k], panel, span, 1.0, _rgb(self.others[k].colour))
            self._curve(draw, curve, panel, span, 1.5, _rgb(curve.colour))
        size = frame.SMALL * self.unit
        for k, (curve, panel) in enumerate(zip(self.shown, self.panels, strict=True)):
            room = panel[2] - panel[0] - self._room(k) - (self._room(k, True) if self.others else 0.0)
            name = plain(curve.name)
            fit = min(size, max(0.6 * size, room / max(width_of(name, True), 1e-9)))
            at = (FINE * panel[0], FINE * self._name_height(k))
            draw.text(at, name, fill=(*readable(curve.colour), 255), font=font(FINE * fit, True), anchor="la")
        page = Image.new("RGBA", (self.across, self.tall), (*CARD, round(255 * CARD_ALPHA)))
        page.alpha_composite(fine.reduce(FINE))
        return page

    def _axes(self, draw: Any, panel: tuple[float, float, float, float], span: tuple[float, float]) -> None:
        zero = panel[3] + span[0] / (span[1] - span[0]) * (panel[3] - panel[1])
        thin = max(1.0, self.unit / 500) / 2
        draw.rectangle(_times((panel[0], zero - thin, panel[2], zero + thin)), fill=(*QUIET, 110))
        dash = 0.012 * self.unit
        for mark in self.marks:
            x = panel[0] + (mark - self.start) / (self.end - self.start) * (panel[2] - panel[0])
            for y in np.arange(panel[1], panel[3], 2 * dash):
                draw.rectangle(_times((x - thin, float(y), x + thin, float(y) + dash)), fill=(*QUIET, 190))

    def _curve(
        self, draw: Any, curve: Curve, panel: tuple[float, float, float, float], span: tuple[float, float],
        weight: float, ink: tuple[int, ...],
    ) -> None:  # fmt: skip
        """Draw a curve; its highest and lowest values stay, however many times there are."""
        times = np.linspace(self.start, self.end, POINTS)
        inside = curve.time[(curve.time >= self.start) & (curve.time <= self.end)]
        peaks = [curve.time[int(k)] for k in (curve.values.argmin(), curve.values.argmax())]
        times = np.unique(np.concatenate([times, inside if len(inside) < 4 * POINTS else peaks]))
        values = np.interp(times, curve.time, curve.values)
        x = panel[0] + (times - self.start) / (self.end - self.start) * (panel[2] - panel[0])
        y = panel[3] - (values - span[0]) / (span[1] - span[0]) * (panel[3] - panel[1])
        points = [(FINE * float(a), FINE * float(b)) for a, b in zip(x, y, strict=True)]
        draw.line(points, fill=ink, width=max(2, round(FINE * weight * self.unit / 360)), joint="curve")


def _times(box: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    a, b, c, d = box
    return FINE * a, FINE * b, FINE * c, FINE * d


def _rgb(colour: str) -> tuple[int, int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16), 255
