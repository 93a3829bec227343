"""Numbers and texts within a result by name, and the hash of their raw bytes."""

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

# All numbers and texts within a result, by name.


ARRAYS = ("t", "q", "v", "a", "lam", "wrench", "drives", "margin", "work", "held")


def outcome(run: Callable[[], Any]) -> Any:
    """Return the result of ``run``, or kind and text of the error that it ends with."""
    try:
        return run()
    except MechanismError as error:
        return type(error).__name__, str(error)


def contents(value: Any, name: str = "") -> Iterator[tuple[str, np.ndarray | str]]:
    """Name and value of each number, array and text within a result; numbers are arrays without axes."""
    if isinstance(value, Solution):
        yield from _of_solution(value, name)
    elif isinstance(value, JointKind | ForceKind):
        yield name, value.name
    elif isinstance(value, Model):
        return  # what was given is no result
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for field in sorted(field.name for field in dataclasses.fields(value)):
            if field not in ("model", "mechanism", "packed"):
                yield from contents(getattr(value, field), f"{name}.{field}")
    elif isinstance(value, dict):
        for key in value:
            yield from contents(value[key], f"{name}.{key}")
    elif isinstance(value, np.ndarray):
        if value.dtype != object:
            yield f"{name} {value.dtype} {value.shape}", np.ascontiguousarray(value)
    elif isinstance(value, bool | int | float | complex | np.generic):
        yield name, np.asarray(value)
    elif isinstance(value, str):
        yield name, value
    elif isinstance(value, Iterable):
        for k, part in enumerate(value):
            yield from contents(part, f"{name}[{k}]")


def _of_solution(sol: Solution, name: str) -> Iterator[tuple[str, np.ndarray | str]]:
    for field in ARRAYS:
        yield from contents(getattr(sol, field), f"{name}.{field}")
    for event in sol.events:
        yield from contents((event.time, event.name, event.what, event.impulse, event.energy), f"{name}.event")
    m = sol.mechanism
    for kind, names, view in (("force", m.forces, sol.force), ("contact", m.contacts, sol.contact)):
        for of in names:
            yield from contents(view(of), f"{name}.{kind}.{of}")
    yield from contents((sol.energy.kinetic, sol.energy.potential), f"{name}.energy")


# A hash of the raw bytes of what the solver gives.


def digest(result: Any) -> str:
    """Hash of all numbers of a result, by name; texts count too."""
    whole = hashlib.sha256()
    for name, value in contents(result):
        whole.update(name.encode() + b"\0" + (value.encode() if isinstance(value, str) else value.tobytes()))
    return whole.hexdigest()[:16]
