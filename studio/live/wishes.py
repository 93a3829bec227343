"""What pages ask for, checked: nothing that comes from a browser is taken on trust."""

from __future__ import annotations

from typing import Any

from shared.stage.errors import UserError

LARGEST = 1e100


def finite(values: Any) -> dict[Any, float]:
    """Finite numbers by name. Raises UserError."""
    if not isinstance(values, dict):
        raise UserError("numbers come as {name: value}")
    for name, value in values.items():
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < LARGEST:
            raise UserError(f"{name} is {value!r}; it must be a finite number")
    return values


def place_of(wish: dict[str, Any]) -> dict[str, Any]:
    """What is dragged, when, and where to. Raises UserError."""
    thing, to = wish.get("thing"), wish.get("to")
    if not isinstance(thing, dict) or not isinstance(to, list) or len(to) != 2:
        raise UserError("a drag needs a thing {kind, name}, a time and a place [x, y]")
    x, y = finite(dict(enumerate(to))).values()
    time = finite({"time": wish.get("time")})["time"]
    return {"thing": {"kind": str(thing.get("kind")), "name": str(thing.get("name"))}, "time": time, "to": [x, y]}
