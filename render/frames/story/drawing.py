"""A frame of a story: what was rendered, and over it title, caption, names, numbers and strip."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import msgspec
import numpy as np

from render.film.story import frame
from render.film.story.frame import Leader, Note, Over
from render.frames.story.strip import CARD, INK, LINE, QUIET, Strip, card, fitted, font, readable
from render.letters import width_of

DARK = 0.6
"""Light that a title takes from the picture behind it."""
NAME, SAID = 1 / 9.5, 1 / 26
"""Heights of letters of a title, in the picture's shorter side."""
ACCENT = (255, 142, 62)
LEFT = 0.085
LEANS = 0.15
"""Sideways part of an arrow's way from which on a number beside it stands on the side to which it leans."""
BETWEEN, JOINED = " · ", "_"
"""Between facts, and what stands for a space within one while lines are broken; names have none any more."""


@dataclass
class Drawing:
    """Lays what a story says over its pictures, which are ``wide`` x ``high`` pixels."""

    wide: int
    high: int
    name: str
    said: tuple[str, ...]
    """Sentences under the name in the title."""
    facts: str
    """The line under the name at the end."""
    strip: Strip | None
    heads: tuple[tuple[bool, float, str, str], ...] = ()
    """Names of pictures beside or over each other: whether at the right, the upper edge of the picture (in parts of the
    height), words, colour of the curves."""
    below: int = 0
    """Pixels that the strip takes below the words, ..."""
    right: int = 0
    """... and at the right of numbers."""
    _kept: tuple[Over, Any] | None = None

    @property
    def unit(self) -> int:
        """The picture's shorter side."""
        return min(self.wide, self.high)

    def frame(self, picture: Any, over: Over) -> Any:
        """Return the picture (RGB) with all that lies over it."""
        page = self._titled(picture, over) if over.title > 0 else picture.copy()
        layer = self._layer(over)
        if layer is not None:
            page.paste(layer, (0, 0), layer)
        if over.strip > 0 and self.strip is not None:
            strip = self.strip.drawn(over.now)
            page.paste(strip, self.strip.place, _faded(strip, over.strip))
        if over.dark > 0:
            from PIL import Image

            page = Image.blend(page, Image.new("RGB", page.size, CARD), over.dark)
        return page

    def _titled(self, picture: Any, over: Over) -> Any:
        light = 1.0 - DARK * over.title
        page = picture.point([round(light * value) for value in range(256)] * 3)
        words = self._title_words
        page.paste(words, (0, 0), _faded(words, over.title))
        return page

    @property
    def _title_words(self) -> Any:
        if self.wide * self.high > 2.5e6:
            return _title(self.wide, self.high, self.name, self.said)
        return _title(3 * self.wide, 3 * self.high, self.name, self.said).reduce(3)

    def _layer(self, over: Over) -> Any:
        """Return all words, on nothing; None without any."""
        if self._kept is None or self._kept[0] != msgspec.structs.replace(over, now=0.0):
            self._kept = msgspec.structs.replace(over, now=0.0), self._fine_layer(over)
        return self._kept[1]

    def _fine_layer(self, over: Over) -> Any:
        """Return drawn larger, as small letters would stand unevenly, and averaged."""
        times = 3 if self.wide * self.high <= 1e6 else 2 if self.wide * self.high <= 2.5e6 else 1
        fine = Drawing(times * self.wide, times * self.high, self.name, self.said, self.facts, None)
        fine.heads = self.heads
        if over.strip > 0 and self.strip:
            fine.below, fine.right = (0, times * self.strip.across) if self.strip.side else (times * self.strip.tall, 0)
        layer = fine._drawn(over)
        return layer.reduce(times) if layer is not None and times > 1 else layer

    def _drawn(self, over: Over) -> Any:
        """Return the words at this size."""
        from PIL import Image, ImageDraw

        if not (
            over.rate or over.caption_shown > 0 or over.leaders_shown > 0 or over.notes_shown > 0 or over.ending > 0
        ):
            return None
        page = Image.new("RGBA", (self.wide, self.high), (0, 0, 0, 0))
        draw = ImageDraw.Draw(page)
        if over.rate:
            self._rate(draw, over.rate)
        if over.rate and self.heads:
            self._heads(draw)
        for leader in over.leaders if over.leaders_shown > 0 else ():
            self._leader(draw, leader, over.leaders_shown)
        if over.notes_shown > 0:
            self._notes(draw, over.notes, over.notes_shown)
        if over.caption and over.caption_shown > 0:
            self._caption(draw, over)
        if over.ending > 0:
            ending = _ending(self.wide, self.high, self.name, self.facts)
            page.paste(ending, (0, 0), _faded(ending, over.ending))
        return page

    def _heads(self, draw: Any) -> None:
        """Draw names of variants, each with a line as its curves are."""
        size, edge = frame.LETTER * self.unit, frame.EDGE * self.unit
        for right, top, words, colour in self.heads:
            wide = size * width_of(words, True) + 3.0 * size
            x, y = self.wide - edge - wide if right else edge, top * self.high + edge
            card(draw, (x, y, x + wide, y + 1.7 * size), size)
            ink, mid = tuple(int(colour[k : k + 2], 16) for k in (1, 3, 5)), y + 0.85 * size
            draw.line((x + 0.6 * size, mid, x + 1.8 * size, mid), fill=(*ink, 255), width=max(2, round(0.16 * size)))
            draw.text((x + 2.3 * size, mid), words, fill=(*INK, 255), font=font(size, True), anchor="lm")

    def _rate(self, draw: Any, words: str) -> None:
        """Draw the rate at the upper left; beside names in the middle between them, or at the right."""
        size, edge = frame.SMALL * self.unit, frame.EDGE * self.unit
        wide, x = size * width_of(words) + 1.2 * size, edge
        if self.heads:
            x = (self.wide - wide) / 2 if self.wide > self.high else self.wide - edge - wide
        card(draw, (x, edge, x + wide, edge + 1.75 * size), size)
        draw.text((x + 0.6 * size, edge + 0.875 * size), words, fill=(*INK, 255), font=font(size), anchor="lm")

    def _caption(self, draw: Any, over: Over) -> None:
        """Draw the caption in the middle over the strip, or over where it would be."""
        size, lines = caption_lines(over.caption, self.wide, self.high)
        low = self.high - self.below - (0.35 if self.below else 0.8) * frame.EDGE * self.unit
        half = max(size * width_of(line) for line in lines) / 2 + 0.7 * size
        top, x = low - (LINE * len(lines) + 0.5) * size, self.wide / 2
        card(draw, (x - half, top, x + half, low), size, over.caption_shown)
        for k, line in enumerate(lines):
            y = top + (0.25 + LINE * (k + 0.5)) * size
            ink = (*INK, round(255 * over.caption_shown))
            draw.text((x, y), line, fill=ink, font=font(size), anchor="mm")

    def _leader(self, draw: Any, leader: Leader, shown: float) -> None:
        size, edge = frame.SMALL * self.unit * 1.08, frame.EDGE * self.unit
        at, y = (leader.x * self.wide, leader.y * self.high), leader.height * self.high
        words = size * width_of(leader.words, True)
        wide = words + (0.5 * size + size * width_of(leader.quiet) if leader.quiet else 0.0)
        left = self.wide - edge - wide - 1.1 * size if leader.right else edge
        near = left - 0.1 * size if leader.right else left + wide + 1.2 * size
        alpha = round(255 * shown)
        way = (near + (at[0] - near) * min(1.0, 1.4 * shown), y + (at[1] - y) * min(1.0, 1.4 * shown))
        thin = max(1, round(self.unit / 360))
        draw.line((near, y, *way), fill=(*CARD, round(150 * shown)), width=3 * thin)
        draw.line((near, y, *way), fill=(*INK, alpha), width=thin)
        dot = 0.008 * self.unit
        draw.ellipse((way[0] - dot, way[1] - dot, way[0] + dot, way[1] + dot), fill=(*INK, alpha))
        card(draw, (left, y - 0.85 * size, left + wide + 1.1 * size, y + 0.85 * size), size, shown)
        draw.text((left + 0.55 * size, y), leader.words, fill=(*INK, alpha), font=font(size, True), anchor="lm")
        if leader.quiet:
            at_mass = (left + 1.05 * size + words, y)
            draw.text(at_mass, leader.quiet, fill=(*QUIET, alpha), font=font(size), anchor="lm")

    def _notes(self, draw: Any, notes: tuple[Note, ...], shown: float) -> None:
        """Draw notes beyond the tips of arrows, within the picture, and apart from each other."""
        size, edge = frame.SMALL * self.unit, frame.EDGE * self.unit
        low = self.high - self.below - 0.12 * self.unit
        taken: list[tuple[float, float, float, float]] = []
        for note in notes:
            wide, high = size * width_of(note.words, True) + 1.1 * size, 1.6 * size
            x = note.x * self.wide + note.dx * (wide / 2 + 1.2 * size)
            y = note.y * self.high + note.dy * (high / 2 + 1.2 * size)
            x = min(max(x, edge + wide / 2), self.wide - self.right - edge - wide / 2)
            y = min(max(y, edge + 2.2 * size + high / 2), low - high / 2)
            if is_on_arrow((x - wide / 2, y - high / 2, x + wide / 2, y + high / 2), note, self.wide, self.high):
                away = note.dx if abs(note.dx) > LEANS else 1.0 if x < self.wide / 2 else -1.0
                x += math.copysign(wide / 2 + 1.1 * size, away)
                x = min(max(x, edge + wide / 2), self.wide - self.right - edge - wide / 2)
            for _ in range(6):
                box = (x - wide / 2, y - high / 2, x + wide / 2, y + high / 2)
                if not any(_overlap(box, other) for other in taken):
                    break
                y += -1.15 * high if y > 0.4 * self.high else 1.15 * high
            box = (x - wide / 2, y - high / 2, x + wide / 2, y + high / 2)
            taken.append(box)
            card(draw, box, size, shown)
            ink = readable(note.colour)
            draw.text((x, y), note.words, fill=(*ink, round(255 * shown)), font=font(size, True), anchor="mm")


