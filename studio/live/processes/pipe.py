"""Frames through a socket, each after its length (uint64, little endian). The child waits for them, the server not."""

from __future__ import annotations

import asyncio
import os
import socket
import struct
from typing import Any

from studio.live.frames import LARGEST, framed, unframed

LENGTH = struct.Struct("<Q")


class Pipe:
    """In a child: what the server sends and hears. In processes that it forks it is silent."""

    def __init__(self, end: socket.socket) -> None:
        self._end, self._owner = end, os.getpid()

    def send(self, frame: bytes) -> None:
        """Send a frame. Raises OSError where nobody hears it."""
        if os.getpid() != self._owner:
            return
        self._end.sendall(LENGTH.pack(len(frame)))
        self._end.sendall(frame)

    def receive(self) -> bytes:
        """The next frame; waits for it. Raises EOFError at the end, OSError."""
        if os.getpid() != self._owner:
            raise EOFError
        return self._exactly(LENGTH.unpack(self._exactly(LENGTH.size))[0])

    def close(self) -> None:
        """End it."""
        self._end.close()

    def _exactly(self, count: int) -> bytes:
        parts = []
        while count:
            part = self._end.recv(min(count, 1 << 20))
            if not part:
                raise EOFError
            parts.append(part)
            count -= len(part)
        return b"".join(parts)


async def heard(reader: asyncio.StreamReader) -> tuple[dict[str, Any], bytes] | None:
    """In the server: header and payload of the next frame of a child; None at the end, or where it is no frame."""
    try:
        (size,) = LENGTH.unpack(await reader.readexactly(LENGTH.size))
        return unframed(await reader.readexactly(size)) if size <= LARGEST else None
    except (asyncio.IncompleteReadError, OSError, ValueError, RecursionError):
        return None


def asked(header: dict[str, Any], payload: bytes = b"") -> bytes:
    """In the server: the bytes that a child receives as one frame."""
    frame = framed(header, payload)
    return LENGTH.pack(len(frame)) + frame
