"""Children of the server: processes with the author's code, forked from a warm one, each with a deadline.

A child answers in frames that a thread reads; a child that loops is killed when its time is up, one that crashes is
named by what ended it. The server waits for none of them.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from studio.live.child import entry
from studio.live.frames import LARGEST, framed, unframed

Heard = Callable[["Child", dict[str, Any], bytes], None]
WARM = ["studio.live.child.warm"]
MEMORY_PART = 0.5
"""Of the machine's memory that a child may take."""


class Nursery:
    """Forks children from a process that has loaded solver and kernels."""

    def __init__(self, limit: float) -> None:
        self.limit = limit
        """Seconds that a request may take."""
        self._context: Any = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload(WARM)
        self.most_bytes = int(MEMORY_PART * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))

    def warm(self) -> None:
        """Load what children need; returns when it is loaded."""
        first = self._context.Process(target=entry.nothing)
        first.start()
        first.join()
        first.close()

    def child(self, name: str, heard: Heard, limit: float | None = None) -> Child:
        """A new child for this mechanism; ``heard`` gets what it says, in the server's loop."""
        return Child(self._context, name, heard, self.limit if limit is None else limit, self.most_bytes)


class Child:
    """One process; it does one request after the other."""

    def __init__(self, context: Any, name: str, heard: Heard, limit: float, most_bytes: int) -> None:
        self._heard, self._limit, self._loop = heard, limit, asyncio.get_running_loop()
        self._pipe, theirs = context.Pipe()
        self._end = socket.socket(fileno=os.dup(self._pipe.fileno()))
        self._process = context.Process(target=entry.main, args=(theirs, name, os.getpid(), most_bytes), daemon=True)
        self._process.start()
        theirs.close()
        self._deadline: asyncio.TimerHandle | None = None
        self.busy = False
        self.ended = False
        self._waiting: int | None = None
        threading.Thread(target=self._listen, daemon=True).start()

    def ask(self, number: int, request: dict[str, Any]) -> None:
        """Send one request; its answer, or what ended the child, is heard."""
        self.busy, self._waiting = True, number
        if self._limit > 0:
            self._deadline = self._loop.call_later(self._limit, self._too_long, number)
        with suppress(OSError):  # the listener hears of its end, too
            self._pipe.send_bytes(framed({"id": number, **request}))

    def kill(self) -> None:
        """End it now; nothing more is heard of it."""
        if self.ended:
            return
        self.ended = True
        self._stop_clock()
        with suppress(OSError, ValueError, AttributeError):
            self._process.kill()
        with suppress(OSError):  # a grandchild may hold the other end, so its end would not come by itself
            self._end.shutdown(socket.SHUT_RDWR)

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    def _listen(self) -> None:
        """In a thread: pass on what the child says until its pipe ends, and await the end of its process.

        Nobody else closes the pipe: its descriptor is another child's as soon as it is closed.
        """
        while True:
            try:
                header, payload = unframed(self._pipe.recv_bytes(LARGEST))
            except (EOFError, OSError, ValueError):
                break
            if not self._pass_on(self._take, header, payload):
                break
        self._process.join(1)
        code = self._process.exitcode
        self._process.kill()
        self._process.join(2)
        if not self._pass_on(self._gone, code):
            self._close()

    def _pass_on(self, function: Callable[..., None], *arguments: Any) -> bool:
        try:
            self._loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:  # the server has ended
            return False
        return True

    def _take(self, header: dict[str, Any], payload: bytes) -> None:
        if self.ended:
            return
        if header.get("kind") in ("motion", "error", "fitted", "solid"):
            self.busy = False
            self._stop_clock()
        self._heard(self, header, payload)

    def _too_long(self, number: int) -> None:
        if self.ended:
            return
        self.kill()
        text = (
            f"mechanism.py did not end within {self._limit:g} s and was stopped: an endless loop, or a motion that "
            "takes longer; fewer STEPS, a shorter DURATION, or --limit SECONDS for more time"
        )
        self._heard(self, {"kind": "error", "id": number, "text": text}, b"")

    def _gone(self, code: int | None) -> None:
        """The pipe has ended, by ``kill`` or while nobody wanted it to."""
        self._close()
        if self.ended:
            return
        self.ended = True
        self._stop_clock()
        text = f"mechanism.py ended the process it ran in ({_ending(code)}); no file of a mechanism should do that"
        self._heard(self, {"kind": "error", "id": self._waiting, "text": text}, b"")

    def _close(self) -> None:
        self._end.close()
        self._pipe.close()
        with suppress(ValueError):  # it runs on in spite of SIGKILL, which a broken disk can do
            self._process.close()

    def _stop_clock(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None


def _ending(code: int | None) -> str:
    if code is None:
        return "its pipe was closed"
    if code < 0:
        try:
            return f"signal {signal.Signals(-code).name}"
        except ValueError:
            return f"signal {-code}"
    return f"exit code {code}"
