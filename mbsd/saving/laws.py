"""Laws and other values of a model as plain data, and back.

A law is a class with a function of its name beside it, whose parameters are fields of what it returns:
``harmonic(amplitude, rate, phase, mean)`` is kept as ``{"law": "harmonic", "amplitude": ..., ...}``. So a new file in
one of LAW_PLACES is saved and loaded without a word here.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from mbsd.base.arguments import described
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import Body, Marker

CYCLES = "mbsd.model.cylinders"
"""Cycles of gas, which are kept as laws are."""
LAW_PLACES = ("mbsd.model.laws", CYCLES)
"""Folders and files of laws."""


@cache
def factories() -> dict[str, Callable[..., Any]]:
    """Return every law's function by its name, its class in small letters.

    That of ConstantRate is constant_rate.
    """
    makers: dict[str, Callable[..., Any]] = {}
    for place in LAW_PLACES:
        module = importlib.import_module(place)
        files = [f"{place}.{file.name}" for file in pkgutil.iter_modules(getattr(module, "__path__", []))]
        for file in files or [place]:
            content = vars(importlib.import_module(file))
            classes = [v for v in content.values() if isinstance(v, type) and v.__module__ == file]
            makers |= {name: content[name] for name in map(_small, classes) if callable(content.get(name))}
    return makers


def _small(law: type) -> str:
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", law.__name__).lower()


def loadable_laws() -> dict[str, Callable[..., Any]]:
    """The laws and cycles that are numbers alone, and no Python function."""
    return {
        name: factory
        for name, factory in factories().items()
        if not any("Callable" in str(p.annotation) for p in inspect.signature(factory).parameters.values())
    }


def plain(value: Any, where: str) -> Any:
    """Return ``value`` as JSON types; raises ModelError naming ``where`` for a function or live object."""
    if value is None or isinstance(value, bool | str | int | float):
        return value
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Marker):
        place = {"body": value.body.name, "x": value.x, "y": value.y, "angle": value.angle}
        return place if value.z is None else place | {"z": value.z}
    if isinstance(value, Body):
        return {"body": value.name}
    if isinstance(value, Mapping):
        return {str(key): plain(item, f"{where}.{key}") for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item, f"{where}[{k}]") for k, item in enumerate(value)]
    name = _small(type(value))
    factory = factories().get(name)
    if factory is None or type(value).__module__ != factory.__module__:
        described = f"the Python function {_name(value)}" if callable(value) else f"a {type(value).__name__}"
        raise ModelError(
            f"{where} is {described}, which a file cannot hold; give it as numbers, say with table(times, values), "
            "or build the model in Python"
        )
    return {"law": name} | {
        parameter: plain(getattr(value, parameter), where) for parameter in inspect.signature(factory).parameters
    }


def law_from(data: Mapping[str, Any], where: str) -> Any:
    """The law that :func:`plain` made ``data`` of; raises ModelError naming ``where``."""
    name = data.get("law")
    known = loadable_laws()
    factory = known.get(name) if isinstance(name, str) else None
    if factory is None:
        raise ModelError(f"{where}: {no_such('law', name, sorted(known))}")
    numbers = {key: value for key, value in data.items() if key != "law"}
    if any(isinstance(value, dict) for value in numbers.values()):
        numbers = {k: law_from(v, f"{where}.{k}") if isinstance(v, dict) else v for k, v in numbers.items()}
    arguments: list[Any] = []
    for parameter in inspect.signature(factory).parameters.values():
        if parameter.kind is inspect.Parameter.VAR_POSITIONAL:
            several = numbers.pop(parameter.name, [])
            if not isinstance(several, list | tuple):
                raise ModelError(f"{where}: {parameter.name} is {shown(several)}; it must be a list")
            arguments += several
    return called(factory, where, arguments, numbers)


def called(function: Callable[..., Any], where: str, arguments: list[Any], named: Mapping[str, Any]) -> Any:
    """``function`` called; arguments that are missing, unknown or of a wrong type become a ModelError."""
    try:
        bound = inspect.signature(function).bind(*arguments, **named)
    except TypeError as error:
        raise ModelError(f"{where}: {error}") from None
    try:
        return function(*bound.args, **bound.kwargs)
    except ModelError as error:
        raise ModelError(f"{where}: {error}") from error
    except (TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
        raise ModelError(f"{where}: a number is expected, {described(error)}") from error


def _name(value: Any) -> str:
    return f"'{getattr(value, '__qualname__', type(value).__qualname__)}'"