def caption_lines(text: str, wide: int, high: int) -> tuple[float, list[str]]:
    """Return the height of letters (pixels) and lines of a caption; raises ValueError where it is too long for the
    frame.
    """
    unit = min(wide, high)
    return fitted(text, frame.LETTER * unit, wide - 2 * frame.EDGE * unit - 1.4 * frame.LETTER * unit, frame.LINES)


def png(page: Any) -> bytes:
    """Return a picture as a PNG that is made fast: it lives until ffmpeg has it."""
    buffer = io.BytesIO()
    page.save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()


def _overlap(a: tuple[float, float, float, float], b: tuple[float, float, float, float]) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def is_on_arrow(box: tuple[float, float, float, float], note: Note, wide: int, high: int) -> bool:
    """Return True if a box (pixels) that could not go farther lies on the arrow whose tip it names."""
    tip, back = np.array([note.x * wide, note.y * high]), np.linspace(0.0, 0.25 * min(wide, high), 40)
    x, y = (tip[:, None] - np.array([[note.dx], [note.dy]]) * back).tolist()
    return any(box[0] < a < box[2] and box[1] < b < box[3] for a, b in zip(x, y, strict=True))


def _faded(layer: Any, shown: float) -> Any:
    """Return the alpha of a layer, as far as it is shown."""
    alpha = layer.getchannel("A")
    return alpha if shown >= 1 else alpha.point([round(shown * value) for value in range(256)])


