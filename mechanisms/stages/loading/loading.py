"""Loads one of the files of a mechanism; an error in it is reported with file and line."""

from __future__ import annotations

import dataclasses
import importlib
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib.abc import MetaPathFinder
from importlib.machinery import (
    EXTENSION_SUFFIXES,
    SOURCE_SUFFIXES,
    ExtensionFileLoader,
    FileFinder,
    ModuleSpec,
    SourceFileLoader,
)
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, Literal

from mechanisms.stages.loading.recording import is_installed
from mechanisms.stages.loading.variants import checked_variants, replaced
from shared.stage.errors import UserError
from shared.stage.paths import (
    MECHANISMS,
    RESERVED,
    ROOT,
    defines,
    in_workshop,
    is_single_file,
    mechanism_file,
    mechanism_folder,
    owner_of,
    shown_file,
)

File = Literal["mechanism", "parts", "shot", "tolerances"]
_RUNNING: ContextVar[str | None] = ContextVar("running", default=None)
"""The mechanism or variant whose author's code runs."""

REQUIRED: dict[File, dict[str, str]] = {
    "mechanism": {"Params": "a frozen dataclass of the lengths", "build": "def build(p: Params) -> Mechanism"},
    "parts": {"parts": "def parts(p: Params) -> dict[str, list[Solid]]"},
    "shot": {"shot": "shot = Shot(...)"},
    "tolerances": {"tolerances": "def tolerances(p: Params) -> dict[str, dict], as docs/tolerances.md shows"},
}


def load(name: str, file: File) -> ModuleType:
    """Import ``mechanisms/<name>/<file>.py``.

    Raises UserError, with file and line, when there is no such mechanism or file, when the file cannot be
    imported, or when it lacks what :data:`REQUIRED` lists.
    """
    path, owner = mechanism_file(name, file), owner_of(name)
    if not path.is_file():
        raise UserError(
            f"{owner}: {shown_file(name, file)} is missing; a mechanism has mechanism.py, and where it "
            "needs them, parts.py, shot.py and tolerances.py"
        )
    importlib.invalidate_caches()
    with author_code(name):
        module = importlib.import_module(f"mechanisms.{owner}.{'mechanism' if is_single_file(name) else file}")
    for attribute, form in REQUIRED[file].items():
        if not hasattr(module, attribute):
            raise UserError(f"{owner}: {shown_file(name, file)} does not define '{attribute}'; write {form}")
    return module


def params(name: str) -> Any:
    """``Params()`` of a mechanism, or what a variant makes of them. Raises UserError as :func:`load`."""
    module = load(name, "mechanism")
    kind: Any = module.Params
    if dataclasses.is_dataclass(kind):
        for field in dataclasses.fields(kind):
            if field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
                raise UserError(
                    f"{_shown(Path(str(module.__file__)))}: Params.{field.name} has no default; give it one"
                )
    checked_variants(name, module)
    with author_code(name):
        return replaced(name, module, module.Params())


def package_of(name: str) -> str:
    """The Python package of a mechanism's files, which its variants share."""
    return f"mechanisms.{owner_of(name)}"


def has(name: str, file: File) -> bool:
    """Whether a mechanism has this file; parts.py and shot.py may be left out."""
    path = mechanism_file(name, file)
    return defines(path, file) if file != "mechanism" and is_single_file(name) else path.is_file()


@contextmanager
def author_code(name: str) -> Iterator[None]:
    """Turn what the author's code raises in this block into a UserError that names file, line and the line's text.

    A UserError passes as it is. An exception that comes from elsewhere without touching the mechanism's folder
    is a fault of ours and passes too; ``MBSD_TRACEBACK=1`` shows the traceback of either (shared/stage/console.py).
    """
    folder = _folder_of(name)
    token = _RUNNING.set(name)
    try:
        yield
    except UserError:
        raise
    except SyntaxError as error:
        if not error.filename or not _is_below(error.filename, folder):
            raise
        shown = f"{_shown(Path(error.filename))}:{error.lineno}"
        raise UserError(f"{shown}: {error.msg}: {(error.text or '').strip()}") from error
    except (Exception, SystemExit) as error:
        from mechanisms.stages.loading.author_errors import worded

        lines = [frame for frame in traceback.extract_tb(error.__traceback__) if _is_below(frame.filename, folder)]
        if not lines:
            raise
        raise UserError(worded(error, lines, _shown)) from error
    finally:
        _RUNNING.reset(token)


