"""Roles of the arguments of a function that adds a joint, driver, force or contact, by their types.

Marker                   one of the two markers
Body | str               a body of one of them, or its name; with None one that may be left out
str | Body               another body, which the params keep by its name
Law                      a law of time: a Motion, or a function
Amount                   a number, or a law of time
Curve, Curve | None      a characteristic curve
all others               numbers, switches, texts and lists, which Joint.params and Force.params keep by name
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import Enum
from functools import lru_cache
from typing import Any, NamedTuple

from mbsd.base.arguments import types_of
from mbsd.model.body import Body, Marker
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.mechanism import Model


class Role(Enum):
    """The role of an argument."""

    MARKER, BODY, OPTIONAL_BODY, LAW, AMOUNT, CURVE, VALUE = range(7)


class Argument(NamedTuple):
    """One argument of a function that adds something to a model."""

    name: str
    role: Role
    types: tuple[Any, ...]
    """That it may have; one that is not known where the function stands is text."""
    needed: bool
    """Whether it has no default."""
    several: bool
    """Whether it stands for any number of arguments, as ``*bodies`` does."""


@lru_cache(maxsize=512)
def arguments(add: Callable[..., Any]) -> tuple[Argument, ...]:
    """Return arguments of ``add(m, name, ...)`` after the mechanism and the name, or of a law's function."""
    known = types_of(add)
    return tuple(
        Argument(p.name, _role(known[p.name]), known[p.name], p.default is p.empty, p.kind is p.VAR_POSITIONAL)
        for p in inspect.signature(add).parameters.values()
        if p.name not in ("m", "name") and Model not in known[p.name]
    )


def _role(types: tuple[Any, ...]) -> Role:
    if Marker in types:
        return Role.MARKER
    if Body in types and types[0] is not str:
        return Role.OPTIONAL_BODY if type(None) in types else Role.BODY
    if Curve in types:
        return Role.CURVE
    if Motion in types:
        return Role.AMOUNT if float in types else Role.LAW
    return Role.VALUE
