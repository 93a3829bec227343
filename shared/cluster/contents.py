"""Inputs on a worker: files named by the SHA-256 of their bytes.

So none is sent twice and none is stale.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path

from shared.stage.files import file_hash, write_bytes
from shared.stage.paths import out_root

LIMIT = 2_000_000_000
"""Bytes that a worker keeps."""
VARIABLE = "CLUSTER_CACHE_MB"
"""Environment variable of a worker with another limit, in 1e6 bytes."""


def content_hash(content: bytes) -> str:
    """Return the name of these bytes."""
    return hashlib.sha256(content).hexdigest()


class Contents:
    """Folder of contents on a machine; several workers may share it."""

    def __init__(self, folder: Path | None = None, limit: int | None = None) -> None:
        self.folder = folder or out_root() / ".cluster" / "contents"
        given = os.environ.get(VARIABLE, "")
        self.limit = limit if limit is not None else int(float(given) * 1e6) if given else LIMIT
        self._whole: dict[str, tuple[int, int]] = {}

    def find(self, name: str) -> Path | None:
        """Return the file with this content; a damaged one is removed.

        It is checked once in a process and again when it changes.
        """
        path = self.folder / name
        try:
            stat = path.stat()
            seen = stat.st_size, stat.st_ino
            if self._whole.get(name) != seen:
                if file_hash(path) != name:
                    path.unlink(missing_ok=True)
                    return None
                self._whole[name] = seen
            os.utime(path)
        except OSError:
            return None
        return path

    def lacking(self, names: Collection[str]) -> list[str]:
        """Return the contents that are missing here."""
        return [name for name in names if self.find(name) is None]

    def keep(self, contents: Mapping[str, bytes], needed: Collection[str] = ()) -> None:
        """Keep these contents; the longest unused others are removed if there is too much.

        Raises UserError if the disk has no room.
        """
        if not contents:
            return
        self._make_room(sum(map(len, contents.values())), {*needed, *contents})
        for name, content in contents.items():
            if content_hash(content) == name:
                write_bytes(self.folder / name, content)

    def _make_room(self, size: int, needed: Collection[str]) -> None:
        files = []
        for path in self.folder.glob("[0-9a-f]*"):
            with suppress(OSError):
                stat = path.stat()
                files.append((stat.st_mtime, stat.st_size, path))
        much = size + sum(entry[1] for entry in files)
        for _, bytes_, path in sorted(files):
            if much <= self.limit:
                return
            if path.name not in needed:
                path.unlink(missing_ok=True)
                much -= bytes_
