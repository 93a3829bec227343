"""Records what the author's code reads while it runs: files, folders, variables of the environment.

Python reports every file that is opened and every folder that is listed (audit events); questions whether a file
exists and variables of the environment are seen because ``os.stat`` and ``os.environ`` are replaced meanwhile. Left out
are files that the run itself makes, the interpreter, installed packages (their versions count instead) and caches of
compiled code. What cannot be seen: what a program started by the code reads on its own, files that compiled libraries
open by themselves (CAD files are seen, cad_reads.py), time, random numbers and the network.
"""

from __future__ import annotations

import importlib
import os
import sys
import sysconfig
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any

from mechanisms.stages.loading.inputs import Inputs, file_state, folder_state, name_of, package_state
from shared.stage.paths import ROOT

PACKAGES = tuple(
    {os.path.abspath(path) + os.sep for path in (sys.prefix, *map(sysconfig.get_path, ("purelib", "platlib")))}
    | {os.path.realpath(sys.prefix) + os.sep}
)
STANDARD_LIBRARY = tuple(
    {os.path.realpath(sysconfig.get_path(kind)) + os.sep for kind in ("stdlib", "platstdlib")}
    | {os.path.abspath(sysconfig.get_path("stdlib")) + os.sep}
)
SYSTEM = tuple(f"/{top}/" for top in ("proc", "sys", "dev", "usr", "bin", "sbin", "lib", "lib64", "System", "Library"))
IMPORTLIB = os.path.dirname(importlib.__file__) + os.sep
STAGES = str(ROOT / "mechanisms" / "stages") + os.sep
DOORS = str(ROOT / "mechanisms")
PROGRAM = tuple(str(ROOT / room) + os.sep for room in ("mbsd", "shared", "render", "mechanisms/stages/automatic"))
COMPILERS = tuple(f"{os.sep}{name}{os.sep}" for name in ("numba", "llvmlite"))


class Recorder:
    """Collects what is read between its start and its end."""

    def __init__(self) -> None:
        self.files: dict[str, str] = {}
        self.folders: dict[str, str] = {}
        self.variables: dict[str, str] = {}
        self.packages: dict[str, str] = {}
        self._made: set[str] = set()
        self._set: set[str] = set()
        self._own = threading.local()

    def inputs(self) -> Inputs:
        """What was read so far."""
        return Inputs(
            files=dict(self.files),
            folders=dict(self.folders),
            variables=dict(self.variables),
            packages=dict(self.packages),
        )

    def read(self, path: Any) -> None:
        """Count a file that is read, or looked for; the first time decides what it held."""
        with self._quiet():
            self._note(self.files, path, file_state)

    def listed(self, path: Any) -> None:
        """Count a folder whose names are read."""
        with self._quiet():
            self._note(self.folders, path, folder_state)

    def module_missed(self, name: str, folders: Iterable[str]) -> None:
        """Count a module that was looked for in vain in these folders, or as an installed package."""
        top, _, below = name.rpartition(".")
        for folder in folders:
            if os.path.isdir(folder) and not is_installed(os.path.abspath(folder) + os.sep):
                self.read(os.path.join(folder, f"{below}.py"))
                self.read(os.path.join(folder, below, "__init__.py"))
        if not top:
            self.packages.setdefault(name, package_state(name))

    def made(self, path: Any) -> None:
        """Leave out from now on what the run itself writes."""
        place = _absolute(path)
        if place:
            self._made.add(place)

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

    def _note(self, states: dict[str, str], path: Any, state: Callable[[str], str]) -> None:
        place = _absolute(path)
        if place is None or not self._counts(place):
            return
        name = name_of(place)
        if name not in states:
            states[name] = state(name)

    def _counts(self, place: str) -> bool:
        if is_installed(place) or f"{os.sep}__pycache__" in place:
            return False
        if place.startswith(SYSTEM) and not place.startswith(str(ROOT) + os.sep):
            return False
        kernels = sys.modules.get("mbsd.compiling.kernel_cache")  # only once the solver compiles
        if kernels is not None and Path(place).is_relative_to(kernels.cache_root()):
            return False
        return place not in self._made and not any(str(parent) in self._made for parent in Path(place).parents)


@contextmanager
def recording() -> Iterator[Recorder]:
    """Record what is read in this block. Blocks do not nest."""
    global _active
    if _active is not None:
        raise RuntimeError("what is read is being recorded already")
    _install()
    recorder = Recorder()
    plain_stat, plain_environ = os.stat, type(os.environ)

    def watched_stat(path: Any, *arguments: Any, **options: Any) -> os.stat_result:
        if "dir_fd" not in options:
            _hear("stat", (path,))
        return plain_stat(path, *arguments, **options)

    _active = recorder
    os.stat = watched_stat
    os.environ.__class__ = _WatchedEnvironment
    last_finder = _LastFinder()
    sys.meta_path.append(last_finder)
    try:
        yield recorder
    finally:
        sys.meta_path.remove(last_finder)
        os.environ.__class__ = plain_environ
        os.stat = plain_stat
        _active = None


def is_installed(place: str) -> bool:
    """Whether a file belongs to the interpreter or to an installed package."""
    return place.startswith(PACKAGES) or place.startswith(STANDARD_LIBRARY)


