"""Decides by content, never by timestamps, what has to be made again.

A stage has a key, a hash of everything it reads. When it is done, a stamp ``out/<mechanism>/.stamps/<stage>.json``
keeps that key with size and SHA-256 of every output. The stage is fresh while the key is the same and every output
still has its recorded bytes. So touching a file without changing it redoes nothing, an output that was deleted,
cut short or edited is made again, and going back to an older input is noticed too.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from typing import Any, Literal

import msgspec

from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.files import file_hash
from shared.stage.memory import recalled
from shared.stage.paths import ROOT, Out, refuse_links


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


class Stage:
    """One stage of one mechanism: is its result there, whole and made from this key?

    Raises UserError if a folder it writes into is a link.
    """

    def __init__(self, out: Out, name: str, key: str, outputs: Sequence[Path]) -> None:
        self.out = out
        self.name = name
        self.key = key
        self.outputs = list(outputs)
        self.stamp = out.stamps / f"{name}.json"
        out.refuse_links()
        for path in self.outputs:
            refuse_links(path.parent)

    def is_fresh(self) -> bool:
        """Whether the stamp has this key and every output is there with its recorded size and SHA-256."""
        stamp = self._read()
        if stamp is None or stamp.key != self.key:
            return False
        names = [self._relative(path) for path in self.outputs]
        return all(name in stamp.outputs for name in names) and all(
            self._is_whole(name, recorded) for name, recorded in stamp.outputs.items()
        )

    def done(self, **notes: Any) -> None:
        """Record that the outputs now stand for this key. Raises UserError if an output is missing."""
        for path in self.outputs:
            if not path.is_file():
                raise UserError(f"{self.out.name}: stage {self.name} ended without writing {path}")
        outputs = {
            self._relative(path): OutputStamp(size=path.stat().st_size, sha256=file_hash(path)) for path in self.outputs
        }
        jsonfile.write(self.stamp, StageStamp(stage=self.name, key=self.key, outputs=outputs, notes=notes))

    def notes(self) -> dict[str, Any]:
        """The notes of the last :meth:`done`; empty if the stage never ended."""
        stamp = self._read()
        return stamp.notes if stamp else {}

    def _read(self) -> StageStamp | None:
        try:
            return jsonfile.read(self.stamp, StageStamp)
        except UserError:
            return None  # missing or damaged: the stage runs again and writes a new one

    def _relative(self, path: Path) -> str:
        return Path(os.path.relpath(path, self.out.folder)).as_posix()

    def _is_whole(self, name: str, recorded: OutputStamp) -> bool:
        path = self.out.folder / name
        try:
            return path.is_file() and path.stat().st_size == recorded.size and file_hash(path) == recorded.sha256
        except OSError:
            return False  # it cannot be read, so it is made again


def key_of(*values: Any) -> str:
    """SHA-256 over values: a Path counts by its file's content, everything else by its repr."""
    digest = hashlib.sha256()
    for value in values:
        digest.update((f"file {file_hash(value)}" if isinstance(value, Path) else f"value {value!r}").encode())
        digest.update(b"\0")
    return digest.hexdigest()


def versions(*packages: str) -> dict[str, str]:
    """Installed versions by package name, without importing the packages; part of a key, and of the provenance."""
    return {
        package: recalled(("version", package), lambda name=package: metadata.version(name)) for package in packages
    }


def contract_sources(*more: str) -> list[Path]:
    """Files that say what data.json and parts.json hold, and ``more`` of ``shared/contract`` by name: for keys."""
    names = ("__init__", "base", "loads", "motion", "mount", "parts", *more)
    return [ROOT / "shared" / "stage" / "jsonfile.py", *(ROOT / "shared" / "contract" / f"{name}.py" for name in names)]
