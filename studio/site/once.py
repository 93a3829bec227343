"""What a file of the site was made from, kept beside the site, so that a host gets nothing but pages."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from shared.stage.files import file_hash, write_bytes


@contextmanager
def once(target: Path, key: str) -> Iterator[bool]:
    """Whether ``target`` has to be written: it is missing, was changed, or was made from another ``key``."""
    folder = target.parent
    mark = folder.parent.with_name(f".{folder.parent.name}") / folder.name / f"{target.name}.from"
    is_made = target.is_file() and mark.is_file() and mark.read_text() == f"{key} {file_hash(target)}"
    yield not is_made
    if not is_made:
        write_bytes(mark, f"{key} {file_hash(target)}".encode())
