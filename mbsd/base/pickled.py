"""Pickling of objects beyond the standard pickle: functions of the user, kinds of joints and forces.

A function that pickle finds again by its name is left to it. Any other, such as a lambda, goes by its code, which
takes cloudpickle; bodies, markers and mechanisms that it closes over are those that come with it, no copies.
Copies within a process hold the same functions and kinds.
"""

from __future__ import annotations

import copy
import importlib
import io
import pickle
from collections.abc import Callable, Mapping
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import Named, shown

OWN = "mbsd."
ATOMS = {float, int, str, bool, type(None), complex, bytes}


class WithFunctions:
    """Something whose fields, or the values of whose mappings, may be functions of the user."""

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields, with functions in a form that can be pickled."""
        what = f"{type(self).__name__.lower()} '{getattr(self, 'name', '')}'"
        return {key: _held(value, what) for key, value in self.__dict__.items()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore the fields, with functions as they were."""
        self.__dict__.update({key: _released(value) for key, value in state.items()})

    def __deepcopy__(self, memo: dict[int, Any]) -> Any:
        """Return a copy that holds the same functions."""
        return with_copied_fields(self, memo)


def with_copied_fields(thing: Any, memo: dict[int, Any]) -> Any:
    """Return a deep copy of an object by its ``__dict__``, twice as fast as the standard library."""
    out = object.__new__(type(thing))
    memo[id(thing)] = out
    out.__dict__.update({key: _copied(value, memo) for key, value in thing.__dict__.items()})
    return out


def _copied(value: Any, memo: dict[int, Any]) -> Any:
    kind = type(value)
    if kind in ATOMS:
        return value
    if kind is dict or kind is Named:
        parts = {key: _copied(part, memo) for key, part in value.items()}
        return Named(value.kind, parts) if kind is Named else parts
    if callable(value) and not kind.__module__.startswith(OWN):
        return value
    return copy.deepcopy(value, memo)


class ByName:
    """A kind: pickled as its place, the file that holds it as a variable, and its name."""

    name: str
    example: Any

    def __copy__(self) -> Any:
        """Return the kind itself: there is one of each."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Any:
        """Return the kind itself."""
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the kind by its name."""
        return kind_named, (getattr(self.example, "__module__", ""), self.name)


def kind_named(module: str, name: str) -> Any:
    """Return the kind of this name in a module. Raises ModelError."""
    try:
        content = list(vars(importlib.import_module(module)).values())
    except (ImportError, ValueError) as error:
        raise ModelError(f"the kind '{name}' is of {module}, which cannot be imported here: {error}") from error
    for candidate in content:
        if isinstance(candidate, ByName) and candidate.name == name:
            return candidate
    raise ModelError(f"there is no kind '{name}' in {module}; keep it in a variable at the top level of that file")


class Function:
    """A function of the user on its way through pickle."""

    def __init__(self, function: Callable[..., Any], what: str) -> None:
        self.function, self.what = function, what

    def __deepcopy__(self, memo: dict[int, Any]) -> Function:
        """Return the function itself: functions are not copied."""
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by name where that finds it, else by code. Raises ModelError for what neither can hold."""
        try:
            pickle.dumps(self.function)
        except Exception:
            return from_code, _by_code(self.function, self.what)
        return Function, (self.function, self.what)


def _by_code(function: Callable[..., Any], what: str) -> tuple[bytes, list[Any], str]:
    refused = f"{what} holds the Python function {shown(function)}, which pickle cannot hold"
    remedy = "define it with def at the top level of a file, or give numbers, say table(times, values)"
    try:
        import cloudpickle
    except ImportError:
        raise ModelError(f"{refused}; {remedy}, or install cloudpickle") from None
    own: list[Any] = []

    class Pickler(cloudpickle.Pickler):
        """Leaves what belongs to mechanisms to whoever pickles these."""

        def persistent_id(self, obj: Any) -> int | None:
            """Return the place in ``own``."""
            if isinstance(obj, type) or callable(obj) or not type(obj).__module__.startswith(OWN):
                return None
            own.append(obj)
            return len(own) - 1

    file = io.BytesIO()
    try:
        Pickler(file, protocol=5).dump(function)
    except Exception as error:
        raise ModelError(f"{refused}: {error}; {remedy}") from error
    return file.getvalue(), own, what


def from_code(code: bytes, own: list[Any], what: str) -> Function:
    """Return the function whose code this is."""

    class Unpickler(pickle.Unpickler):
        """Finds what belongs to mechanisms among what came with it."""

        def persistent_load(self, pid: Any) -> Any:
            """Return the thing at this place."""
            return own[pid]

    return Function(Unpickler(io.BytesIO(code)).load(), what)


def _held(value: Any, what: str) -> Any:
    if isinstance(value, Mapping):
        return {key: _held(part, what) for key, part in value.items()}
    if not callable(value) or isinstance(value, type):
        return value
    kind = type(value).__module__
    return value if kind.startswith((OWN, "numba.")) else Function(value, what)


def _released(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _released(part) for key, part in value.items()}
    return value.function if isinstance(value, Function) else value
