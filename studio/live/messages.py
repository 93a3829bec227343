"""Messages between server and pages: their bytes, the queue of each page, and checked requests."""

from __future__ import annotations

import asyncio
import json
import math
import struct
from collections import deque
from collections.abc import Callable, Iterable
from typing import Annotated, Any, Literal

from msgspec import DecodeError, Meta, Struct, ValidationError
from msgspec.json import Decoder

from shared.stage.errors import UserError
from studio.live.numbers import LARGEST

# Message as bytes: its header's length (uint32, little endian), the header as JSON, the payload.
#
# Server and browser, and server and child, send the same frames, so a motion that a child has solved is passed on as it
# is. page/connection.js reads them.


LARGEST_FRAME = 1 << 30
"""Bytes of a frame; more is no message of ours."""


def framed(header: dict[str, Any], payload: bytes = b"") -> bytes:
    """Return the bytes of a message. Numbers that are not finite become null."""
    try:
        text = json.dumps(header, ensure_ascii=False, allow_nan=False)
    except ValueError:
        text = json.dumps(_finite(header), ensure_ascii=False, allow_nan=False)
    head = text.encode("utf-8", "replace")
    return struct.pack("<I", len(head)) + head + payload


def unframed(frame: bytes) -> tuple[dict[str, Any], bytes]:
    """Return header and payload. Raises ValueError for an invalid frame."""
    if len(frame) < 4:
        raise ValueError("a frame has four bytes at least")
    (size,) = struct.unpack_from("<I", frame)
    header = json.loads(frame[4 : 4 + size])
    if len(frame) < 4 + size or not isinstance(header, dict):
        raise ValueError("the header of a frame is a JSON object")
    return header, frame[4 + size :]


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if value - value == 0 else None
    if isinstance(value, dict):
        return {str(key): _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return value


# Messages that wait for one page: in order, but only the newest motion, so a slow page stays current.


MOST, MOST_BYTES = 256, 1 << 28
"""Messages that wait at most, and their bytes; a page that is slower than that gets the state anew."""


class Mailbox:
    """Messages from the server's loop to one page; ``anew`` gives those that replace dropped ones."""

    def __init__(self, anew: Callable[[], list[bytes]]) -> None:
        self._anew = anew
        self._waiting: deque[tuple[bytes, bool]] = deque()
        self._bytes = 0
        self._some = asyncio.Event()

    def add(self, frame: bytes, replaces: bool = False) -> None:
        """Add a frame; with ``replaces`` it takes the place of an older replaceable one."""
        if replaces:
            self._bytes -= sum(len(message) for message, replaced in self._waiting if replaced)
            self._waiting = deque(message for message in self._waiting if not message[1])
        self._append(frame, replaces)
        if len(self._waiting) > MOST or self._bytes > MOST_BYTES:
            self._waiting.clear()
            self._bytes = 0
            for message in self._anew():
                self._append(message, False)
        self._some.set()

    async def get(self) -> bytes:
        """Wait for the next frame and return it."""
        while not self._waiting:
            self._some.clear()
            await self._some.wait()
        frame, _ = self._waiting.popleft()
        self._bytes -= len(frame)
        return frame

    def _append(self, frame: bytes, replaces: bool) -> None:
        self._waiting.append((frame, replaces))
        self._bytes += len(frame)

    def __len__(self) -> int:
        return len(self._waiting)


# Requests of pages, checked: nothing that comes from a browser is trusted.


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
        raise UserError("the page's message is refused: it is nested too deeply") from error


def known(names: Iterable[str], numbers: list[dict[str, Any]]) -> None:
    """Raise UserError if one of ``names`` is no number of Params."""
    there = [number["name"] for number in numbers]
    for name in names:
        if name not in there:
            raise UserError(f"Params has no number {name!r}; it has: {', '.join(there) or 'none'}")
