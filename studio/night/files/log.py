"""Messages of a night: on its terminal, and with date and time in out/night/log.txt."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from datetime import datetime
from types import TracebackType
from typing import IO

from shared.stage import console
from studio.night.files.runs import log_file

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
