"""Requests of pages, checked: nothing that comes from a browser is trusted."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Any, Literal

from msgspec import DecodeError, Meta, Struct, ValidationError
from msgspec.json import Decoder

from shared.stage.errors import UserError
from studio.live.numbers import LARGEST

PLACES = 1000
"""Number of places of a drawn path, at most."""
SHOWN = 300
"""Characters of a page's own text that are said back to it."""

Name = Annotated[str, Meta(min_length=1, max_length=200)]
Finite = Annotated[float, Meta(gt=-LARGEST, lt=LARGEST)]
Numbers = Annotated[dict[Name, Finite], Meta(max_length=10_000)]


class Thing(Struct, forbid_unknown_fields=True):
    """Joint or traced point."""

    kind: Literal["joint", "point"]
    name: Name


class Set(Struct, tag="set", tag_field="do", forbid_unknown_fields=True):
    """Numbers of sliders; ``final`` after one was released, ``arrows`` if arrows are shown."""

    values: Numbers
    final: bool = False
    arrows: bool = False


class Drag(Struct, tag="drag", tag_field="do", forbid_unknown_fields=True):
    """Drag of a thing to a place (m) at a time (s)."""

    thing: Thing
    time: Finite
    to: tuple[Finite, Finite]
    final: bool = False
    arrows: bool = False


class Undo(Struct, tag="undo", tag_field="do", forbid_unknown_fields=True):
    """Step back."""


class Redo(Struct, tag="redo", tag_field="do", forbid_unknown_fields=True):
    """Step forward."""


class Write(Struct, tag="write", tag_field="do", forbid_unknown_fields=True):
    """Request to write these numbers, or all that differ, into mechanism.py."""

    names: Annotated[list[Name], Meta(max_length=10_000)] | None = None


class Fit(Struct, tag="fit", tag_field="do", forbid_unknown_fields=True):
    """Fit of the lengths to a path (m), within bounds or within the ranges of their sliders."""

    point: Name
    path: Annotated[list[tuple[Finite, Finite]], Meta(min_length=1, max_length=PLACES)]
    closed: bool = False
    ordered: bool = False
    grashof: bool = False
    least_transmission: Annotated[float, Meta(ge=0.0, le=math.pi / 2)] = 0.0
    vary: Annotated[dict[Name, tuple[Finite, Finite]], Meta(max_length=10_000)] | None = None
    starts: Annotated[int, Meta(ge=1, le=1000)] = 2
    generations: Annotated[int, Meta(ge=1, le=100_000)] = 60
    seed: Annotated[int, Meta(ge=0, lt=1 << 32)] = 0


class Cancel(Struct, tag="cancel", tag_field="do", forbid_unknown_fields=True):
    """Request to end the fit."""


Wish = Set | Drag | Undo | Redo | Write | Fit | Cancel
KINDS = ("set", "drag", "undo", "redo", "write", "fit", "cancel")
_DECODER = Decoder(Wish)


def wish_of(text: str | bytes) -> Wish:
    """Return a page's request. Raises UserError, with the fault, for anything else."""
    try:
        return _DECODER.decode(text)
    except ValidationError as error:
        said = str(error)
        known = f"; a page asks for: {', '.join(KINDS)}" if "$.do" in said or "`do`" in said else ""
        raise UserError(f"the page's message is refused: {said[:SHOWN]}{known}") from error
    except (DecodeError, UnicodeError) as error:
        raise UserError(f"the page's message is no JSON: {str(error)[:SHOWN]}") from error
    except RecursionError as error:
        raise UserError("the page's message is refused: it is nested too deep") from error


def known(names: Iterable[str], numbers: list[dict[str, Any]]) -> None:
    """Raise UserError if one of ``names`` is no number of Params."""
    there = [number["name"] for number in numbers]
    for name in names:
        if name not in there:
            raise UserError(f"Params has no number {name!r}; it has: {', '.join(there) or 'none'}")
