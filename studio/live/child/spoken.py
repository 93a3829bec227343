"""Output of the author's code, sent to the terminal and, line by line, to the page."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from typing import TextIO

from studio.live.processes.lines import Lines

MOST = 200
"""Lines of one run that the page gets."""


class Spoken(io.TextIOBase):
    """Stream that passes on all text and reports each whole line; long lines are cut."""

    def __init__(self, through: TextIO | None, tell: Callable[[str], None]) -> None:
        self._through, self._tell = through, tell
        self._lines, self._count = Lines(), 0

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, text: str, /) -> int:
        """Pass the text on, and report the lines that it ends."""
        if self._through is not None:
            with suppress(OSError, ValueError):
                self._through.write(text)
                self._through.flush()
        for line in self._lines.add(text):
            self._line(line)
        return len(text)

    def end(self) -> None:
        """Report a last line without an end."""
        self._line(self._lines.rest())

    def _line(self, line: str) -> None:
        if not line.strip():
            return
        self._count += 1
        if self._count <= MOST:
            self._tell(line)
        elif self._count == MOST + 1:
            self._tell(f"more than {MOST} lines were printed; the terminal has the others")


@contextmanager
def to(tell: Callable[[str], None]) -> Iterator[None]:
    """Report printed lines to ``tell`` within the block."""
    out, err = Spoken(sys.stdout, tell), Spoken(sys.stderr, tell)
    with redirect_stdout(out), redirect_stderr(err):
        try:
            yield
        finally:
            with suppress(OSError):
                out.end()
                err.end()
