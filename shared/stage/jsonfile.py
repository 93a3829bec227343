"""Typed JSON files: read and written whole, checked both ways, the same bytes for the same content.

A file type is a ``msgspec.Struct`` with ``schema`` and ``schema_version`` fields. Every refusal names the
file and the field.
"""

from __future__ import annotations

import json
import math
import re
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec

from shared.stage.errors import UserError
from shared.stage.files import write_bytes


class _Header(msgspec.Struct):
    """Header that is read first, so that another version is not blamed on its fields."""

    schema: Any = None
    schema_version: Any = None


def encode(document: msgspec.Struct) -> bytes:
    """Return canonical bytes: fields in declaration order, shortest exact floats, one newline at the end."""
    return msgspec.json.format(msgspec.json.encode(document), indent=1) + b"\n"


def write(path: Path, document: msgspec.Struct) -> None:
    """Check numbers, types and ranges of ``document`` and write it whole.

    Raises UserError naming the field, and leaves an older file as it was.
    """
    refuse_non_finite(document, path)
    content = encode(document)
    decode(content, type(document), path)
    write_bytes(path, content)


def read[T: msgspec.Struct](path: Path, kind: type[T]) -> T:
    """Read and check a file; raises UserError naming the file, the field and the remedy."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise UserError(f"{path} does not exist; run the stage that writes it first") from None
    except OSError as error:
        raise UserError(f"cannot read {path}: {error.strerror or error}") from error
    return decode(content, kind, path)


def decode[T: msgspec.Struct](content: bytes, kind: type[T], path: Path | str) -> T:
    """Decode and check bytes from ``path``; raises UserError naming the file, the field and the remedy."""
    try:
        content.decode()  # msgspec looks at the bytes of a text only where it is asked for
        header = msgspec.json.decode(content, type=_Header)
        _refuse_other_version(header, kind, path)
        document = msgspec.json.decode(content, type=kind)
        refuse_non_finite(document, path)
        if encode(document) != content:  # never so for a file that this program wrote
            _refuse_doubled(content, path)
    except UnicodeDecodeError as error:
        raise UserError(
            f"{path}: byte {error.start} is {content[error.start]:#04x}, which is not UTF-8; rebuild it"
        ) from error
    except RecursionError as error:
        raise UserError(f"{path}: it is nested too deeply for this kind of file; rebuild it") from error
    except msgspec.DecodeError as error:
        raise UserError(f"{path}: {_reason(content, kind, error)}") from error
    return document


def refuse_non_finite(document: Any, path: Path | str) -> None:
    """Raise UserError naming the first field that holds NaN or an infinity."""
    for field, value in _floats(document, ""):
        if not math.isfinite(value):
            raise UserError(f"{path}: {field} is {value}; every number must be finite")


def _refuse_doubled(content: bytes, path: Path | str) -> None:
    """Raise UserError naming the first field that an object has twice.

    A decoder would take the last in silence.
    """

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        fields = dict(pairs)
        if len(fields) < len(pairs):
            doubled = next(name for name in fields if sum(name == other for other, _ in pairs) > 1)
            raise UserError(f"{path}: it has the field '{doubled}' more than once in one object; keep one of them")
        return fields

    json.loads(content, object_pairs_hook=unique)


def _refuse_other_version(header: _Header, kind: type[msgspec.Struct], path: Path | str) -> None:
    for field in msgspec.structs.fields(kind):
        if field.name not in _Header.__struct_fields__:
            continue
        version, read = getattr(header, field.name), typing.get_args(field.type)
        if type(version) is bool or version not in read:
            said = "missing" if version is None else repr(version)
            reads = " or ".join(repr(known) for known in read)
            raise UserError(f"{path}: {field.name} is {said}, this program reads {reads}; make the file again")


def _reason(content: bytes, kind: type[msgspec.Struct], error: msgspec.DecodeError) -> str:
    """Return why the typed decoder rejected ``content``, with the field.

    It is slow, but rarely needed.
    """
    try:
        raw = json.loads(content)  # takes NaN and Infinity, so that they can be named
    except (ValueError, RecursionError):
        return f"not a whole JSON file ({error}){_last_field(content)}; make it again"
    if not isinstance(raw, dict):
        return f"expected an object at the top, found {type(raw).__name__}"
    try:
        _refuse_other_version(msgspec.convert(raw, _Header), kind, "")
        refuse_non_finite(raw, "")
    except UserError as refusal:
        return str(refusal).removeprefix(": ")
    return next(_complaints(raw, kind, ""), str(error))


def _complaints(raw: Any, kind: Any, field: str) -> Iterator[str]:
    """Yield complaints on entries that do not convert, down to those of dictionaries and structs.

    msgspec hides the key of a dictionary behind ``[...]``, so each entry is converted on its own.
    """
    try:
        msgspec.convert(raw, kind)
        return
    except msgspec.ValidationError as error:
        message = str(error)
    if isinstance(raw, dict) and isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        for inner in msgspec.structs.fields(kind):
            if inner.name in raw:
                yield from _complaints(raw[inner.name], inner.type, f"{field}.{inner.name}" if field else inner.name)
    elif isinstance(raw, dict) and typing.get_origin(kind) is dict:
        for key, value in raw.items():
            yield from _complaints(value, typing.get_args(kind)[1], f"{field}.{key}")
    known = _literals(kind) if message.startswith("Invalid enum") else []
    yield _placed(message, field) + (f"; known: {', '.join(known)}" if known else "")


def _literals(kind: Any) -> list[str]:
    """Return the words that a field, or each entry of it, may hold."""
    inner = typing.get_args(kind)
    if typing.get_origin(kind) is typing.Literal:
        return list(map(str, inner))
    return [word for member in inner for word in _literals(member)]


def _placed(message: str, field: str) -> str:
    """Return the message with the whole field, without the dollar.

    msgspec writes ``- at `$.x[3]` `` below the thing it converted.
    """
    reason, _, inner = message.partition(" - at `$")
    whole = (field + inner.rstrip("`")).lstrip(".")
    return f"{reason} at {whole}" if whole else reason


def _floats(value: Any, field: str) -> Iterator[tuple[str, float]]:
    if isinstance(value, float):
        yield field, value
    elif isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            yield from _floats(getattr(value, name), f"{field}.{name}" if field else name)
    elif isinstance(value, dict):
        for name, item in value.items():
            yield from _floats(item, f"{field}.{name}" if field else str(name))
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from _floats(item, f"{field}[{index}]")


def _last_field(content: bytes) -> str:
    fields = re.findall(rb'"([^"\\]+)"\s*:', content)
    return f", it breaks off in field '{fields[-1].decode(errors='replace')}'" if fields else ""
