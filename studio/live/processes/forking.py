"""Warm process: it has loaded what the author's code needs, and forks a process for each request.

``python -m studio.live.processes.forking MODULE DESCRIPTOR`` loads a module and serves a socket. Each message is its
length (uint32, little endian) and JSON, {"name", "most_bytes"}, with two sockets: one for the module's
``serve(pipe, name)`` in the new process, one for its keeper, which says {"begun": [keeper, process]} and, at the end,
{"ended": exit code, "used": bytes}. It ends with the server's end of the socket; the keepers notice by themselves.
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import socket
import struct
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from studio.live.processes import keeper
from studio.live.processes.pipe import Pipe

LENGTH = struct.Struct("<I")
READY = b"r"
Serve = Callable[[Pipe, str], None]


def request(header: dict[str, Any]) -> bytes:
    """Return the bytes of a message to the warm process."""
    text = json.dumps(header).encode()
    return LENGTH.pack(len(text)) + text


def main() -> None:
    """Load, report readiness, and fork until the server is gone."""
    module, descriptor = sys.argv[1:]
    serve: Serve = importlib.import_module(module).serve
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the server's
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for keepers
    channel = socket.socket(fileno=int(descriptor))
    with suppress(OSError, EOFError):
        channel.sendall(READY)
        while True:
            _fork(channel, serve)
    os._exit(0)  # taking all that was loaded down takes seconds


def _fork(channel: socket.socket, serve: Serve) -> None:
    head, descriptors, _, _ = socket.recv_fds(channel, LENGTH.size, 2)
    if len(head) < LENGTH.size or len(descriptors) < 2:
        raise EOFError
    asked = json.loads(_exactly(channel, LENGTH.unpack(head)[0]))
    data, control = (socket.socket(fileno=descriptor) for descriptor in descriptors)
    with data, control:
        if os.fork() == 0:
            try:
                channel.close()
                _keep(data, control, serve, **asked)
            finally:
                os._exit(0)


def _keep(data: socket.socket, control: socket.socket, serve: Serve, name: str, most_bytes: int) -> None:
    os.setsid()
    for number in (signal.SIGINT, signal.SIGCHLD):
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)

    def work() -> int:
        control.close()
        serve(Pipe(data), name)
        return 0

    child = keeper.begin(work)
    data.close()
    _tell(control, {"begun": [os.getpid(), child]})
    code, used = keeper.keep(child, control.fileno(), most_bytes)
    _tell(control, {"ended": code, "used": used})


def _tell(control: socket.socket, words: dict[str, Any]) -> None:
    with suppress(OSError):
        control.sendall(json.dumps(words).encode() + b"\n")


def _exactly(channel: socket.socket, count: int) -> bytes:
    read = b""
    while len(read) < count:
        part = channel.recv(count - len(read))
        if not part:
            raise EOFError
        read += part
    return read


if __name__ == "__main__":
    main()
