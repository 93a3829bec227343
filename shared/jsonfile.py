"""Typed JSON files: read and written whole, checked both ways, the same bytes for the same content.

A file type is a ``msgspec.Struct`` with ``schema`` and ``schema_version`` fields. Every refusal names the
file and the field.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import msgspec

from shared.errors import UserError
from shared.files import write_bytes


def encode(document: msgspec.Struct) -> bytes:
    """Canonical bytes: fields in declaration order, shortest exact floats, one trailing newline."""
    return msgspec.json.format(msgspec.json.encode(document), indent=1) + b"\n"


def write(path: Path, document: msgspec.Struct) -> None:
    """Check ``document`` and write it whole; raises UserError, leaving an older file as it was."""
    refuse_non_finite(document, path)
    write_bytes(path, encode(document))


def read[T: msgspec.Struct](path: Path, kind: type[T]) -> T:
    """Read and check a file; raises UserError naming the file, the field and the remedy."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise UserError(f"{path} does not exist; make the stage that writes it first") from None
    except OSError as error:
        raise UserError(f"cannot read {path}: {error.strerror or error}") from error
    return decode(content, kind, path)


def decode[T: msgspec.Struct](content: bytes, kind: type[T], path: Path | str) -> T:
    """Decode and check bytes that came from ``path``."""
    _check_version(content, kind, path)
    try:
        document = msgspec.json.decode(content, type=kind)
    except msgspec.ValidationError as error:
        raise UserError(f"{path}: {_plain(str(error))}") from error
    except msgspec.DecodeError as error:
        raise UserError(f"{path}: not a whole JSON file ({error}){_last_field(content)}; make it again") from error
    refuse_non_finite(document, path)
    return document


def refuse_non_finite(document: Any, path: Path | str) -> None:
    """Raise UserError naming the first field that holds NaN or an infinity."""
    for field, value in _floats(document, ""):
        if not math.isfinite(value):
            raise UserError(f"{path}: {field} is {value}; every number must be finite")


def _check_version(content: bytes, kind: type[msgspec.Struct], path: Path | str) -> None:
    """Refuse another schema or version before its fields confuse the message."""
    expected = {f.name: f.default for f in msgspec.structs.fields(kind) if f.name in ("schema", "schema_version")}
    try:
        raw = json.loads(content)
    except ValueError:
        return  # the typed decoder words this better
    if not isinstance(raw, dict):
        raise UserError(f"{path}: expected an object at the top, found {type(raw).__name__}")
    for field, value in expected.items():
        if raw.get(field) != value:
            raise UserError(f"{path}: {field} is {raw.get(field)!r}, this program reads {value!r}; make the file again")


def _floats(value: Any, field: str) -> Any:
    if isinstance(value, float):
        yield field, value
    elif isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            yield from _floats(getattr(value, name), f"{field}.{name}" if field else name)
    elif isinstance(value, dict):
        for name, item in value.items():
            yield from _floats(item, f"{field}.{name}")
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from _floats(item, f"{field}[{index}]")


def _plain(message: str) -> str:
    """msgspec writes ``- at `$.bodies[...].x[3]` ``; say it without the dollar."""
    return re.sub(r" - at `\$\.?(.*)`", r" at \1", message)


def _last_field(content: bytes) -> str:
    fields = re.findall(rb'"([^"\\]+)"\s*:', content)
    return f", it breaks off in field '{fields[-1].decode(errors='replace')}'" if fields else ""
