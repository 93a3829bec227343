"""A recorder: what a user's code has read, each input in the state that it had the first time."""

from __future__ import annotations

import importlib.util
import os
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from mbsd.dependencies.inputs import Inputs, Places
from mbsd.dependencies.installed import SYSTEM, is_installed

CACHES = f"{os.sep}__pycache__"


class Recorder:
    """Collects what is read in the blocks in which it is active (recording.py), named as ``places`` say."""

    def __init__(self, places: Places) -> None:
        self.places = places
        self.files: dict[str, str] = {}
        self.folders: dict[str, str] = {}
        self.variables: dict[str, str] = {}
        self.packages: dict[str, str] = {}
        self.modules: dict[str, str] = {}
        """Python files from which modules were loaded meanwhile."""
        self._made: set[str] = set()
        self._set: set[str] = set()
        self._own = threading.local()

    def inputs(self, every_module: bool = False) -> Inputs:
        """Return the inputs read and the modules loaded so far, without those that ``sys.modules`` knows."""
        known = set() if every_module else {getattr(module, "__file__", None) for module in list(sys.modules.values())}
        modules = {name: state for name, state in self.modules.items() if str(self.places.path_of(name)) not in known}
        return Inputs(
            modules=modules,
            files=dict(self.files),
            folders=dict(self.folders),
            variables=dict(self.variables),
            packages=dict(self.packages),
        )

    def read(self, path: Any) -> None:
        """Count a file that is read, or looked for; the first time decides what it held."""
        with self._quiet():
            self._note("files", path)

    def listed(self, path: Any) -> None:
        """Count a folder whose names are read."""
        with self._quiet():
            self._note("folders", path)

    def module_opened(self, path: Any) -> None:
        """Count a file from which a module is loaded, by its source or by Python's cache of it."""
        if getattr(self._own, "quiet", False):
            return
        with self._quiet():
            place = absolute(path)
            if place is not None and CACHES in place:
                with suppress(ValueError):
                    place = importlib.util.source_from_cache(place)
            if place is not None and not self.places.is_program(place) and not self.places.acts_for_itself(place):
                self._note("modules", place)

    def module_missed(self, name: str, folders: Iterable[str]) -> None:
        """Count a module that was looked for in these folders and not found, or as an installed package."""
        top, _, below = name.rpartition(".")
        for folder in folders:
            if os.path.isdir(folder) and not is_installed(os.path.abspath(folder) + os.sep):
                self.read(os.path.join(folder, f"{below}.py"))
                self.read(os.path.join(folder, below, "__init__.py"))
        if not top and name not in self.packages:
            self.packages[name] = self.places.package_state(name)

    def leave_out(self, path: Any) -> None:
        """Leave out from now on what the run itself writes."""
        place = absolute(path)
        if place:
            self._made.add(place)

    def renamed(self, source: Any, target: Any) -> None:
        """Leave out a file under its new name, too, if the run has made it."""
        if absolute(source) in self._made:
            self.leave_out(target)

    def written(self, path: Any) -> None:
        """Leave out a file that is opened for writing, unless it was read before."""
        place = absolute(path)
        if place and self.places.name_of(place) not in self.files:
            self.leave_out(path)

    def variable(self, name: Any, value: str | None) -> None:
        """Count a variable of the environment, unless the run itself has set it."""
        if isinstance(name, str) and name not in self._set:
            self.variables.setdefault(name, "" if value is None else f"={value}")

    def set_variable(self, name: Any) -> None:
        """Leave out from now on a variable that the run itself sets."""
        if isinstance(name, str):
            self._set.add(name)

    def hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Take in one audit event."""
        if not getattr(self._own, "quiet", False):
            with self._quiet():
                EVENTS[event](self, *arguments)

    @contextmanager
    def _quiet(self) -> Iterator[None]:
        """Take in nothing that this thread does in the block: the recorder reads files, too."""
        before = getattr(self._own, "quiet", False)
        self._own.quiet = True
        try:
            yield
        finally:
            self._own.quiet = before

    def _note(self, kind: str, path: Any) -> None:
        place = absolute(path)
        if place is None or not self._counts(place):
            return
        states, name = getattr(self, kind), self.places.name_of(place)
        if name not in states:
            states[name] = self.places.state(kind, name)

    def _counts(self, place: str) -> bool:
        if is_installed(place) or CACHES in place:
            return False
        if place.startswith(SYSTEM) and not place.startswith(str(self.places.root) + os.sep):
            return False
        kernels = sys.modules.get("mbsd.compiling.kernel_cache")  # only once the solver compiles
        if kernels is not None and Path(place).is_relative_to(kernels.cache_root()):
            return False
        return place not in self._made and not any(str(parent) in self._made for parent in Path(place).parents)


def absolute(path: Any) -> str | None:
    """The absolute path, or None for what is none (a file descriptor, text that no path can be)."""
    if not isinstance(path, str | bytes | os.PathLike):
        return None
    place = os.fsdecode(path)
    return os.path.abspath(place) if place and "\0" not in place and place != ":memory:" else None


def _opened(recorder: Recorder, path: Any, mode: Any, flags: Any) -> None:
    flags = flags if isinstance(flags, int) else 0
    access = flags & os.O_ACCMODE
    if access == os.O_WRONLY or (access == os.O_RDWR and flags & (os.O_TRUNC | os.O_CREAT)):
        recorder.written(path)
    else:
        recorder.read(path)


def _asked_for(recorder: Recorder, path: Any) -> None:
    """Record that a path was looked up; lookups of folders are too many to mean anything."""
    place = absolute(path)
    if place is not None and not os.path.isdir(place):
        recorder.read(path)


def _started(recorder: Recorder, executable: Any, arguments: Any, cwd: Any, *_: Any) -> None:
    """Count the files among the words of a program that is started; what else it reads is its own."""
    words = arguments if isinstance(arguments, list | tuple) else []
    for word in (executable, *words):
        if isinstance(word, str | os.PathLike) and word:
            place = os.path.join(os.fspath(cwd), word) if cwd else word
            if os.path.isfile(place):
                recorder.read(place)


EVENTS: dict[str, Callable[..., None]] = {
    "open": _opened,
    "stat": _asked_for,
    "os.listdir": lambda recorder, path: recorder.listed(path if path is not None else "."),
    "os.scandir": lambda recorder, path: recorder.listed(path if path is not None else "."),
    "os.mkdir": lambda recorder, path, *_: recorder.leave_out(path),
    "os.rename": lambda recorder, source, target, *_: recorder.renamed(source, target),
    "tempfile.mkdtemp": lambda recorder, path: recorder.leave_out(path),
    "tempfile.mkstemp": lambda recorder, path: recorder.leave_out(path),
    "sqlite3.connect": lambda recorder, path: recorder.read(path),
    "ctypes.dlopen": lambda recorder, path: recorder.read(path) if os.sep in str(path) else None,
    "subprocess.Popen": _started,
}
"""Action of a recorder by audit event."""
