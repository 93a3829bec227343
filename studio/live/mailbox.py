"""Messages that wait for one page: in order, but only the newest motion, so a slow page stays current."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable

MOST, LARGEST = 256, 1 << 28
"""Messages that wait at most, and their bytes; a page that is slower than that gets the state anew."""


class Mailbox:
    """Messages from the server's loop to one page; ``anew`` gives those that replace dropped ones."""

    def __init__(self, anew: Callable[[], list[bytes]]) -> None:
        self._anew = anew
        self._waiting: deque[tuple[bytes, bool]] = deque()
        self._bytes = 0
        self._some = asyncio.Event()

    def add(self, frame: bytes, replaces: bool = False) -> None:
        """Add a frame; with ``replaces`` it takes the place of an older replaceable one."""
        if replaces:
            self._bytes -= sum(len(message) for message, replaced in self._waiting if replaced)
            self._waiting = deque(message for message in self._waiting if not message[1])
        self._append(frame, replaces)
        if len(self._waiting) > MOST or self._bytes > LARGEST:
            self._waiting.clear()
            self._bytes = 0
            for message in self._anew():
                self._append(message, False)
        self._some.set()

    async def get(self) -> bytes:
        """Wait for the next frame and return it."""
        while not self._waiting:
            self._some.clear()
            await self._some.wait()
        frame, _ = self._waiting.popleft()
        self._bytes -= len(frame)
        return frame

    def _append(self, frame: bytes, replaces: bool) -> None:
        self._waiting.append((frame, replaces))
        self._bytes += len(frame)

    def __len__(self) -> int:
        return len(self._waiting)
