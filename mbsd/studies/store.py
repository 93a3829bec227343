"""Results that are kept: files of many points each, every one whole, named by a hash of its bytes."""

from __future__ import annotations

import hashlib
import json
import os
import time
from contextlib import suppress
from pathlib import Path

from mbsd.base.errors import ModelError
from mbsd.base.files import write_whole
from mbsd.studies.work import Result

EVERY = 5.0
"""Seconds after which what was computed is written; a kill loses as much at most."""
MOST_FILES = 32
"""More than these become one when a study is opened."""


class Store:
    """Results of one build and measure by the key of their point; raises ModelError if the folder cannot be used."""

    def __init__(self, folder: str | os.PathLike[str], study: str) -> None:
        self.folder = Path(folder) / study[:32]
        self.known: dict[str, Result] = {}
        self._fresh: dict[str, Result] = {}
        self._written = time.monotonic()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as error:
            raise ModelError(f"study: cannot use the folder {folder} ({error}); give another or folder=None") from error
        files = self._read()
        if len(files) > MOST_FILES:
            self._write(self.known)
            for file in files:
                if file.name != self._last:
                    file.unlink(missing_ok=True)

    def keep(self, key: str, result: Result) -> None:
        """Keep a result, in a file now and then."""
        self._fresh[key] = result
        if time.monotonic() - self._written > EVERY:
            self.flush()

    def flush(self) -> None:
        """Write what is not in a file yet. Raises ModelError if the disk has no room."""
        self._write(self._fresh)
        self.known.update(self._fresh)
        self._fresh, self._written = {}, time.monotonic()

    def _write(self, results: dict[str, Result]) -> None:
        if not results:
            return
        lines = [
            json.dumps([key, result.values, result.reason], separators=(",", ":")) for key, result in results.items()
        ]
        content = "\n".join(lines).encode()
        self._last = f"{hashlib.sha256(content).hexdigest()[:32]}.jsonl"
        write_whole(self.folder / self._last, content)

    def _read(self) -> list[Path]:
        """Read all files; one that is damaged goes, and its points are computed again."""
        read = []
        for file in sorted(self.folder.glob("*.jsonl")):
            if file.name.startswith("."):
                continue  # another study writes it now
            with suppress(FileNotFoundError):  # another study made one of many
                content = file.read_bytes()
                if file.stem != hashlib.sha256(content).hexdigest()[:32]:
                    file.unlink(missing_ok=True)
                    continue
                for line in content.splitlines():
                    key, values, reason = json.loads(line)
                    self.known[key] = Result(values, reason)
                read.append(file)
        return read
