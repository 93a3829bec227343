"""The points of a study: a full product of values, a list of points, or the rows of a table."""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sized
from typing import Any

from mbsd.base.arguments import named_parameters
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown

MOST = 10_000_000
"""Points of one study."""
REASON = "reason"
"""The column that tells why a point failed."""

Point = dict[str, Any]


def points_of(grid: Any) -> list[Point]:
    """Return the points of ``grid`` in order.

    In a product the last name varies fastest. Raises ModelError.
    """
    if isinstance(grid, Mapping):
        return _product(grid)
    rows = grid.to_dict("records") if hasattr(grid, "to_dict") and hasattr(grid, "columns") else grid
    if isinstance(rows, str | bytes) or not isinstance(rows, Iterable):
        raise ModelError(
            f"study: grid is {shown(grid)}; give names and their values {{name: [...]}}, a list of points "
            "[{name: value}, ...] or a DataFrame"
        )
    points = [_point(number, row) for number, row in enumerate(itertools.islice(rows, MOST + 1))]
    refuse_too_many(len(points), "or more ")
    return points


def refuse_too_many(count: int, more: str = "") -> None:
    """Raise ModelError for more points than a study may have."""
    if count > MOST:
        raise ModelError(f"study: a grid of {count} {more}points; take {MOST} at most, in several studies")


def refuse_names(build: Callable[..., Any], points: Iterable[Point]) -> None:
    """Raise ModelError for names that ``build`` does not take, as far as its signature says."""
    parameters = named_parameters(build)
    if parameters is None:
        return
    known = [name for name, p in parameters.items() if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    for name in dict.fromkeys(name for point in points for name in point):
        if name not in known:
            raise ModelError(f"study: build: {no_such('argument', name, known)}")


def _product(grid: Mapping[str, Any]) -> list[Point]:
    listed = {_name(name): _listed(name, values) for name, values in grid.items()}
    refuse_too_many(math.prod(map(_length, listed.values())))  # before any list is written out
    names, lists, count = [], [], 1
    for name, values in listed.items():
        names.append(name)
        lists.append([_value(name, value) for value in itertools.islice(values, MOST + 1)])
        count *= len(lists[-1])
        refuse_too_many(count, "or more ")
    return [dict(zip(names, values, strict=True)) for values in itertools.product(*lists)] if names else []


def _listed(name: str, values: Any) -> Iterable[Any]:
    """Return a number or a text is one value."""
    if isinstance(values, str | bool | int | float) or values is None or getattr(values, "shape", None) == ():
        return [values]
    if isinstance(values, Mapping) or not isinstance(values, Iterable):
        raise ModelError(f"study: values of '{name}' are {shown(values)}; give a list of values")
    return values


def _length(values: Iterable[Any]) -> int:
    """Return how many there are, at least."""
    if not isinstance(values, Sized):
        return 1
    try:
        return len(values)
    except OverflowError:  # a range may have more
        return sys.maxsize


def _point(number: int, row: Any) -> Point:
    if not isinstance(row, Mapping):
        raise ModelError(f"study: point {number} is {shown(row)}; give names and values {{name: value}}")
    return {_name(name): _value(name, value) for name, value in row.items()}


def _name(name: Any) -> str:
    if not isinstance(name, str) or not name.isidentifier():
        raise ModelError(f"study: {shown(name)} is not a name that build(...) can take as an argument")
    if name == REASON:
        raise ModelError(f"study: '{REASON}' is the column that tells why a point failed; choose another name")
    return name


def _value(name: Any, value: Any) -> Any:
    """Return numbers, texts and tuples of these, of Python's own types, so that equal points have one key."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return tuple(_value(name, part) for part in value)
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise ModelError(f"study: a value of '{name}' is {shown(value)}; give numbers, texts or tuples of these")
