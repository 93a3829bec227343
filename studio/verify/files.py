"""Files compared byte by byte, with their first difference."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any, Literal

import msgspec

# Finding of a comparison: the same, different, made from other inputs, or missing.


Verdict = Literal["same", "differs", "outdated", "missing"]


@dataclass(frozen=True)
class Finding:
    """One file, frame or film. ``outdated``: its inputs have changed since, so nothing follows."""

    what: str
    verdict: Verdict
    detail: str = ""

    def __str__(self) -> str:
        word = {"outdated": "made from other inputs", "missing": "not compared"}.get(self.verdict, self.verdict)
        return f"{self.what}: {word}{', ' * bool(self.detail)}{self.detail}"


LONGEST = 60
"""Characters of a value in a message."""


def compare(what: str, old: Path, new: Path) -> Finding:
    """Return the comparison of the existing file with the one built again."""
    if not new.is_file():
        return Finding(what, "differs", "it was not rebuilt")
    if not old.is_file():
        return Finding(what, "differs", "it does not exist, but was rebuilt")
    ours, other = old.read_bytes(), new.read_bytes()
    if ours == other:
        return Finding(what, "same", f"{len(ours)} bytes")
    if old.suffix == ".json":
        return _of_json(what, ours, other)
    return Finding(what, "differs", _first_byte(ours, other))


def _first_byte(ours: bytes, other: bytes) -> str:
    place = next((k for k, (a, b) in enumerate(zip(ours, other, strict=False)) if a != b), min(len(ours), len(other)))
    return f"from byte {place} on; {len(ours)} bytes, rebuilt {len(other)}"


def _of_json(what: str, ours: bytes, other: bytes) -> Finding:
    try:
        first, second = msgspec.json.decode(ours), msgspec.json.decode(other)
    except msgspec.DecodeError:
        return Finding(what, "differs", f"it is not whole JSON; {_first_byte(ours, other)}")
    if _inputs(first) != _inputs(second):
        return Finding(what, "outdated", "something that it follows from has changed since")
    where = _first_field(first, second, "")
    return Finding(what, "differs", f"at {where[0]}: {where[1]}, rebuilt {where[2]}" if where else "in its layout")


def _inputs(document: Any) -> Any:
    provenance = document.get("provenance") if isinstance(document, dict) else None
    return provenance.get("inputs") if isinstance(provenance, dict) else None


def _first_field(ours: Any, other: Any, path: str) -> tuple[str, str, str] | None:
    """Return path and values of the first field that differs."""
    if isinstance(ours, dict) and isinstance(other, dict):
        for name in dict.fromkeys([*ours, *other]):
            difference = _first_field(ours.get(name, _NONE), other.get(name, _NONE), f"{path}.{name}" if path else name)
            if difference:
                return difference
        return None
    if isinstance(ours, list) and isinstance(other, list):
        for k, (a, b) in enumerate(zip_longest(ours, other, fillvalue=_NONE)):
            difference = _first_field(a, b, f"{path}[{k}]")
            if difference:
                return difference
        return None
    return None if ours == other else (path, _word(ours), _word(other))


class _None:
    def __repr__(self) -> str:
        return "nothing"


_NONE = _None()


def _word(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
