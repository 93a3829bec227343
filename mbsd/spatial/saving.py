"""Files of mechanisms in space: JSON with the calls that build them.

    {"kind": "mbsd mechanism in space", "version": 1, "name": ..., "gravity": [x, y, z],
     "calls": [{"method": "revolute", "name": "A", "first": {"body": "ground"}, "at": [0, 0, 0], ...}, ...]}

A marker is {"marker": body, "place": ..., "axis": ..., "across": ...}; laws are written as planar files have them.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.files import write_whole
from mbsd.base.names import shown
from mbsd.saving.laws import law_from, plain
from mbsd.spatial.model.body import place_given
from mbsd.spatial.model.journal import Call, Fixed, Named, call_again
from mbsd.spatial.model.mechanism import Model

M = TypeVar("M", bound=Model)
KIND, VERSION = "mbsd mechanism in space", 1
UNIT = 1e-9
"""Error that a length of 1 or a right angle may have."""


def save(m: Model, path: str | os.PathLike[str]) -> None:
    """Write a mechanism to a file. Raises ModelError for functions, which no file can hold."""
    calls = []
    for call in m.calls:
        where = f"{m.name}: {call.method} '{call.name}'" if call.name else f"{m.name}: {call.method}"
        arguments = {key: _written(value, f"{where}.{key}") for key, value in call.arguments.items()}
        calls.append({"method": call.method, **arguments})
    content = {"kind": KIND, "version": VERSION, "name": m.name, "gravity": _written(m.gravity, m.name), "calls": calls}
    write_whole(path, (json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode())


def load(path: str | os.PathLike[str], make: type[M]) -> M:
    """Return the mechanism that a file describes. Raises ModelError for a file that is not one."""
    try:
        content = json.loads(Path(path).read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise ModelError(f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, RecursionError) as error:
        raise ModelError(f"{path}: not a whole JSON file ({error}); save the model again") from error
    if not isinstance(content, dict) or content.get("kind") != KIND:
        raise ModelError(f"{path}: no file of a mechanism in space; load planar ones with mbsd.Mechanism.load")
    if content.get("version") != VERSION:
        raise ModelError(f"{path}: version {shown(content.get('version'))}; this mbsd reads version {VERSION}")
    calls = content.get("calls")
    if not isinstance(calls, list) or not all(isinstance(call, dict) and "method" in call for call in calls):
        raise ModelError(f"{path}: calls are missing; it must be a list of objects with a method")
    m = make(content.get("name", ""), content.get("gravity"))
    for k, call in enumerate(calls):
        where = f"{path}: calls[{k}]"
        arguments = {key: _read(value, f"{where}.{key}") for key, value in call.items() if key != "method"}
        try:
            call_again(m, Call(call["method"], arguments))
        except (TypeError, KeyError) as error:
            raise ModelError(f"{where}: {call['method']} cannot be called so: {error}") from error
        except ModelError as error:
            raise ModelError(f"{where}: {error}") from error
    return m


def _written(value: Any, where: str) -> Any:
    if isinstance(value, Named):
        return {"body": value.name} if value.what == "body" else value.name
    if isinstance(value, Fixed):
        return {"marker": value.body, "place": value.place, "axis": value.axis, "across": value.across}
    if isinstance(value, Mapping):
        return {key: _written(part, f"{where}.{key}") for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_written(part, where) for part in value]
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return plain(value, where)


def _read(value: Any, where: str) -> Any:
    if isinstance(value, list):
        return [_read(part, where) for part in value]
    if not isinstance(value, dict):
        return value
    if "law" in value:
        return law_from(value, where)
    if "marker" in value:
        place, axis, across = (place_given(f"{where}: {key}", value.get(key)) for key in ("place", "axis", "across"))
        if max(abs(np.linalg.norm(axis) - 1), abs(np.linalg.norm(across) - 1), abs(np.dot(axis, across))) > UNIT:
            raise ModelError(f"{where}: axis and across of a marker must be perpendicular and of length 1")
        return Fixed(str(value["marker"]), place, axis, across)
    if set(value) == {"body"}:
        return Named("body", value["body"])
    return {key: _read(part, f"{where}.{key}") for key, part in value.items()}
