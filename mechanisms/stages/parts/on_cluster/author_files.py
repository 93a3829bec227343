"""Files of authors, as contents by their hash, and as files again on a worker.

Of ``mechanisms/`` every file of the mechanism whose parts are made travels, because parts.py may read any of them; of
the others the Python files, which it may import. Of a user's own folder, which may hold anything, the files of the
mechanism travel, what they import of the folder, and what was read when the parts were made before. The program itself
does not travel: a worker has the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path

import msgspec

from mbsd.dependencies.imported import content_of, named_modules
from mechanisms.stages.loading.inputs import WORKSHOP, name_of, path_of
from mechanisms.stages.loading.loading import package_of
from shared.cluster.deal import content_hash
from shared.cluster.preload import PARTS
from shared.stage import paths
from shared.stage.errors import UserError

PROGRAM = ("stages",)
"""Folders of ``mechanisms/`` that are the program's."""


class Order(msgspec.Struct, frozen=True, kw_only=True):
    """An order for the parts of one mechanism, as a worker receives it."""

    name: str
    files: dict[str, str]
    """By name as inputs have it, the hash of the content of each of the authors' files."""
    program: dict[str, str]
    """Versions and sources of who asks, as ``identity`` gives them."""
    folder: str = ""
    """Name of the user's own folder in which the mechanism is."""
    scale: str = ""
    """Scale of a model, such as 1:20; empty for the machine itself."""
    machine: str = ""
    """Hash of the parts.json of the machine itself, where the motion of its model follows from it."""


def collected(name: str, read: Iterable[str] = ()) -> dict[str, bytes]:
    """Return the files of authors, by the name that inputs have, that go along for the mechanism or variant ``name``.

    ``read`` are names of files of a user's own folder that the parts were made from before. One that cannot be read,
    or goes meanwhile, stays here; that it is missing is reported from here.
    """
    contents: dict[str, bytes] = {}
    owner = paths.owner_of(name)
    for path in sorted(set(_own_paths(owner, read) if paths.in_workshop() else _paths(owner))):
        with suppress(OSError):
            contents[name_of(path)] = path.read_bytes()
    return contents


def by_content(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the same contents by their hash."""
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


def _own_paths(owner: str, read: Iterable[str]) -> Iterator[Path]:
    """Yield files of a user's own folder."""
    folder = paths.mechanism_folder(owner)
    if folder != paths.MECHANISMS:
        yield from (path for path in folder.rglob("*") if path.is_file() and not _is_hidden(path.relative_to(folder)))
    files = {paths.mechanism_file(owner, file) for file in ("mechanism", "parts", "shot")}
    yield from _imported([(file, package_of(owner)) for file in files if file.is_file()])
    yield from (path_of(name) for name in read if name.startswith(WORKSHOP) and path_of(name).is_file())


def _is_hidden(path: Path) -> bool:
    """Return True if it is of a tool rather than of the author."""
    return any(part == "__pycache__" or part.startswith(".") for part in path.parts)


def _imported(waiting: list[tuple[Path, str]]) -> Iterator[Path]:
    """Return these files, each with its package, and those of the user's folder that their import statements name."""
    seen: set[Path] = set()
    while waiting:
        file, package = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        yield file
        for module in named_modules(content_of(file), package):
            place = _place(module)
            both = (place.with_name(f"{place.name}.py"), module.rpartition(".")[0]), (place / "__init__.py", module)
            waiting += [(path, inside) for path, inside in both if path.is_file()]


def _place(module: str) -> Path:
    """Return where a module of the user's folder would be, without its suffix."""
    top, *rest = module.split(".")
    if top != "mechanisms" or not rest:
        return paths.MECHANISMS.joinpath(top, *rest)
    owner, *below = rest
    try:
        folder = paths.mechanism_folder(owner)
        return folder / owner if below == ["mechanism"] and paths.is_single_file(owner) else folder.joinpath(*below)
    except UserError:
        return paths.MECHANISMS.joinpath(*rest)
