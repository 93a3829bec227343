"""The grid of a study in words: ``crank=0.03:0.05:5; speed=6.28,12.6``: five values from 0.03 to 0.05, and two."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from shared.stage.errors import UserError
from shared.stage.suggestions import did_you_mean

FORM = "name=from:to:count or name=value,value, with ';' between names, as in crank=0.03:0.05:5; speed=6,12"


def grid_of(name: str, words: str, p: Any) -> dict[str, list[Any]]:
    """Values of fields of ``p`` (a Params) by name. Raises UserError for what is no grid, and for unknown fields."""
    fields = [field.name for field in dataclasses.fields(p) if field.init]
    grid: dict[str, list[Any]] = {}
    for part in filter(None, (part.strip() for part in words.split(";"))):
        field, equals, said = (piece.strip() for piece in part.partition("="))
        if not equals or not said:
            raise UserError(f"{name}: {part!r} is no part of a grid; write {FORM}")
        if field not in fields:
            raise UserError(
                f"{name}: its Params have no '{field}'; they have: {', '.join(fields)}{did_you_mean(field, fields)}"
            )
        if field in grid:
            raise UserError(f"{name}: the grid has '{field}' twice")
        grid[field] = _values(name, field, said, getattr(p, field), math.prod(map(len, grid.values())))
    if not grid:
        raise UserError(f"{name}: say what to vary: {FORM}")
    return grid


def _values(name: str, field: str, said: str, usual: Any, others: int) -> list[Any]:
    """Values of one field; ``others``: how many points those before it make."""
    if ":" in said:
        first, last, count = _range(name, field, said)
        refuse_too_many(name, others * count)
        step = (last - first) / (count - 1)
        return [first + step * k for k in range(count - 1)] + [last]
    return [_value(name, field, word.strip(), usual) for word in said.split(",")]


def refuse_too_many(name: str, count: int) -> None:
    """Raise UserError for more points than a study may have, before they are listed."""
    from mbsd.studies.points import MOST

    if count > MOST:
        raise UserError(f"{name}: a grid of {count} points; take {MOST} at most, in several studies")


def _range(name: str, field: str, said: str) -> tuple[float, float, int]:
    try:
        first, last, count = said.split(":")
        numbers = float(first), float(last), int(count)
    except ValueError as error:
        raise UserError(
            f"{name}: {field}={said} is no range; write {field}=from:to:count, as in 0.03:0.05:5"
        ) from error
    if not (math.isfinite(numbers[0]) and math.isfinite(numbers[1]) and numbers[2] >= 2):
        raise UserError(f"{name}: {field}={said} needs two finite ends and two values or more")
    return numbers


def _value(name: str, field: str, word: str, usual: Any) -> Any:
    """A value of the kind that the field has."""
    if isinstance(usual, bool):
        if word.lower() in ("true", "false"):
            return word.lower() == "true"
        raise UserError(f"{name}: {field}={word} must be true or false")
    if isinstance(usual, str):
        return word
    if isinstance(usual, int | float):
        try:
            number = int(word) if isinstance(usual, int) else float(word)
        except ValueError as error:
            raise UserError(f"{name}: {field}={word} must be a {'whole ' * isinstance(usual, int)}number") from error
        if math.isfinite(number):
            return number
        raise UserError(f"{name}: {field}={word} must be finite")
    raise UserError(
        f"{name}: {field} is {type(usual).__name__}; a grid on the command line varies numbers, words and bools"
    )
