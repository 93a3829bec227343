"""What a frame of a story shows: a picture that is rendered, and what is laid over it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec

from render.film.framing import CameraPose
from render.film.scene import Hidden


class Picture(msgspec.Struct, kw_only=True, frozen=True):
    """A picture that Blender makes; equal ones are made once."""

    at: float
    """Frame of the loop, which may lie between two."""
    camera: CameraPose
    forces: bool = False
    """Whether it is of the scene with arrows, which ``grown`` (0 .. 1) makes long."""
    grown: float = 0.0
    cut: bool = False
    """Whether it is of the scene that the shot's section cuts open."""
    lifts: tuple[tuple[str, float], ...] = ()
    hidden: Hidden = ""


class Leader(msgspec.Struct, frozen=True):
    """A line from a place in the picture (parts of its width and height) to words at its left or right edge."""

    x: float
    y: float
    words: str
    quiet: str
    """What stands behind the words: a mass."""
    right: bool
    height: float
    """Height of the middle of the words, in parts of the picture's height."""


class Note(msgspec.Struct, frozen=True):
    """Words at a place in the picture, in parts of its width and height, pushed the way (dx, dy) they point."""

    x: float
    y: float
    dx: float
    dy: float
    words: str
    colour: str


class Over(msgspec.Struct, kw_only=True, frozen=True):
    """What is laid over a picture; all of it costs Blender nothing."""

    title: float = 0.0
    """How far the title is there, 0 .. 1, over a picture that is dark and out of focus."""
    focus: float = 0.0
    """How far that picture has become sharp."""
    ending: float = 0.0
    """How far the words of the end are there."""
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
    """How far the picture is faded to the dark."""


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
    """How far something is there at second ``s`` that comes at ``start`` and goes at ``end``, 0 .. 1."""
    part = min((s - start) / fade, (end - s) / fade, 1.0)
    u = max(part, 0.0)
    return u * u * (3 - 2 * u)
