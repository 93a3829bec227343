"""Files compared byte by byte, and where they differ first."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path
from typing import Any

import msgspec

from studio.verify.finding import Finding

LONGEST = 60
"""Characters of a value in a message."""


def compared(what: str, old: Path, new: Path) -> Finding:
    """The file that is there beside the one made again."""
    if not new.is_file():
        return Finding(what, "differs", "it was not made again")
    if not old.is_file():
        return Finding(what, "differs", "it is not there, but was made again")
    one, other = old.read_bytes(), new.read_bytes()
    if one == other:
        return Finding(what, "same", f"{len(one)} bytes")
    if old.suffix == ".json":
        return _of_json(what, one, other)
    return Finding(what, "differs", _first_byte(one, other))


def _first_byte(one: bytes, other: bytes) -> str:
    place = next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))
    return f"from byte {place} on; {len(one)} bytes, made again {len(other)}"


def _of_json(what: str, one: bytes, other: bytes) -> Finding:
    try:
        first, second = msgspec.json.decode(one), msgspec.json.decode(other)
    except msgspec.DecodeError:
        return Finding(what, "differs", f"it is not whole JSON; {_first_byte(one, other)}")
    if _inputs(first) != _inputs(second):
        return Finding(what, "outdated", "something that it follows from has changed since")
    where = _first_field(first, second, "")
    return Finding(what, "differs", f"at {where[0]}: {where[1]}, made again {where[2]}" if where else "in its layout")


def _inputs(document: Any) -> Any:
    provenance = document.get("provenance") if isinstance(document, dict) else None
    return provenance.get("inputs") if isinstance(provenance, dict) else None


def _first_field(one: Any, other: Any, path: str) -> tuple[str, str, str] | None:
    """Path and values of the first field that differs."""
    if isinstance(one, dict) and isinstance(other, dict):
        for name in dict.fromkeys([*one, *other]):
            found = _first_field(one.get(name, _NONE), other.get(name, _NONE), f"{path}.{name}" if path else name)
            if found:
                return found
        return None
    if isinstance(one, list) and isinstance(other, list):
        for k, (a, b) in enumerate(zip_longest(one, other, fillvalue=_NONE)):
            found = _first_field(a, b, f"{path}[{k}]")
            if found:
                return found
        return None
    return None if one == other else (path, _word(one), _word(other))


class _None:
    def __repr__(self) -> str:
        return "nothing"


_NONE = _None()


def _word(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