def _opened(recorder: Recorder, path: Any, mode: Any, flags: Any) -> None:
    flags = flags if isinstance(flags, int) else 0
    access = flags & os.O_ACCMODE
    if access == os.O_WRONLY or (access == os.O_RDWR and flags & (os.O_TRUNC | os.O_CREAT)):
        place = _absolute(path)
        if place and name_of(place) not in recorder.files:
            recorder.made(path)
    else:
        recorder.read(path)


def _renamed(recorder: Recorder, source: Any, target: Any, *_: Any) -> None:
    if _absolute(source) in recorder._made:
        recorder.made(target)


def _started(recorder: Recorder, executable: Any, arguments: Any, cwd: Any, *_: Any) -> None:
    """Of a program that is started, the files among its words; what else it reads is its own."""
    words = arguments if isinstance(arguments, list | tuple) else []
    for word in (executable, *words):
        if isinstance(word, str | os.PathLike) and word:
            place = os.path.join(os.fspath(cwd), word) if cwd else word
            if os.path.isfile(place):
                recorder.read(place)


EVENTS: dict[str, Callable[..., None]] = {
    "open": _opened,
    "stat": lambda recorder, path: None if _is_folder(path) else recorder.read(path),
    "os.listdir": lambda recorder, path: recorder.listed(path if path is not None else "."),
    "os.scandir": lambda recorder, path: recorder.listed(path if path is not None else "."),
    "os.mkdir": lambda recorder, path, *_: recorder.made(path),
    "os.rename": _renamed,
    "tempfile.mkdtemp": lambda recorder, path: recorder.made(path),
    "tempfile.mkstemp": lambda recorder, path: recorder.made(path),
    "sqlite3.connect": lambda recorder, path: recorder.read(path),
    "ctypes.dlopen": lambda recorder, path: recorder.read(path) if os.sep in str(path) else None,
    "subprocess.Popen": _started,
}
_active: Recorder | None = None
_installed = False


def _install() -> None:
    """Audit hooks cannot be removed, so there is one, which does nothing while nothing is recorded."""
    global _installed
    if not _installed:
        sys.addaudithook(lambda event, arguments: _hear(event, arguments) if event in EVENTS else None)
        _installed = True


def _hear(event: str, arguments: tuple[Any, ...]) -> None:
    if _active is not None and _is_on_behalf_of_author(sys._getframe(2)):
        _active.hear(event, arguments)


def _is_on_behalf_of_author(frame: FrameType | None) -> bool:
    """Whether what happens in ``frame`` was asked for by the author's code, through whatever libraries.

    Not so for imports, which are seen as modules (loaded_files.py), for the compiler, and for our own stages.
    """
    while frame is not None:
        file = frame.f_code.co_filename
        if file.startswith("<frozen importlib") or any(compiler in file for compiler in COMPILERS):
            return False
        if not file.startswith("<") and not is_installed(file) and not file.startswith(PROGRAM):
            return not _is_stage(file)
        frame = frame.f_back
    return True  # a thread of a library's


def _is_stage(file: str) -> bool:
    return file.startswith(STAGES) or os.path.dirname(file) == DOORS


class _LastFinder:
    """Is asked for the modules that no other finder finds, and finds none either."""

    def find_spec(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None) -> None:
        """Note what the author's code looks for."""
        frame: FrameType | None = sys._getframe(1)
        while frame is not None and frame.f_code.co_filename.startswith(("<frozen importlib", IMPORTLIB)):
            frame = frame.f_back
        file = frame.f_code.co_filename if frame is not None else ""
        if _active is not None and not is_installed(file) and not file.startswith(PROGRAM) and not _is_stage(file):
            _active.module_missed(fullname, sys.path if path is None else path)


class _WatchedEnvironment(type(os.environ)):
    """``os.environ`` that notes which variables the author's code asks for."""

    def __getitem__(self, key: Any) -> str:
        try:
            value = super().__getitem__(key)
        except KeyError:
            self._asked(key, None)
            raise
        self._asked(key, value)
        return value

    def __setitem__(self, key: Any, value: str) -> None:
        if _active is not None:
            _active.set_variable(key)
        super().__setitem__(key, value)

    def _asked(self, key: Any, value: str | None) -> None:
        frame: FrameType | None = sys._getframe(2)
        while frame is not None and frame.f_code.co_filename in ("<frozen os>", "<frozen _collections_abc>"):
            frame = frame.f_back
        file = frame.f_code.co_filename if frame is not None else ""
        ours = file.startswith(PROGRAM) or _is_stage(file)
        if _active is not None and not ours and not file.startswith("<frozen") and not is_installed(file):
            _active.variable(key, value)


def _absolute(path: Any) -> str | None:
    """The absolute path, or None for what is none (a file descriptor, text that no path can be)."""
    if not isinstance(path, str | bytes | os.PathLike):
        return None
    place = os.fsdecode(path)
    return os.path.abspath(place) if place and "\0" not in place and place != ":memory:" else None


def _is_folder(path: Any) -> bool:
    """Whether a path is a folder that is there; that alone is asked of so many that it says nothing."""
    place = _absolute(path)
    return place is None or os.path.isdir(place)
