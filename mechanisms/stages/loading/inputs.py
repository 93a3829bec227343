"""Names the files, folders, variables and packages that an author's code read, and hashes what they hold now.

The names are kept in a stage's stamp; what they hold goes into its key. Whether anything has changed is then known
without running that code again. A file counts by its content, a folder by the names in it, and what was looked for in
vain counts too. Names of files in the project are relative to it, so a copy of the project elsewhere has the same keys;
of files outside, the key holds the content alone.
"""

from __future__ import annotations

import hashlib
import os
import stat
from importlib import metadata
from pathlib import Path
from typing import Any

import msgspec

from shared.stage import paths
from shared.stage.files import file_hash, sources_hash
from shared.stage.memory import recalled

PICTURES = ("mbsd/drawing",)
"""Sources that decide no number; what they draw has them in its key by their own name."""
RESULTS = "results:"
"""Before the names of files in the folder of results, which may be anywhere."""


class Inputs(msgspec.Struct, kw_only=True):
    """By name, what each input holds; a state is a short text."""

    files: dict[str, str] = {}
    folders: dict[str, str] = {}
    sources: dict[str, str] = {}
    """Folders of the project of which all Python files count, named relative to it."""
    variables: dict[str, str] = {}
    """Of the environment."""
    packages: dict[str, str] = {}

    def names(self) -> dict[str, list[str]]:
        """What is kept in a stamp: the names without their states."""
        return {kind: sorted(states) for kind, states in self._kinds().items()}

    def digest(self) -> str:
        """SHA-256 over the states, and over those names that do not depend on where the project is."""
        rows = [
            (kind, "" if os.path.isabs(name) else name, state)
            for kind, states in self._kinds().items()
            for name, state in states.items()
        ]
        return hashlib.sha256(msgspec.json.encode(sorted(rows))).hexdigest()

    def joined(self, other: Inputs) -> Inputs:
        """Both together; where both have a name, the state of this one."""
        theirs = other._kinds()
        return Inputs(**{kind: theirs[kind] | states for kind, states in self._kinds().items()})

    def _kinds(self) -> dict[str, dict[str, str]]:
        return {kind: getattr(self, kind) for kind in STATES}


def observed(names: Any) -> Inputs | None:
    """What the inputs with these names, from :meth:`Inputs.names`, hold now; None if that is not what ``names`` are."""
    try:
        known = msgspec.convert(names, dict[str, list[str]])
    except msgspec.ValidationError:
        return None
    if set(known) != set(STATES):
        return None
    return Inputs(**{kind: {name: STATES[kind](name) for name in known[kind]} for kind in STATES})


def name_of(path: str | os.PathLike[str]) -> str:
    """The name under which a file counts: relative to the results or the project, else absolute."""
    absolute = Path(os.path.abspath(path))
    results = Path(os.path.abspath(paths.out_root()))
    if absolute.is_relative_to(results):
        return RESULTS + absolute.relative_to(results).as_posix()
    return absolute.relative_to(paths.ROOT).as_posix() if absolute.is_relative_to(paths.ROOT) else absolute.as_posix()


def path_of(name: str) -> Path:
    """Where the file with this name is."""
    if name.startswith(RESULTS):
        return Path(os.path.abspath(paths.out_root())) / name.removeprefix(RESULTS)
    return paths.ROOT / name


def file_state(name: str) -> str:
    """SHA-256 of a file's content, or a word: missing, folder, special (a device or pipe), unreadable."""
    path = path_of(name)
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            return "folder"
        return file_hash(path) if stat.S_ISREG(mode) else "special"
    except (FileNotFoundError, NotADirectoryError):
        return "missing"
    except (OSError, ValueError):
        return "unreadable"


def folder_state(name: str) -> str:
    """SHA-256 over the names in a folder, but for Python's caches; or missing, unreadable."""
    try:
        found = sorted(entry for entry in os.listdir(path_of(name)) if entry != "__pycache__")
    except (FileNotFoundError, NotADirectoryError):
        return "missing"
    except (OSError, ValueError):
        return "unreadable"
    return hashlib.sha256("\0".join(found).encode(errors="surrogateescape")).hexdigest()


def sources_state(name: str) -> str:
    """SHA-256 over the Python files below a folder of the project, but for :data:`PICTURES` in it; or missing."""
    if not (paths.ROOT / name).exists():
        return "missing"
    return sources_hash(paths.ROOT / name, leave_out=[paths.ROOT / other for other in PICTURES if other != name])


def variable_state(name: str) -> str:
    """``=value`` of a variable of the environment, or nothing if it is not set."""
    value = os.environ.get(name)
    return "" if value is None else f"={value}"


def package_state(name: str) -> str:
    """The installed version, or missing."""
    try:
        return recalled(("version", name), lambda: metadata.version(name))
    except (metadata.PackageNotFoundError, ValueError):
        return "missing"


STATES = {
    "files": file_state,
    "folders": folder_state,
    "sources": sources_state,
    "variables": variable_state,
    "packages": package_state,
}
"""By kind of input, what it holds now."""
