"""Finds which parameters a function reads, so that a change of any other one makes nothing anew."""

from __future__ import annotations

import dataclasses
from typing import Any


def traced(params: Any) -> tuple[Any, set[str]]:
    """A stand-in for a frozen dataclass instance, and the set in which the names that are read from it collect."""
    kind = type(params)
    seen: set[str] = set()

    def read(self: Any, name: str) -> Any:
        if not name.startswith("__"):
            seen.add(name)
        elif name in ("__dict__", "__dataclass_fields__"):  # vars(), asdict(), replace() read everything
            seen.update(field.name for field in dataclasses.fields(kind))
        return object.__getattribute__(self, name)

    stand_in = object.__new__(type(kind.__name__, (kind,), {"__getattribute__": read}))
    for field in dataclasses.fields(kind):
        object.__setattr__(stand_in, field.name, getattr(params, field.name))
    return stand_in, seen


def fields_of(params: Any) -> dict[str, Any]:
    """Every field by name."""
    return {field.name: getattr(params, field.name) for field in dataclasses.fields(params)}
