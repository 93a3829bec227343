"""Results of a worker for a group of orders, as bytes, and the checks of received ones.

Dask would send Python's pickles, whose reading runs whatever the sender put into them. So a task returns bytes: the
length of a header (4 bytes, big-endian), the header in JSON, and the results one after the other.
"""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from typing import Any

AROUND = 4_000_000
"""Bytes of a report beside the results in it."""
IDENTITY = 100_000
"""Bytes of a worker's identity."""
OF_LENGTH = 4

Key = Any
"""Name of an order: a text or a whole number."""


@dataclass
class Report:
    """The orders of a group that were done, and what kept the worker from the others."""

    lacking: list[str] = field(default_factory=list)
    """Contents that it needs first; then nothing was done."""
    done: list[tuple[Key, bytes]] = field(default_factory=list)
    """Key and result of each order that went well."""
    failed: tuple[Key, str] | None = None
    """Key and reason of the one that did not, after which the group was given back."""
    note: bytes = b""
    """Note on all these results together."""
    seconds: float = 0.0


def encoded(report: Report) -> bytes:
    """Return the report as bytes."""
    contents = [content for _, content in report.done]
    header = {
        "lacking": report.lacking,
        "done": [[key, len(content)] for key, content in report.done],
        "failed": report.failed,
        "note": len(report.note),
        "seconds": float(report.seconds),
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    return b"".join([len(text).to_bytes(OF_LENGTH, "big"), text, *contents, report.note])


def read_report(answer: Any, keys: Sequence[Key], needed: Collection[str], most: int) -> Report:
    """Return the report on the orders ``keys``, none of whose results has more than ``most`` bytes.

    ``needed`` are the contents that may be asked for. Raises WrongAnswer for one that is malformed or too large, speaks
    of other orders or contents, or leaves an order out without a reason.
    """
    refuse_large(len(answer) if isinstance(answer, bytes) else 0, len(keys) * most + AROUND)
    report = _decoded(answer)
    if not math.isfinite(report.seconds) or report.seconds < 0.0:
        raise WrongAnswer(f"it says that its work took {report.seconds} s")
    done = [key for key, _ in report.done]
    failed = [report.failed[0]] if report.failed else []
    asked = set(keys)
    strange = [key for key in (*done, *failed) if key not in asked]
    if strange:
        raise WrongAnswer(f"it answers for '{printable(str(strange[0]), 80)}', which it was not asked for")
    if len(set(done) | set(failed)) < len(done) + len(failed):
        raise WrongAnswer("it answers more than once for one order")
    if report.lacking and (done or failed or not set(report.lacking) <= set(needed)):
        raise WrongAnswer("it asks for inputs that do not belong to its orders")
    if not report.lacking and not failed and len(done) < len(keys):
        raise WrongAnswer(f"it answers for {len(done)} of {len(keys)} orders and does not say why")
    for key, content in report.done:
        refuse_large(len(content), most, f"its answer for '{key}'")
    return report


def read_identity(answer: Any) -> dict[str, str]:
    """Return versions and sources of a worker by name, from JSON.

    Raises WrongAnswer if it is anything else.
    """
    if isinstance(answer, BaseException):
        raise WrongAnswer(printable(f"{type(answer).__name__}: {answer}"))
    refuse_large(len(answer) if isinstance(answer, bytes) else 0, IDENTITY)
    document = _json(answer)
    if not isinstance(document, dict) or not all(isinstance(value, str) for value in document.values()):
        raise WrongAnswer("what it says of itself is no list of versions")
    return {printable(name, 80): printable(value, 80) for name, value in document.items()}


def refuse_large(size: int, most: int, what: str = "its answer") -> None:
    """Raise WrongAnswer for more bytes than anything that was ordered can have."""
    if size > most:
        raise WrongAnswer(f"{what} has {size / 1e6:.1f} MB, {most / 1e6:.1f} MB at most were to be expected")


def _decoded(answer: Any) -> Report:
    end = OF_LENGTH + int.from_bytes(answer[:OF_LENGTH], "big") if isinstance(answer, bytes) else 0
    match _json(answer[OF_LENGTH:end] if end else answer):
        case {
            "lacking": [*lacking],
            "done": [*done],
            "failed": None | [str() | int(), str()] as failed,
            "note": int() as note,
            "seconds": float() as seconds,
            **others,
        } if not others and all(map(_is_entry, done)) and all(isinstance(name, str) for name in lacking):
            if note < 0 or end + sum(length for _, length in done) + note != len(answer):
                raise WrongAnswer("its answer has another length than it says")
            results = []
            for key, length in done:
                results.append((key, answer[end : end + length]))
                end += length
            return Report(lacking, results, (failed[0], str(failed[1])) if failed else None, answer[end:], seconds)
    raise WrongAnswer("its answer cannot be read (it is no report)")


def _is_entry(entry: Any) -> bool:
    """True if this is a key with a length."""
    return (
        isinstance(entry, list)
        and len(entry) == 2
        and type(entry[0]) in (str, int)
        and type(entry[1]) is int
        and entry[1] >= 0
    )


def _json(answer: Any) -> Any:
    if not isinstance(answer, bytes):
        raise WrongAnswer(f"it answers with {type(answer).__name__} where bytes were to be expected")
    try:
        return json.loads(answer)
    except (ValueError, RecursionError) as error:
        raise WrongAnswer(f"its answer cannot be read ({printable(str(error))})") from error


LONGEST = 400
"""Characters of a text from elsewhere that are shown."""


class WrongAnswer(Exception):
    """A worker sent something else than ordered; the message tells what.

    No other worker is to blame.
    """


def printable(text: str, longest: int = LONGEST) -> str:
    """Return a text from another computer for a message: one line of printable characters.

    It is cut where it is too long.
    """
    line = "".join(letter if letter.isprintable() else " " for letter in text[: longest + 1])
    line = " ".join(line.split())
    return line if len(text) <= longest else f"{line[:longest]}..."
