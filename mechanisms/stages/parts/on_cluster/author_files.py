"""What authors have written in ``mechanisms/``, as contents by their hash, and as files again on a worker.

Every file of the mechanism whose parts are made travels, because parts.py may read any of them; of the others the
Python files, which it may import. The program itself does not travel: a worker has the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

import msgspec

from shared.cluster.contents import content_hash
from shared.cluster.preload import PARTS
from shared.stage import paths

PROGRAM = ("stages",)
"""Folders of ``mechanisms/`` that are the program's."""


class Order(msgspec.Struct, frozen=True, kw_only=True):
    """What a worker receives of the parts of one mechanism."""

    name: str
    files: dict[str, str]
    """By name below the project, the hash of the content of each of the authors' files."""
    program: dict[str, str]
    """Versions and sources of who asks, as ``identity`` gives them."""


def collected(name: str) -> dict[str, bytes]:
    """The files of all authors, by name below the project, that go along for the mechanism or variant ``name``.

    One that cannot be read, or goes meanwhile, stays here; that it is missing is reported from here.
    """
    contents: dict[str, bytes] = {}
    for path in sorted(_paths(paths.owner_of(name))):
        with suppress(OSError):
            contents[path.relative_to(paths.ROOT).as_posix()] = path.read_bytes()
    return contents


def by_content(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """The same contents by their hash."""
    return {content_hash(content): content for content in files.values()}


def _paths(owner: str) -> Iterator[Path]:
    ours = {paths.ROOT / room for room in PARTS}
    for folder in paths.MECHANISMS.iterdir():
        if not folder.is_dir():
            if folder.suffix == ".py" and folder not in ours:
                yield folder
        elif folder.name not in (*PROGRAM, "__pycache__"):
            pattern = "*" if folder.name == owner else "*.py"
            yield from (path for path in folder.rglob(pattern) if path.is_file() and "__pycache__" not in path.parts)
