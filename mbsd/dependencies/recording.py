"""Records of the files, folders, variables and modules that a user's code reads while it runs.

Python reports every file that is opened and every folder that is listed (audit events); questions whether a file
exists and variables of the environment are seen because ``os.stat`` and ``os.environ`` are replaced meanwhile. Left out
are files that the run itself makes, the interpreter, installed packages (their versions count instead) and caches of
compiled code. What cannot be seen: what a program started by the code reads on its own, files that compiled libraries
open by themselves, time, random numbers and the network.
"""

from __future__ import annotations

import importlib
import os
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType, ModuleType
from typing import Any, Literal

from mbsd.dependencies.inputs import Places
from mbsd.dependencies.installed import is_installed
from mbsd.dependencies.recorder import EVENTS, Recorder

IMPORTLIB = os.path.dirname(importlib.__file__) + os.sep
COMPILERS = tuple(f"{os.sep}{name}{os.sep}" for name in ("numba", "llvmlite"))

_active: tuple[Recorder, ...] = ()
_changing = threading.RLock()
_plain_stat = os.stat
_plain_environ = type(os.environ)
_installed = False


@contextmanager
def recording(recorder: Recorder) -> Iterator[Recorder]:
    """Record what is read in this block, in all threads.

    Blocks may nest, and overlap in threads; a recorder may take in several blocks.
    """
    with _changing:
        _begin(recorder)
    try:
        yield recorder
    finally:
        with _changing:
            _end(recorder)


def _begin(recorder: Recorder) -> None:
    global _active
    _install()
    if not _active:
        os.stat = _watched_stat
        os.environ.__class__ = _WatchedEnvironment
        sys.meta_path.append(_last_finder)
    _active = (*_active, recorder)


def _end(recorder: Recorder) -> None:
    global _active
    left = list(_active)
    left.remove(recorder)
    _active = tuple(left)
    if not _active:
        sys.meta_path.remove(_last_finder)
        os.environ.__class__ = _plain_environ
        os.stat = _plain_stat


def _install() -> None:
    """Audit hooks cannot be removed, so there is one, which does nothing while nothing is recorded."""
    global _installed
    if not _installed:
        sys.addaudithook(lambda event, arguments: _hear(event, arguments) if event in EVENTS else None)
        _installed = True


def _watched_stat(path: Any, *arguments: Any, **options: Any) -> os.stat_result:
    if "dir_fd" not in options:
        _hear("stat", (path,))
    return _plain_stat(path, *arguments, **options)


def _hear(event: str, arguments: tuple[Any, ...]) -> None:
    for recorder in _active:
        match _asked_by(sys._getframe(2), recorder.places):
            case "user":
                recorder.hear(event, arguments)
            case "import" if event == "open":
                recorder.module_opened(arguments[0])


def _asked_by(frame: FrameType | None, places: Places) -> Literal["user", "import"] | None:
    """Return the cause of an event in ``frame``: the user's code, an import, or None.

    The user's code may act through libraries. None stands for the compiler, and for what the program reads by itself.
    """
    while frame is not None:
        file = frame.f_code.co_filename
        if file.startswith("<frozen importlib"):
            return "import"
        if any(compiler in file for compiler in COMPILERS):
            return None
        if not file.startswith("<") and not is_installed(file) and not places.is_program(file):
            return None if places.acts_for_itself(file) else "user"
        frame = frame.f_back
    return "user"  # a thread of a library's


class _LastFinder:
    """Is asked for the modules that no other finder finds, and finds none either."""

    def find_spec(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None) -> None:
        """Note what the user's code looks for."""
        frame: FrameType | None = sys._getframe(1)
        while frame is not None and frame.f_code.co_filename.startswith(("<frozen importlib", IMPORTLIB)):
            frame = frame.f_back
        file = frame.f_code.co_filename if frame is not None else ""
        for recorder in _active:
            if not is_installed(file) and not _is_ours(file, recorder.places):
                recorder.module_missed(fullname, sys.path if path is None else path)


_last_finder: Any = _LastFinder()


class _WatchedEnvironment(type(os.environ)):
    """``os.environ`` that notes which variables the user's code asks for."""

    def __getitem__(self, key: Any) -> str:
        try:
            value = super().__getitem__(key)
        except KeyError:
            self._note(key, None)
            raise
        self._note(key, value)
        return value

    def __setitem__(self, key: Any, value: str) -> None:
        for recorder in _active:
            recorder.set_variable(key)
        super().__setitem__(key, value)

    def _note(self, key: Any, value: str | None) -> None:
        frame: FrameType | None = sys._getframe(2)
        while frame is not None and frame.f_code.co_filename in ("<frozen os>", "<frozen _collections_abc>"):
            frame = frame.f_back
        file = frame.f_code.co_filename if frame is not None else ""
        for recorder in _active:
            if not _is_ours(file, recorder.places) and not file.startswith("<frozen") and not is_installed(file):
                recorder.variable(key, value)


def _is_ours(file: str, places: Places) -> bool:
    return places.is_program(file) or places.acts_for_itself(file)
