"""Nights on one tree: each has a number, a lock that ends with its process, a record, a stop file.

Several runs may be at work at once; a mechanism belongs to one of them while a step of it runs.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from shared.stage import locks
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import refusal
from shared.stage.paths import out_root, refuse_links

MOST = 64
"""Runs at once on one tree."""


def folder() -> Path:
    """Return the folder in which nights keep their log, records and locks."""
    return out_root() / "night"


def locks_folder() -> Path:
    """Return the folder of locks; the files stay, the locks on them end with their process."""
    return folder() / "locks"


def log_file() -> Path:
    """Return the log of all nights."""
    return folder() / "log.txt"


class Run:
    """Files of one run by its number, from 1."""

    def __init__(self, number: int) -> None:
        self.number = number
        self.lock = locks_folder() / f"run-{number}.lock"
        self.record = folder() / f"run-{number}.json"
        self.wish = folder() / f"run-{number}.stop"

    def is_alive(self) -> bool:
        """Return True if the process of this run is at work, by its lock."""
        return self.lock.exists() and not locks.is_abandoned(self.lock)

    def ask_to_stop(self) -> None:
        """Ask the run to end after the frame in flight."""
        self.wish.touch()

    def is_asked_to_stop(self) -> bool:
        """Return True if somebody asked the run to end."""
        return self.wish.exists()


def runs() -> list[Run]:
    """Return the runs with a record or a lock, by number."""
    places = [*folder().glob("run-*.json"), *locks_folder().glob("run-*.lock")]
    numbers = {path.stem.removeprefix("run-") for path in places}
    return [Run(number) for number in sorted(int(word) for word in numbers if word.isdigit())]


def alive() -> list[Run]:
    """Return the runs whose process is at work."""
    return [run for run in runs() if run.is_alive()]


@contextmanager
def taken() -> Iterator[Run]:
    """Reserve the lowest free number for this run.

    Records of runs that have ended are removed; their films are on the disk.

    Raises UserError where the folder cannot be written.
    """
    refuse_links(locks_folder())
    handle = -1
    try:
        locks_folder().mkdir(parents=True, exist_ok=True)
        for number in range(1, MOST + 1):
            run = Run(number)
            handle = _opened(run.lock)
            if _try_lock(handle):
                break
            os.close(handle)
            handle = -1
        else:
            raise UserError(f"{MOST} runs are at work on {out_root()}; {to_run('stop')} ends them")
        run.wish.unlink(missing_ok=True)
        for other in runs():
            if other.number > number and not other.is_alive():
                other.record.unlink(missing_ok=True)
                other.wish.unlink(missing_ok=True)
    except OSError as error:
        raise UserError(refusal(error.filename or folder(), error)) from error
    try:
        _sign(handle)
        yield run
    finally:
        with suppress(OSError):
            run.wish.unlink(missing_ok=True)
        os.close(handle)


class Claims:
    """Mechanisms that this run works on."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[int, int]] = {}
        """By mechanism, the handle of its lock and the number of its steps that run."""

    def claim(self, name: str) -> str:
        """Begin a step of a mechanism; else return who works on it: ``process 123 on machine``."""
        if name in self._held:
            handle, count = self._held[name]
            self._held[name] = (handle, count + 1)
            return ""
        path = locks_folder() / f"{name}.lock"
        try:
            handle = _opened(path)
        except OSError as error:
            raise UserError(refusal(path, error)) from error
        if not _try_lock(handle):
            who = os.pread(handle, 200, 0).decode(errors="replace").strip()
            os.close(handle)
            return who or "another process"
        _sign(handle)
        self._held[name] = (handle, 1)
        return ""

    def give_back(self, name: str) -> None:
        """End a step; after the last one the mechanism is free for other runs."""
        handle, count = self._held[name]
        if count > 1:
            self._held[name] = (handle, count - 1)
        else:
            del self._held[name]
            os.close(handle)


def _opened(path: Path) -> int:
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)


def _try_lock(handle: int) -> bool:
    try:
        return locks.try_lock(handle)
    except OSError:
        return True  # a disk without locks: two runs do each other's work twice there, and no harm


def _sign(handle: int) -> None:
    with suppress(OSError):  # a full disk; who it is is a courtesy
        os.ftruncate(handle, 0)
        os.pwrite(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode(), 0)
