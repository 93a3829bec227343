"""The model's file: JSON, written whole, the same bytes for the same model; read with every refusal worded."""

from __future__ import annotations

import json
import math
import os
import tempfile
from pathlib import Path
from typing import Any

from mbsd.errors import ModelError
from mbsd.model import Mechanism
from mbsd.saving.document import build, document
from mbsd.shown import shown

DEEPEST = 30
"""Levels of objects and lists in a file."""


def save(m: Mechanism, path: str | os.PathLike[str]) -> None:
    """See :meth:`mbsd.model.Mechanism.save`."""
    written = document(m)
    _refuse_non_finite(written, m.name)
    content = json.dumps(written, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    write_whole(path, content.encode())


def load(path: str | os.PathLike[str]) -> Mechanism:
    """See :meth:`mbsd.model.Mechanism.load`."""
    _refuse_no_path(path)
    try:
        content = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise ModelError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from error
    try:
        written = json.loads(content.decode(), object_pairs_hook=lambda pairs: _no_twins(pairs, path))
    except RecursionError as error:
        raise _too_deep(path) from error
    except ValueError as error:
        raise ModelError(f"{path}: not a whole JSON file ({error}); save the model again") from error
    _refuse_non_finite(written, f"{path}: ")
    return build(written, f"{path}: model")


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file by a temporary file beside the target, then a rename: no part of a file ever has the final name."""
    _refuse_no_path(path)
    path, temporary = Path(path), None
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
        temporary = Path(name)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        os.replace(temporary, path)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise ModelError(f"cannot write {path}: {why}; choose another place or free some disk space") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _no_twins(pairs: list[tuple[str, Any]], path: object) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise ModelError(f"{path}: there are two of the name '{key}' in one object; rename or remove one")
        found[key] = value
    return found


def _refuse_no_path(path: object) -> None:
    if not isinstance(path, str | os.PathLike):
        raise ModelError(f"the path of a file is {shown(path)}; it must be a text or a path")


def _too_deep(path: object) -> ModelError:
    return ModelError(
        f"{path}: objects or lists stand within each other more than {DEEPEST} deep; a model has less: save it again"
    )


def _refuse_non_finite(value: Any, where: str, level: int = 0) -> None:
    if level > DEEPEST:
        raise _too_deep(where.partition(": ")[0])
    if isinstance(value, float) and not math.isfinite(value):
        raise ModelError(f"{where} is {value}; every number must be finite")
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inside:
        _refuse_non_finite(
            item, f"{where}[{key}]" if isinstance(key, int) else f"{where}.{key}".replace(": .", ": "), level + 1
        )
