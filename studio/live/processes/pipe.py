"""Frames through a socket, each after its length (uint64, little endian).

The child waits for them, the server does not.
"""

from __future__ import annotations

import asyncio
import os
import socket
import struct
from typing import Any

from studio.live.messages import LARGEST_FRAME, framed, unframed

# Text that comes in pieces, as lines of a bounded length: longer ones are cut, the rest is skipped.


LONGEST = 2000
"""Characters of a line."""
CUT = " ..."


class Lines:
    """Cutter of text into lines; no piece is too long, and no more than one line is kept."""

    def __init__(self) -> None:
        self._begun, self._over = "", False

    def add(self, text: str) -> list[str]:
        """Add text and return the lines that it ends."""
        *whole, rest = text.split("\n")
        lines = []
        for piece in whole:
            self._append(piece)
            lines.append(self.rest())
        self._append(rest)
        return lines

    def rest(self) -> str:
        """Return the line that has no end yet; a new one begins."""
        line = self._begun.rstrip("\r") + CUT * self._over
        self._begun, self._over = "", False
        return line

    def _append(self, piece: str) -> None:
        room = LONGEST - len(self._begun)
        self._over = self._over or len(piece) > room
        self._begun += piece[:room]


LENGTH = struct.Struct("<Q")


class Pipe:
    """Pipe of a child to the server. In processes that the child forks it is silent."""

    def __init__(self, end: socket.socket) -> None:
        self._end, self._owner = end, os.getpid()

    def send(self, frame: bytes) -> None:
        """Send a frame. Raises OSError if nobody receives it."""
        if os.getpid() != self._owner:
            return
        self._end.sendall(LENGTH.pack(len(frame)))
        self._end.sendall(frame)

    def receive(self) -> bytes:
        """Wait for the next frame and return it. Raises EOFError at the end, OSError."""
        if os.getpid() != self._owner:
            raise EOFError
        return self._exactly(LENGTH.unpack(self._exactly(LENGTH.size))[0])

    def close(self) -> None:
        """Close the pipe."""
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
    """Return header and payload of a child's next frame; None at the end or for an invalid one.

    It is called in the server.
    """
    try:
        (size,) = LENGTH.unpack(await reader.readexactly(LENGTH.size))
        return unframed(await reader.readexactly(size)) if size <= LARGEST_FRAME else None
    except (asyncio.IncompleteReadError, OSError, ValueError, RecursionError):
        return None


def request_frame(header: dict[str, Any], payload: bytes = b"") -> bytes:
    """Return the bytes that a child receives as one frame. It is called in the server."""
    frame = framed(header, payload)
    return LENGTH.pack(len(frame)) + frame
