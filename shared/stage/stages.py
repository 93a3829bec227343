"""Freshness of results, decided by content and never by timestamps.

A stage has a key, a hash of everything it reads. When it is done, a stamp ``out/<mechanism>/.stamps/<stage>.json``
keeps that key with size and SHA-256 of every output. The stage is fresh while the key is the same and every output
still has its recorded bytes. So touching a file without changing it redoes nothing, an output that was deleted,
cut short or edited is made again, and going back to an older input is noticed too.

The stamp also keeps the SHA-256 of every result of another stage that the key holds. So whoever shows a file can ask
:func:`outdated_by` whether it was made of the results that lie beside it now, without knowing the stage that made it.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any, Literal

import msgspec

from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.files import file_hash
from shared.stage.memory import recalled
from shared.stage.paths import ROOT, Out, out_root, refuse_links


class OutputStamp(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One output as it was when its stage ended."""

    size: int
    sha256: str


class StageStamp(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One finished stage. Paths are relative to the mechanism's folder of results."""

    schema: Literal["mbsd.stamp"] = "mbsd.stamp"
    schema_version: Literal[1] = 1
    stage: str
    key: str
    outputs: dict[str, OutputStamp]
    notes: dict[str, Any]
    results: dict[str, str] = {}
    """SHA-256 of each result of another stage that it was made of."""


class Key(str):
    """A SHA-256 as hex, and the results whose content it holds, each with its own SHA-256."""

    results: Mapping[Path, str]


class Stage:
    """Stage of one mechanism, which knows whether its result exists, whole and from this key.

    Raises UserError if a folder it writes into is a link.
    """

    def __init__(self, out: Out, name: str, key: str, outputs: Sequence[Path]) -> None:
        self.out = out
        self.name = name
        self.key = str(key)
        results = key.results if isinstance(key, Key) else {}
        self.results = {self._relative(path): sha256 for path, sha256 in results.items()}
        self.outputs = list(outputs)
        self.stamp = out.stamps / f"{name}.json"
        out.refuse_links()
        for path in self.outputs:
            refuse_links(path.parent)

    def is_fresh(self) -> bool:
        """Return True if the stamp has this key and every output its recorded size and SHA-256."""
        stamp = self._read()
        if stamp is None or stamp.key != self.key or stamp.results != self.results:
            return False
        names = [self._relative(path) for path in self.outputs]
        return all(name in stamp.outputs for name in names) and all(
            self._is_whole(name, recorded) for name, recorded in stamp.outputs.items()
        )

    def record(self, **notes: Any) -> None:
        """Record that the outputs now stand for this key. Raises UserError if an output is missing."""
        for path in self.outputs:
            if not path.is_file():
                raise UserError(f"{self.out.name}: stage {self.name} ended without writing {path}")
        outputs = {
            self._relative(path): OutputStamp(size=path.stat().st_size, sha256=file_hash(path)) for path in self.outputs
        }
        stamp = StageStamp(stage=self.name, key=self.key, outputs=outputs, notes=notes, results=self.results)
        jsonfile.write(self.stamp, stamp)

    def notes(self) -> dict[str, Any]:
        """Return the notes of the last :meth:`record`; empty if the stage never ended."""
        stamp = self._read()
        return stamp.notes if stamp else {}

    def _read(self) -> StageStamp | None:
        return _read(self.stamp)

    def _relative(self, path: Path) -> str:
        return _name_in(self.out, path)

    def _is_whole(self, name: str, recorded: OutputStamp) -> bool:
        return _is_whole(self.out.folder / name, recorded)


def outdated_by(out: Out, path: Path) -> list[str]:
    """Return the names of results that have changed since the file ``path`` of ``out`` was made.

    Its own name, if it is not as its stage left it or no stage has recorded it. Empty where it is up to date; a result
    that it was made of is asked in turn. That motion, parts and shot follow from the author's files as they are is for
    their own stages to say.
    """
    stamp = _stamp_of(out, path)
    if stamp is None or not _is_whole(path, stamp.outputs[_name_in(out, path)]):
        return [path.name]
    changed: list[str] = []
    for name, sha256 in stamp.results.items():
        result = Path(os.path.normpath(out.folder / name))
        if not result.is_file() or file_hash(result) != sha256:
            changed.append(result.name)
        elif _stamp_of(out, result) is not None:
            changed += outdated_by(out, result)
    return list(dict.fromkeys(changed))


def is_recorded(out: Out, path: Path) -> bool:
    """Return True if a stage has recorded the inputs of a file; False for files from elsewhere."""
    return _stamp_of(out, path) is not None


def results_of(out: Out, path: Path) -> set[Path]:
    """Return the results of other stages from which a file was made directly.

    There are none for a file without a record.
    """
    stamp = _stamp_of(out, path)
    return {Path(os.path.normpath(out.folder / name)) for name in stamp.results} if stamp else set()


def _stamp_of(out: Out, path: Path) -> StageStamp | None:
    """Return the stamp of the stage that made a file; None if none has recorded it."""
    name = _name_in(out, path)
    word = msgspec.json.encode(name)
    for file in sorted(out.stamps.glob("*.json")):
        try:
            is_named = word in file.read_bytes()  # a look is faster than to decode all of them
        except OSError:
            continue
        stamp = _read(file) if is_named else None
        if stamp is not None and name in stamp.outputs:
            return stamp
    return None


def _read(file: Path) -> StageStamp | None:
    try:
        return jsonfile.read(file, StageStamp)
    except UserError:
        return None  # missing or damaged: the stage runs again and writes a new one


def _name_in(out: Out, path: Path) -> str:
    return Path(os.path.relpath(path, out.folder)).as_posix()


def _is_whole(path: Path, recorded: OutputStamp) -> bool:
    try:
        return path.is_file() and path.stat().st_size == recorded.size and file_hash(path) == recorded.sha256
    except OSError:
        return False  # it cannot be read, so it is made again


def key_of(*values: Any) -> Key:
    """Return a SHA-256 over values: a Path counts by its file's content, all else by its repr.

    The key knows the results among the files, also those of a key among the values.
    """
    digest, results, root = hashlib.sha256(), dict[Path, str](), Path(os.path.abspath(out_root()))
    for value in values:
        results |= value.results if isinstance(value, Key) else {}
        content = f"value {value!r}"
        if isinstance(value, Path):
            sha256 = file_hash(value)
            content = f"file {sha256}"
            if Path(os.path.abspath(value)).is_relative_to(root):
                results[value] = sha256
        digest.update(content.encode() + b"\0")
    key = Key(digest.hexdigest())
    key.results = results
    return key


def versions(*packages: str) -> dict[str, str]:
    """Return installed versions by package name, without importing the packages.

    They are part of a key, and of the provenance.
    """
    return {
        package: recalled(("version", package), lambda name=package: metadata.version(name)) for package in packages
    }


def contract_sources(*more: str) -> list[Path]:
    """Return files that define data.json and parts.json, and ``more`` of ``shared/contract``: for keys."""
    names = ("__init__", "base", "loads", "motion", "parts", "space", *more)
    others = [ROOT / "mbsd" / "base" / "quantity.py"] if "quantity" in more else []
    files = [ROOT / "shared" / "contract" / f"{name}.py" for name in names]
    return [ROOT / "shared" / "stage" / "jsonfile.py", *files, *others]
