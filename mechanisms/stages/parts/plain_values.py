"""Writes a parameter's value as text for keys: equal values have equal texts in every run."""

from __future__ import annotations

import dataclasses
import enum
import hashlib
from pathlib import PurePath
from typing import Any


def plain_text(value: Any) -> str | None:
    """The text, or None for a value that has none (a function, an object of a class that is no dataclass).

    ``repr`` would not do: it shortens arrays and shows addresses of objects.
    """
    if isinstance(value, enum.Enum):
        return f"{type(value).__qualname__}.{value.name}"
    if value is None or isinstance(value, bool | int | float | complex | str | bytes):
        return f"{type(value).__name__} {value!r}"
    if isinstance(value, PurePath):
        return f"path {value.as_posix()!r}"
    if isinstance(value, list | tuple):
        return _joined(type(value).__name__, list(value))
    if isinstance(value, dict):
        return _joined("dict", [item for pair in value.items() for item in pair])
    if isinstance(value, set | frozenset):
        texts = [plain_text(item) for item in value]
        return None if None in texts else f"set {sorted(text for text in texts if text)}"
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = dataclasses.fields(value)
        return _joined(type(value).__qualname__, [getattr(value, field.name) for field in fields])
    if type(value).__module__ == "numpy" and hasattr(value, "tobytes") and not value.dtype.hasobject:
        return f"array {value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    return None


def _joined(kind: str, values: list[Any]) -> str | None:
    texts = [plain_text(value) for value in values]
    return None if None in texts else f"{kind} {texts}"
