"""Frames of a story: what each one shows, and where words stand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec

from render.film.composing import sides
from render.film.framing import CameraPose
from render.film.scene import Hidden

# A frame of a story: a picture that is rendered, and its overlay.


class Picture(msgspec.Struct, kw_only=True, frozen=True):
    """A picture that Blender makes; equal ones are made once."""

    at: float
    """Frame of the loop, which may lie between two."""
    camera: CameraPose
    forces: bool = False
    """True if it is of the scene with arrows, which ``grown`` (0 .. 1) makes long."""
    grown: float = 0.0
    cut: bool = False
    """True if it is of the scene that the shot's section cuts open."""
    lifts: tuple[tuple[str, float], ...] = ()
    hidden: Hidden = ""


class Leader(msgspec.Struct, frozen=True):
    """A line from a place in the picture (parts of its size) to words at its left or right edge."""

    x: float
    y: float
    words: str
    quiet: str
    """Amount behind the words: a mass."""
    right: bool
    height: float
    """Height of the middle of the words, in parts of the picture's height."""


class Note(msgspec.Struct, frozen=True):
    """Words at a place in the picture, in parts of its size, pushed the way (dx, dy) they point."""

    x: float
    y: float
    dx: float
    dy: float
    words: str
    colour: str


class Over(msgspec.Struct, kw_only=True, frozen=True):
    """The overlay of a picture: words, strip and leaders; Blender draws none of it."""

    title: float = 0.0
    """Visibility of the title, 0 .. 1, over a picture that is darker."""
    ending: float = 0.0
    """Visibility of the words of the end."""
    caption: str = ""
    caption_shown: float = 0.0
    rate: str = ""
    strip: float = 0.0
    now: float = 0.0
    """Time of the motion (s), where the playhead of the strip is."""
    leaders: tuple[Leader, ...] = ()
    leaders_shown: float = 0.0
    notes: tuple[Note, ...] = ()
    notes_shown: float = 0.0
    dark: float = 0.0
    """Fading of the picture to the dark."""


@dataclass(frozen=True)
class Caption:
    """Words between two seconds of a shot."""

    start: float
    end: float
    text: str


@dataclass(frozen=True)
class Shot:
    """A shot: what it shows at each of its seconds."""

    name: str
    chapter: str
    seconds: float
    picture: Callable[[float], Picture]
    over: Callable[[float], Over]
    model: Callable[[float], float]
    """Time of the motion (s), without jumps where a period begins anew."""
    captions: tuple[Caption, ...] = field(default=())


def shown_in(s: float, start: float, end: float, fade: float = 0.35) -> float:
    """Return how visible something is at second ``s`` that comes at ``start`` and goes at ``end``, 0 .. 1."""
    part = min((s - start) / fade, (end - s) / fade, 1.0)
    u = max(part, 0.0)
    return u * u * (3 - 2 * u)


# Where words, strip and captions of a story stand, in parts of the picture's shorter side.

EDGE = 0.04
STRIP = 0.17
"""Height of the strip under the picture, with its edge."""
SIDE = 0.56
"""Width of the strip where it stands beside the machine, ..."""
UNDER = 0.18
"""... the height that it leaves to captions under it, ..."""
PANEL = 0.3
"""... and the height of each of its panels at most."""
CAPTION = 0.095
"""Height that a caption takes above it."""
LETTER, SMALL = 0.047, 0.034
"""Heights of letters: of captions, and of rates, names and numbers of the strip."""
LINES = 2
"""Lines of a caption at most."""
LONGEST = 85
"""Letters of a caption that tells an insight, at most, in a picture as wide as high; a wider one has room for more."""


def below(aspect: float, strip: bool) -> float:
    """Return the part of the picture's height that a camera leaves empty for caption and strip."""
    return (CAPTION + (STRIP if strip else 0.0)) / sides(aspect)[1]


def side_width(aspect: float) -> float:
    """Return the part of the picture's width that a camera leaves empty at the right for a strip."""
    return SIDE / sides(aspect)[0]


def above(aspect: float) -> float:
    """Return the same of the rate of time at the top."""
    return 0.05 / sides(aspect)[1]
