"""Warm process as the server sees it: every wait has a limit, and its end or a stop is reported."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import sys
from asyncio.subprocess import DEVNULL, Process
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from studio.live.processes.forking import READY, request
from studio.live.processes.trees import MARK, is_stopped

MODULE = "studio.live.processes.forking"
PERIOD = 0.5
"""Seconds between two looks at whether it was stopped; at the second in a row it is given up."""
BEGIN = 30.0
"""Seconds in which it forks a process, on a machine however busy."""


class Failed(Exception):
    """Error of a warm process that cannot fork, with the reason."""


@dataclass
class Link:
    """Link to a new process: its streams, its keeper's words, and their numbers."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter
    words: asyncio.StreamReader
    control: asyncio.StreamWriter
    keeper: int
    process: int


class WarmProcess:
    """One warm process; ``gone`` is called once, with how it ended, unless it was closed."""

    def __init__(self, module: str, mark: str, gone: Callable[[WarmProcess, str], None]) -> None:
        self._module, self._mark, self._gone = module, mark, gone
        self._process: Process | None = None
        self._channel: socket.socket | None = None
        self._looking: asyncio.Task[None] | None = None
        self._over = asyncio.Event()
        self._loaded = False

    @property
    def ended(self) -> bool:
        """True if it forks no more."""
        return self._over.is_set()

    async def ends_within(self, seconds: float) -> bool:
        """Return True if it has ended within these seconds."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._over.wait(), seconds)
        return self.ended

    async def start(self) -> None:
        """Start it; returns when it has loaded everything. Raises Failed."""
        ours, theirs = socket.socketpair()
        self._channel = ours
        ours.setblocking(False)
        with theirs:
            try:
                self._process = await asyncio.create_subprocess_exec(
                    sys.executable, "-m", MODULE, self._module, str(theirs.fileno()), pass_fds=[theirs.fileno()],
                    stdin=DEVNULL, start_new_session=True, env=os.environ | {MARK: self._mark},
                )  # fmt: skip
            except OSError as error:
                self.close()
                raise Failed(f"no process can be started: {error}") from error
        self._looking = asyncio.create_task(self._look(self._process))
        try:
            ready = await asyncio.get_running_loop().sock_recv(ours, len(READY))
        except OSError:
            ready = b""
        self._loaded = True
        if self.ended:
            ours.close()
        if ready != READY or self.ended:
            raise Failed("it ended while it was loading; its words are in the terminal")

    @property
    def pid(self) -> int | None:
        """Number of the process; None before it has begun."""
        return self._process.pid if self._process is not None else None

    async def fork(self, name: str, most_bytes: int) -> Link:
        """Fork a process for the mechanism ``name``. Raises Failed."""
        data, their_data = socket.socketpair()
        control, their_control = socket.socketpair()
        try:
            with their_data, their_control:
                self._send(request({"name": name, "most_bytes": most_bytes}), their_data, their_control)
            words, control_writer = await asyncio.open_unix_connection(sock=control)
        except OSError as error:
            data.close()
            control.close()
            raise Failed(f"it does not listen ({error})") from error
        try:
            answer = json.loads(await asyncio.wait_for(words.readline(), BEGIN))
            reader, writer = await asyncio.open_unix_connection(sock=data)
        except BaseException as error:  # cancelled as well
            data.close()
            control_writer.close()
            if isinstance(error, TimeoutError | OSError | ValueError):
                raise Failed("it did not fork") from error
            raise
        return Link(reader, writer, words, control_writer, *answer["begun"])

    def close(self) -> None:
        """End it; processes that it has forked go on."""
        if self.ended:
            return
        self._over.set()
        if self._looking is not None:
            self._looking.cancel()
        self._end()

    def _send(self, message: bytes, *sockets: socket.socket) -> None:
        if self._channel is None or self.ended:
            raise OSError("it has ended")
        sent = socket.send_fds(self._channel, [message], [end.fileno() for end in sockets])
        if sent < len(message):
            raise OSError("it takes no message")

    async def _look(self, process: Process) -> None:
        """Report its end; a stopped process is ended."""
        waiting = asyncio.ensure_future(process.wait())
        looks = 0
        while not waiting.done():
            await asyncio.wait({waiting}, timeout=PERIOD)
            looks = looks + 1 if not waiting.done() and is_stopped(process.pid) else 0
            if looks == 2:
                break
        if not self.ended:
            self._over.set()
            self._end()
            self._gone(self, "was stopped" if looks == 2 else f"ended ({ending(process.returncode)})")

    def _end(self) -> None:
        if self._channel is not None:
            with suppress(OSError):
                self._channel.shutdown(socket.SHUT_RDWR)  # whoever waits for it to load is let go, and closes it
            if self._loaded or self._process is None:
                self._channel.close()
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.send_signal(signal.SIGKILL)


def ending(code: int | None) -> str:
    """Return in words how a process ended."""
    if code is None:
        return "its pipe was closed"
    if code < 0:
        try:
            return f"signal {signal.Signals(-code).name}"
        except ValueError:
            return f"signal {-code}"
    return f"exit code {code}"
