"""Numbers of ``Params`` as sliders: names, values and ranges; and Params with other numbers.

A number of a tuple is called by its place: ``tracer[0]``. Its range is what the author gives,

    crank: float = field(default=0.040, metadata={"range": (0.02, 0.08)})

or follows from the value: a quarter of it to twice it, or for 0, as far to both sides as the other numbers are large.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from shared.stage.errors import UserError

PLACE = re.compile(r"\[(\d+)\]")
NAME = re.compile(r"([A-Za-z_]\w*)((?:\[\d+\])*)")
LOW, HIGH = 0.25, 2.0
"""Multiples of a value that are the ends of its range."""
LARGEST = 1e100
"""Size beyond which a number has no slider; below its inverse it counts as 0."""
DIGITS = 4
"""Number of digits of a number that no hand has typed."""
PARTS = 1000
"""A slider has so many steps."""


@dataclasses.dataclass(frozen=True)
class Number:
    """Number of Params, and the range of its slider."""

    name: str
    value: float
    low: float
    high: float
    whole: bool
    step: float


def numbers_of(p: Any) -> list[Number]:
    """Return all numbers of a dataclass, in its order. Raises UserError for an invalid range."""
    if not dataclasses.is_dataclass(p):
        return []
    numbers = []
    fields = [field for field in dataclasses.fields(p) if field.init]
    every = [abs(float(value)) for field in fields for _, value in _plain("", getattr(p, field.name))]
    usual = sorted(value for value in every if value > 1 / LARGEST)
    middle = usual[len(usual) // 2] if usual else 1.0
    for field in fields:
        given = field.metadata.get("range")
        if given is not None and not _is_range(given):
            raise UserError(
                f'Params.{field.name}: metadata={{"range": {given!r}}} is no range; write (lowest, highest), rising'
            )
        for name, value in _plain(field.name, getattr(p, field.name)):
            numbers.append(_number(name, value, given, middle))
    return numbers


def changed(p: Any, values: dict[str, float]) -> Any:
    """Return ``p`` with other numbers.

    Raises UserError for an unknown name or a value that is not finite.

    What Params itself refuses passes.
    """
    known = {number.name: number for number in numbers_of(p)}
    fields: dict[str, Any] = {}
    for name, value in values.items():
        if name not in known:
            raise UserError(f"Params has no number '{name}'; it has: {', '.join(known) or 'none'}")
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < LARGEST:
            raise UserError(f"Params.{name} cannot be {value!r}; it must be a finite number")
        exact: float | int = round(value) if known[name].whole else float(value)
        field, places = parsed(name)
        fields[field] = _with(fields.get(field, getattr(p, field)), places, exact)
    return dataclasses.replace(p, **fields) if fields else p


def in_digits(values: Mapping[str, Any]) -> dict[str, float]:
    """Return the values rounded to the digits that people write; so they are shown, solved and written."""
    return {name: float(f"{value:.{DIGITS}g}") for name, value in values.items() if isinstance(value, float)}


def parsed(name: str) -> tuple[str, list[int]]:
    """Return the field of a number, and its indices in it. Raises UserError for another name."""
    match = NAME.fullmatch(name)
    if match is None:
        raise UserError(f"{name!r} is not the name of a number of Params")
    return match[1], [int(place) for place in PLACE.findall(match[2])]


def _plain(name: str, value: Any) -> Iterator[tuple[str, float | int]]:
    if isinstance(value, tuple | list):
        for place, part in enumerate(value):
            yield from _plain(f"{name}[{place}]", part)
    elif isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST:
        yield name, value


def _number(name: str, value: float | int, given: Any, usual: float) -> Number:
    whole = isinstance(value, int)
    if given is not None:
        low, high = float(given[0]), float(given[1])
    elif whole:
        low, high = (min(1, value), max(2 * value, value + 5)) if value >= 0 else (2 * value, -value)
    elif abs(value) > 1 / LARGEST:
        ends = LOW * value, HIGH * value
        low, high = min(ends), max(ends)
    else:
        low, high = -usual, usual
    low, high = min(low, value), max(high, value)
    step = 1.0 if whole else 10.0 ** math.floor(math.log10((high - low) / PARTS))
    return Number(name, float(value), float(low), float(high), whole, step)


def _with(value: Any, places: list[int], new: float | int) -> Any:
    if not places:
        return new
    first, *rest = places
    parts = [_with(part, rest, new) if k == first else part for k, part in enumerate(value)]
    return type(value)(parts)


def _is_range(given: Any) -> bool:
    return (
        isinstance(given, tuple | list)
        and len(given) == 2
        and all(isinstance(end, int | float) and abs(end) < LARGEST for end in given)
        and given[0] < given[1]
    )
