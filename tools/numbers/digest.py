"""A hash of the raw bytes of what the solver gives."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from mbsd import MechanismError
from mbsd.model.force import ForceKind
from mbsd.model.joint import JointKind
from mbsd.model.mechanism import Model
from mbsd.results.solution import Solution

ARRAYS = ("t", "q", "v", "a", "lam", "wrench", "drives", "margin", "work", "held")


def digest(result: Any) -> str:
    """Hash of all numbers of a result, by name; texts count too."""
    found = hashlib.sha256()
    for name, value in numbers(result):
        found.update(name.encode() + b"\0" + value)
    return found.hexdigest()[:16]


def attempt(run: Callable[[], Any]) -> str:
    """Hash of what ``run`` gives, or of the error that it ends with."""
    try:
        return digest(run())
    except MechanismError as error:
        return digest((type(error).__name__, str(error)))


def numbers(value: Any, name: str = "") -> Iterator[tuple[str, bytes]]:
    """Name and bytes of each number and array within a result."""
    if isinstance(value, Solution):
        yield from _of_solution(value, name)
    elif isinstance(value, JointKind | ForceKind):
        yield name, value.name.encode()
    elif isinstance(value, Model):
        return  # what was given is no result
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for field in sorted(one.name for one in dataclasses.fields(value)):
            if field not in ("model", "mechanism", "packed"):
                yield from numbers(getattr(value, field), f"{name}.{field}")
    elif isinstance(value, dict):
        for key in value:
            yield from numbers(value[key], f"{name}.{key}")
    elif isinstance(value, np.ndarray):
        if value.dtype != object:
            yield f"{name} {value.dtype} {value.shape}", np.ascontiguousarray(value).tobytes()
    elif isinstance(value, bool | int | float | complex | np.generic):
        yield name, np.asarray(value).tobytes()
    elif isinstance(value, str):
        yield name, value.encode()
    elif isinstance(value, Iterable):
        for k, one in enumerate(value):
            yield from numbers(one, f"{name}[{k}]")


def _of_solution(sol: Solution, name: str) -> Iterator[tuple[str, bytes]]:
    for field in ARRAYS:
        yield from numbers(getattr(sol, field), f"{name}.{field}")
    for event in sol.events:
        yield from numbers((event.time, event.name, event.what, event.impulse, event.energy), f"{name}.event")
    m = sol.mechanism
    for kind, names, view in (("force", m.forces, sol.force), ("contact", m.contacts, sol.contact)):
        for one in names:
            yield from numbers(view(one), f"{name}.{kind}.{one}")
    yield from numbers((sol.energy.kinetic, sol.energy.potential), f"{name}.energy")
