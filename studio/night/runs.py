"""Runs on one tree: each has a number, a lock that ends with its process, a record, a log and a stop."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import IO, Literal

import msgspec

from shared.stage import console, files, jsonfile
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import refusal
from shared.stage.paths import out_root, refuse_links

# Nights on one tree: each has a number, a lock that ends with its process, a record, a stop file.
#
# Several runs may be at work at once; a mechanism belongs to one of them while a step of it runs.


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
        return self.lock.exists() and not files.is_abandoned(self.lock)

    def ask_to_stop(self) -> None:
        """Ask the run to end after the current frame."""
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
        """Handle of the lock and number of running steps, by mechanism."""

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
        return files.try_lock(handle)
    except OSError:
        return True  # a disk without locks: two runs do each other's work twice there, and no harm


def _sign(handle: int) -> None:
    with suppress(OSError):  # a full disk; who it is is a courtesy
        os.ftruncate(handle, 0)
        os.pwrite(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode(), 0)


# Record of a run: the state of every film, rewritten after each change. Nothing depends on it.


class FilmRecord(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One mechanism."""

    outcome: Literal["waiting", "at work", "done", "failed"]
    steps: dict[str, str]
    """State by step, as of the board."""
    seconds: float = 0.0
    """Seconds that its steps took in this run, added up."""
    done: int = 0
    """Pictures of the film that are there."""
    all: int = 0
    """Pictures of the film; 0 until motion, parts and shot are there."""
    each: float | None = None
    """Seconds a picture."""
    left: float | None = None
    """Seconds until the last picture."""
    error: str = ""
    """The last error, of whichever step."""
    elsewhere: str = ""
    """The other process that is at it, in words; empty if none is."""


class NightRecord(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One run."""

    schema: Literal["mbsd.night"] = "mbsd.night"
    schema_version: Literal[1] = 1
    process: int
    host: str
    preset: str
    started: str
    """Local date and time."""
    updated: str
    ended: Literal["", "done", "failed", "stopped"] = ""
    """Empty while it runs, and for ever where it was killed."""
    forecast: str = ""
    """The forecast of the whole night, in a sentence; empty until it stands."""
    left: float | None = None
    """Seconds until the last film, of what is known."""
    films: dict[str, FilmRecord]


def write(run: Run, record: NightRecord) -> bool:
    """Write the record; False if the disk takes none, which stops no film."""
    try:
        jsonfile.write(run.record, record)
    except UserError:
        return False
    return True


def read(run: Run) -> NightRecord | None:
    """Return the record of a run; None if there is none or it cannot be read."""
    try:
        return jsonfile.read(run.record, NightRecord)
    except UserError:
        return None


# Messages of a night: on its terminal, and with date and time in out/night/log.txt.


LONGEST = 20e6
"""Bytes of the log after which a new one begins; the old one stays as log-before.txt."""


class Log:
    """Log of a night. A terminal that has gone, or a full disk, stops no film."""

    def __init__(self, number: int) -> None:
        self.mark = f" [{number}]" if number > 1 else ""
        """Tells lines of several runs apart."""
        self._file: int | None = None

    def __enter__(self) -> Log:
        path = log_file()
        with suppress(OSError):
            if path.exists() and path.stat().st_size > LONGEST:
                path.replace(path.with_name("log-before.txt"))
            self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW, 0o644)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def say(self, text: str) -> None:
        """Write a line of the night itself."""
        self._write(f"night: {text}")
        self._show(lambda: console.say("night", text))

    def warn(self, text: str) -> None:
        """Write a line that the user should see in the morning."""
        self._write(f"night: warning: {text}")
        self._show(lambda: console.warn("night", text))

    def fail(self, text: str) -> None:
        """Write a line on stderr that reports a failure."""
        self._write(f"error: {text}")
        self._show(lambda: console.fail(text))

    def relay(self, text: str, stream: IO[str] | None = None) -> None:
        """Write a line of a step's output."""
        self._write(text)
        self._show(lambda: print(text, file=stream or sys.stdout, flush=True))

    def _write(self, text: str) -> None:
        if self._file is not None:
            line = f"{datetime.now():%Y-%m-%d %H:%M:%S}{self.mark} {text}\n"
            with suppress(OSError):
                os.write(self._file, line.encode(errors="replace"))

    def _show(self, how: object) -> None:
        with suppress(OSError):
            if callable(how):
                how()
