"""What the author's code prints goes to the terminal and, line by line, to the page."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from typing import TextIO

MOST = 200
"""Lines of one run that the page gets."""
LONGEST = 2000
"""Characters of a line."""


class Spoken(io.TextIOBase):
    """A stream that passes on what is written, and tells each whole line."""

    def __init__(self, through: TextIO | None, tell: Callable[[str], None]) -> None:
        self._through, self._tell = through, tell
        self._begun, self._count = "", 0

    def writable(self) -> bool:
        """It is."""
        return True

    def write(self, text: str, /) -> int:
        """Pass it on, and tell the lines that it ends."""
        if self._through is not None:
            with suppress(OSError, ValueError):
                self._through.write(text)
                self._through.flush()
        *lines, self._begun = (self._begun + text).split("\n")
        self._begun = self._begun[-LONGEST:]
        for line in lines:
            self._count += 1
            if line.strip() and self._count <= MOST:
                self._tell(line[:LONGEST])
        return len(text)


@contextmanager
def to(tell: Callable[[str], None]) -> Iterator[None]:
    """Within the block, tell what is printed."""
    out, err = Spoken(sys.stdout, tell), Spoken(sys.stderr, tell)
    with redirect_stdout(out), redirect_stderr(err):
        yield