@lru_cache(maxsize=2)
def _title(wide: int, high: int, name: str, said: tuple[str, ...]) -> Any:
    """Return the name, a short line, and as many whole sentences as there is room for."""
    from PIL import Image, ImageDraw

    unit, page = min(wide, high), Image.new("RGBA", (wide, high), (*INK, 0))
    draw, room = ImageDraw.Draw(page), wide * (1 - 2 * LEFT)
    large = min(NAME * unit, room / width_of(name, True))
    most = max(3, round(3 * high / wide * 16 / 9))
    size, lines = _sentences(said, SAID * unit, room, most)
    x, y = wide * LEFT, high * 0.5 - 0.02 * unit * len(lines)
    draw.text((x, y - 0.03 * unit), name, fill=(*INK, 255), font=font(large, True), anchor="ls")
    draw.rectangle((x, y, x + 0.107 * unit, y + max(1, round(unit / 240))), fill=(*ACCENT, 255))
    for k, line in enumerate(lines):
        draw.text(
            (x, y + 0.055 * unit + LINE * size * (k + 0.5)), line, fill=(*QUIET, 255), font=font(size), anchor="lm"
        )
    return page


def _sentences(said: tuple[str, ...], size: float, room: float, most: int) -> tuple[float, list[str]]:
    """Return the height of letters and lines of as many sentences as fit into ``most`` lines."""
    for count in range(len(said), 0, -1):
        try:
            return fitted(" ".join(said[:count]), size, room, most)
        except ValueError:
            continue
    return size, []


def _facts(facts: str, size: float, room: float, most: int) -> tuple[float, list[str]]:
    """Return the height of letters and lines, broken between facts where that fits. Raises ValueError where nothing
    does.
    """
    whole = facts.replace(" ", JOINED).replace(f"{JOINED}·{JOINED}", "· ")
    try:
        small, lines = fitted(whole, size, room, most)
    except ValueError:
        return fitted(facts, size, room, most)
    return small, [line.replace(JOINED, " ").replace("· ", BETWEEN) for line in lines]


@lru_cache(maxsize=2)
def _ending(wide: int, high: int, name: str, facts: str) -> Any:
    """Return the name and a line of facts at the lower left, on a shade."""
    from PIL import Image, ImageDraw

    unit, page = min(wide, high), Image.new("RGBA", (wide, high), (*CARD, 0))
    draw, room = ImageDraw.Draw(page), wide * (1 - 2 * LEFT)
    small = 0.036 * unit
    try:
        small, lines = _facts(facts, small, room, 2 if wide > high else 4)
    except ValueError:
        lines = []
    large = min(0.075 * unit, room / width_of(name, True))
    deep = 1.9 * large + LINE * small * len(lines) + 0.06 * unit
    shade = 1.5 * deep
    for k in range(round(shade)):
        alpha = min(1.0, 1.4 * k / shade)
        draw.line(
            (0, high - shade + k, wide, high - shade + k), fill=(*CARD, round(205 * alpha * alpha * (3 - 2 * alpha)))
        )
    x, y = wide * LEFT, high - 0.05 * unit - LINE * small * len(lines)
    draw.text((x, y - 0.02 * unit), name, fill=(*INK, 255), font=font(large, True), anchor="ls")
    for k, line in enumerate(lines):
        words = line.strip("· ")
        draw.text((x, y + LINE * small * (k + 0.5)), words, fill=(*QUIET, 255), font=font(small), anchor="lm")
    return page
