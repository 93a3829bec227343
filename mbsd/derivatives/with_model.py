"""A solution whose mechanism is made when it is asked for: most functions of a solution never ask."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import Any

from mbsd.model.mechanism import Model
from mbsd.results.solution import Solution


class _Later:
    """The attribute: a mechanism, or what makes one."""

    def __get__(self, sol: Any, owner: type) -> Any:
        if sol is None:
            return self
        held = sol.__dict__["mechanism"]
        if isinstance(held, Model):
            return held
        sol.__dict__["mechanism"] = made = held()
        return made

    def __set__(self, sol: Any, value: Any) -> None:
        sol.__dict__["mechanism"] = value


class _WithModel(Solution[Any]):
    mechanism = _Later()  # pyright: ignore[reportAssignmentType]


def with_model(sol: Solution, make: Callable[[], Model]) -> Solution:
    """The solution with the mechanism that ``make`` gives."""
    out = object.__new__(_WithModel)
    out.__dict__.update({part.name: sol.__dict__[part.name] for part in fields(sol)}, mechanism=make)
    return out
