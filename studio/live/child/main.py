"""Loop of the child: it reads requests from a pipe and answers with frames (studio/live/messages.py).

    {"do": "open"}                                 -> motion, with numbers and files
    {"do": "set", "values": {...}}                 -> motion
    {"do": "solid"}                                -> solid: of the payload, what the parts change
    {"do": "describe"}                             -> described: label and unit of each number of Params
    {"do": "drag", "values", "thing", "time", "to"} -> motion, with the values that put the thing there
    {"do": "fit", ...}                             -> progress ..., fitted
    {"do": "numbers"}, source of a mechanism.py    -> numbers, that it would have

Every answer has the request's "id". What cannot be done is {"kind": "error", "text"}; what the author's code prints is
{"kind": "line", "text"}.
"""

from __future__ import annotations

import io
import os
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from typing import Any, TextIO

from mechanisms.stages.loading import loading
from shared.stage.errors import UserError
from shared.stage.paths import mechanism_file
from studio.live.child.author import Answer, Author
from studio.live.child.described import described
from studio.live.child.dragging import dragged, fitted
from studio.live.messages import framed, unframed
from studio.live.numbers import numbers_of
from studio.live.processes.pipe import Lines, Pipe

# Numbers that a mechanism.py would have with another source: a change in it may have no effect.


def numbers_with(name: str, source: bytes) -> list[dict[str, Any]]:
    """Return the numbers of Params with ``source`` in place of the file's.

    This process is of no other use afterwards.

    Raises UserError where it cannot be loaded.
    """
    loading.INSTEAD[os.path.realpath(mechanism_file(name))] = source
    return [vars(number) for number in numbers_of(loading.params(name))]


# Output of the author's code, sent to the terminal and, line by line, to the page.


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


Send = Callable[..., None]


def main(pipe: Pipe, name: str) -> None:
    """Serve until the pipe is closed."""
    sending = threading.Lock()

    def send(header: dict[str, Any], payload: bytes = b"") -> None:
        frame = framed(header, payload)
        with sending:
            pipe.send(frame)

    with suppress(EOFError, OSError), to(lambda text: send({"kind": "line", "text": text})):
        _serve(pipe, name, send)


def _serve(pipe: Pipe, name: str, send: Send) -> None:
    author: Author | None = None
    while True:
        request, source = unframed(pipe.receive())
        number = request.get("id")

        def reply(header: dict[str, Any], payload: bytes = b"", number: Any = number) -> None:
            send({"id": number, **header}, payload)

        try:
            if request["do"] == "numbers":
                reply({"kind": "numbers", "numbers": numbers_with(name, source)})
                continue
            if author is None or request["do"] == "open":
                author = Author(name, lambda files, reply=reply: reply({"kind": "files", "files": [*map(str, files)]}))
            HANDLERS[request["do"]](author, request, reply)
        except UserError as error:
            reply({"kind": "error", "text": str(error)})
        except (Exception, SystemExit, KeyboardInterrupt) as error:
            text = "".join(traceback.format_exception_only(error)).strip()
            reply({"kind": "error", "text": f"{name}: {text}"})


def _open(author: Author, request: dict[str, Any], reply: Send) -> None:
    answer = author.answer(request.get("values") or {})
    numbers = [vars(number) for number in numbers_of(author.params)]
    _motion(answer, reply, numbers=numbers)


def _set(author: Author, request: dict[str, Any], reply: Send) -> None:
    _motion(author.answer(request["values"], not request.get("final"), bool(request.get("arrows"))), reply)


def _describe(author: Author, request: dict[str, Any], reply: Send) -> None:
    reply({"kind": "described", "words": described(author)})


def _solid(author: Author, request: dict[str, Any], reply: Send) -> None:
    author.answer({})
    parts = author.solid()
    reply({"kind": "solid"}, parts or b"")


def _drag(author: Author, request: dict[str, Any], reply: Send) -> None:
    values = dragged(author, request["values"], request["thing"], request["time"], request["to"])
    _motion(author.answer(values, not request.get("final"), bool(request.get("arrows"))), reply, values=values)


def _fit(author: Author, request: dict[str, Any], reply: Send) -> None:
    fitted(author, request, reply)


def _motion(answer: Answer, reply: Send, **more: Any) -> None:
    stop = vars(answer.stop) if answer.stop else None
    reply({"kind": "motion", "stop": stop, **more}, answer.payload)


HANDLERS: dict[str, Callable[[Author, dict[str, Any], Send], None]] = {
    "open": _open,
    "set": _set,
    "drag": _drag,
    "solid": _solid,
    "describe": _describe,
    "fit": _fit,
}
