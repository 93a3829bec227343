"""File of the model: JSON, written whole, the same bytes for the same model; read with clear errors."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.files import _refuse_no_path, write_whole
from mbsd.model.mechanism import Model
from mbsd.saving.document import M, build, document

DEEPEST = 30
"""Levels of objects and lists in a file."""


def save(m: Model, path: str | os.PathLike[str]) -> None:
    """See :meth:`mbsd.mechanism.Mechanism.save`."""
    written = document(m)
    _check_finite(written, m.name)
    content = json.dumps(written, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    write_whole(path, content.encode())


def load(path: str | os.PathLike[str], make: type[M]) -> M:
    """See :meth:`mbsd.mechanism.Mechanism.load`."""
    _refuse_no_path(path)
    try:
        content = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise ModelError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from error
    try:
        written = json.loads(content.decode("utf-8-sig"), object_pairs_hook=lambda pairs: _no_twins(pairs, path))
    except RecursionError as error:
        raise _too_deep(path) from error
    except ValueError as error:
        raise ModelError(f"{path}: not a whole JSON file ({error}); save the model again") from error
    _check_finite(written, f"{path}: ")
    return build(written, make, f"{path}: model")


def _no_twins(pairs: list[tuple[str, Any]], path: object) -> dict[str, Any]:
    entries: dict[str, Any] = {}
    for key, value in pairs:
        if key in entries:
            raise ModelError(f"{path}: there are two of the name '{key}' in one object; rename or remove one")
        entries[key] = value
    return entries


def _too_deep(path: object) -> ModelError:
    return ModelError(
        f"{path}: objects or lists stand within each other more than {DEEPEST} deep; a model has less: save it again"
    )


def _check_finite(value: Any, where: str, level: int = 0) -> None:
    if level > DEEPEST:
        raise _too_deep(where.partition(": ")[0])
    if isinstance(value, float) and not math.isfinite(value):
        raise ModelError(f"{where} is {value}; every number must be finite")
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inside:
        _check_finite(
            item, f"{where}[{key}]" if isinstance(key, int) else f"{where}.{key}".replace(": .", ": "), level + 1
        )
