"""Loads one of the three files of a mechanism; an error in it is reported with file and line."""

from __future__ import annotations

import dataclasses
import importlib
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib.machinery import EXTENSION_SUFFIXES, SOURCE_SUFFIXES, ExtensionFileLoader, FileFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, Literal

from mechanisms.stages.loading.recording import is_installed
from mechanisms.stages.loading.variants import checked_variants, replaced
from shared.stage.errors import UserError
from shared.stage.paths import MECHANISMS, ROOT, mechanism_folder, mechanism_name, owner_of

File = Literal["mechanism", "parts", "shot"]
_RUNNING: ContextVar[str | None] = ContextVar("running", default=None)
"""The mechanism or variant whose author's code runs."""

REQUIRED: dict[File, dict[str, str]] = {
    "mechanism": {"Params": "a frozen dataclass of the lengths", "build": "def build(p: Params) -> Mechanism"},
    "parts": {"parts": "def parts(p: Params) -> dict[str, list[Solid]]"},
    "shot": {"shot": "shot = Shot(...)"},
}


def load(name: str, file: File) -> ModuleType:
    """Import ``mechanisms/<name>/<file>.py``.

    Raises UserError, with file and line, when there is no such mechanism or file, when the file cannot be
    imported, or when it lacks what :data:`REQUIRED` lists.
    """
    folder = mechanism_folder(name)
    path = folder / f"{file}.py"
    if not path.is_file():
        raise UserError(
            f"{folder.name}: {_shown(path)} is missing; a mechanism has mechanism.py, and where it "
            "needs them, parts.py and shot.py"
        )
    importlib.invalidate_caches()
    with author_code(name):
        module = importlib.import_module(f"mechanisms.{folder.name}.{file}")
    for attribute, form in REQUIRED[file].items():
        if not hasattr(module, attribute):
            raise UserError(f"{folder.name}: {_shown(path)} does not define '{attribute}'; write {form}")
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
    return (mechanism_folder(name) / f"{file}.py").is_file()


@contextmanager
def author_code(name: str) -> Iterator[None]:
    """Turn what the author's code raises in this block into a UserError that names file, line and the line's text.

    A UserError passes as it is. An exception that comes from elsewhere without touching the mechanism's folder
    is a fault of ours and passes too; ``MBSD_TRACEBACK=1`` shows the traceback of either (shared/stage/console.py).
    """
    folder = MECHANISMS / owner_of(mechanism_name(name))
    token = _RUNNING.set(name)
    try:
        yield
    except UserError:
        raise
    except SyntaxError as error:
        if not error.filename or not Path(error.filename).is_relative_to(folder):
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
    if place.is_relative_to(MECHANISMS):
        folder = place.relative_to(MECHANISMS).parts[:1]
        ours = not folder or not (MECHANISMS / folder[0] / "mechanism.py").is_file()
    else:
        ours = place.is_relative_to(ROOT) or is_installed(f"{place}{os.sep}")
    if ours or not place.is_dir():
        raise ImportError(f"{path} holds none of the author's files")
    return FileFinder(path, (ExtensionFileLoader, EXTENSION_SUFFIXES), (_SourceOnly, SOURCE_SUFFIXES))


def _is_below(filename: str, folder: Path) -> bool:
    return Path(filename).is_relative_to(folder)


def _shown(path: Path) -> str:
    return path.relative_to(MECHANISMS.parent).as_posix()


sys.path_hooks.insert(0, _author_folder)
