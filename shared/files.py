"""Files are written whole: a temporary file beside the target, then a rename."""

from __future__ import annotations

import glob
import hashlib
import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from shared.errors import UserError
from shared.paths import refuse_links

LEFTOVER_AGE = 3600.0
"""Seconds after which a temporary file counts as left by a killed writer."""


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path with the target's suffix; on success it replaces ``path``, else it is removed.

    A kill or a full disk therefore never leaves a part of a file under the final name.
    Raises UserError naming the file when the disk is full, the folder cannot be written, or a folder of results is a
    link.
    """
    refuse_links(path.parent)
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_leftovers(path)
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        os.chmod(temporary, 0o644)
        yield temporary
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        os.replace(temporary, path)
    except OSError as error:
        raise UserError(
            f"cannot write {path}: {error.strerror or error}; free some disk space or set MBSD_OUT to another folder"
        ) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _remove_leftovers(path: Path) -> None:
    """Remove temporary files of ``path`` whose writer was killed so long ago that it cannot be writing any more."""
    for left in path.parent.glob(f".{glob.escape(path.stem)}-*{glob.escape(path.suffix)}"):
        with suppress(FileNotFoundError):
            if time.time() - left.stat().st_mtime > LEFTOVER_AGE:
                left.unlink()


def write_bytes(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path`` whole."""
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


def file_hash(path: Path) -> str:
    """SHA-256 of a file's bytes, as hex."""
    with path.open("rb") as handle:
        return hashlib.file_digest(handle, "sha256").hexdigest()


def sources_hash(*folders_or_files: Path) -> str:
    """SHA-256 over the Python sources below the given folders (or the files themselves), by name and content."""
    digest = hashlib.sha256()
    for root in folders_or_files:
        files = sorted(root.rglob("*.py")) if root.is_dir() else [root]
        for file in files:
            digest.update(file.relative_to(root.parent).as_posix().encode())
            digest.update(b"\0")
            digest.update(file.read_bytes())
            digest.update(b"\0")
    return digest.hexdigest()