def _folder_of(name: str) -> Path:
    """The folder of a mechanism; where it would be on a worker of a cluster, which has its functions alone."""
    try:
        return mechanism_folder(name) if in_workshop() else MECHANISMS / owner_of(name)
    except UserError:
        return MECHANISMS / owner_of(name)


def running(folder: str) -> str:
    """The name of a folder's mechanism, or of its variant whose files are running just now."""
    name = _RUNNING.get()
    return name if name is not None and owner_of(name) == folder else folder


INSTEAD: dict[str, bytes] = {}
"""Sources that are loaded in place of a file's, by its real path, to learn what they would be."""


class _SourceOnly(SourceFileLoader):
    """Compiles the file each time: Python's own cache misses an edit within a second that keeps the size."""

    def get_code(self, fullname: str) -> CodeType:
        source = INSTEAD.get(os.path.realpath(self.path)) if INSTEAD else None
        return self.source_to_code(self.get_data(self.path) if source is None else source, self.path)


def _author_folder(path: str) -> FileFinder:
    """Path hook: finds the modules in folders of the author's, below a mechanism or outside of the project.

    Raises ImportError for the program's own folders, those of installed packages and the standard library.
    """
    place = Path(os.path.abspath(path))
    if in_workshop() and place.is_relative_to(MECHANISMS):
        ours = _is_programs(str(place))
    elif place.is_relative_to(MECHANISMS):
        folder = place.relative_to(MECHANISMS).parts[:1]
        ours = not folder or not (MECHANISMS / folder[0] / "mechanism.py").is_file()
    else:
        ours = place.is_relative_to(ROOT) or is_installed(f"{place}{os.sep}")
    if ours or not place.is_dir():
        raise ImportError(f"{path} holds none of the author's files")
    return FileFinder(path, (ExtensionFileLoader, EXTENSION_SUFFIXES), (_SourceOnly, SOURCE_SUFFIXES))


def _is_below(filename: str, folder: Path) -> bool:
    return Path(filename).is_relative_to(folder) and not (in_workshop() and _is_programs(filename))


def _is_programs(place: str) -> bool:
    """Whether what lies in a user's folder is an environment's or the program's, as where that folder is a home."""
    own = MECHANISMS.is_relative_to(ROOT)
    return is_installed(f"{place}{os.sep}") or (not own and Path(place).is_relative_to(ROOT))


def _shown(path: Path) -> str:
    return path.relative_to(MECHANISMS if in_workshop() else MECHANISMS.parent).as_posix()


class _Machines(MetaPathFinder):
    """Finds the machines of a user's own folder as packages, though they may be files, or that folder itself."""

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> ModuleSpec | None:
        top, _, rest = fullname.partition(".")
        owner, _, file = rest.partition(".")
        if top != "mechanisms" or not owner or owner in RESERVED or not in_workshop() or "." in file:
            return None
        try:
            source = mechanism_file(owner)
            single = is_single_file(owner)
        except UserError:
            return None
        if not file:
            return self._package(fullname, source.parent, single)
        if file == "mechanism" and single:
            return spec_from_file_location(fullname, source, loader=_SourceOnly(fullname, str(source)))
        return None

    def _package(self, fullname: str, folder: Path, single: bool) -> ModuleSpec:
        init = folder / "__init__.py"
        if not single and init.is_file():
            loader = _SourceOnly(fullname, str(init))
            spec = spec_from_file_location(fullname, init, loader=loader, submodule_search_locations=[str(folder)])
            assert spec is not None
            return spec
        package = ModuleSpec(fullname, None, is_package=True)
        package.submodule_search_locations = [str(folder)]
        return package


sys.path_hooks.insert(0, _author_folder)
if in_workshop():
    sys.meta_path.insert(0, _Machines())
    sys.path.append(str(MECHANISMS))  # a machine may import what lies beside it; last, so that it hides no room
