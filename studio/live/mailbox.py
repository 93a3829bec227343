"""What waits for one page: in order, but of motions only the newest, so that a slow page sees the present."""

from __future__ import annotations

import asyncio
from collections import deque

MOST = 256
"""Messages that wait at most; the oldest are dropped."""


class Mailbox:
    """Messages from the server's loop to one page."""

    def __init__(self) -> None:
        self._waiting: deque[tuple[bytes, bool]] = deque()
        self._some = asyncio.Event()

    def put(self, frame: bytes, replaces: bool = False) -> None:
        """Add a frame; one that ``replaces`` takes the place of an older one that did."""
        if replaces:
            kept = [one for one in self._waiting if not one[1]]
            self._waiting = deque(kept)
        self._waiting.append((frame, replaces))
        while len(self._waiting) > MOST:
            self._waiting.popleft()
        self._some.set()

    async def get(self) -> bytes:
        """The next frame; waits for one."""
        while not self._waiting:
            self._some.clear()
            await self._some.wait()
        return self._waiting.popleft()[0]

    def __len__(self) -> int:
        return len(self._waiting)
