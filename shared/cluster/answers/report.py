"""What a worker made of a group of orders, as MessagePack, and the checks of one that came.

Dask would send Python's pickles, whose reading runs whatever the sender put into them. So a task returns bytes, and
these are read as types that are known beforehand.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Any

import msgspec

from shared.cluster.answers.wrong_answer import WrongAnswer, printable

AROUND = 1_000_000
"""Bytes of a report beside the results in it."""
IDENTITY = 100_000
"""Bytes of a worker's identity."""


class Report(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The orders of a group that were done, and what kept the worker from the others."""

    lacking: list[str] = []
    """Contents that it needs first; then nothing was done."""
    done: list[tuple[str, bytes]] = []
    """Key and result of each order that went well."""
    failed: tuple[str, str] | None = None
    """Key and reason of the one that did not, after which the group was given back."""
    seconds: float = 0.0


def encoded(value: Any) -> bytes:
    """A report or an identity as bytes."""
    return msgspec.msgpack.encode(value)


def read_report(answer: Any, keys: Sequence[str], needed: Collection[str], most: int) -> Report:
    """The report on the orders ``keys``, none of whose results has more than ``most`` bytes.

    ``needed`` are the contents that may be asked for. Raises WrongAnswer for one that is malformed or too large, speaks
    of other orders or contents, or leaves an order out without a reason.
    """
    refuse_large(len(answer) if isinstance(answer, bytes) else 0, len(keys) * most + AROUND)
    report = _decoded(answer, Report)
    if not math.isfinite(report.seconds) or report.seconds < 0.0:
        raise WrongAnswer(f"it says that its work took {report.seconds} s")
    done = [key for key, _ in report.done]
    failed = [report.failed[0]] if report.failed else []
    strange = [key for key in (*done, *failed) if key not in keys]
    if strange:
        raise WrongAnswer(f"it answers for '{printable(strange[0], 80)}', which it was not asked for")
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
    """Versions and sources of a worker by name. Raises WrongAnswer if it is anything else."""
    refuse_large(len(answer) if isinstance(answer, bytes) else 0, IDENTITY)
    return {printable(name, 80): printable(value, 80) for name, value in _decoded(answer, dict[str, str]).items()}


def refuse_large(size: int, most: int, what: str = "its answer") -> None:
    """Raise WrongAnswer for more bytes than anything that was ordered can have."""
    if size > most:
        raise WrongAnswer(f"{what} has {size / 1e6:.1f} MB, {most / 1e6:.1f} MB at most were to be expected")


def _decoded[T](answer: Any, kind: type[T]) -> T:
    if not isinstance(answer, bytes):
        raise WrongAnswer(f"it answers with {type(answer).__name__} where bytes were to be expected")
    try:
        return msgspec.msgpack.decode(answer, type=kind)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise WrongAnswer(f"its answer cannot be read ({printable(str(error))})") from error
