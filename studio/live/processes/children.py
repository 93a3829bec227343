"""Children of the server: processes with the author's code, forked from a warm one, with deadlines.

A child that loops is ended when its time is up, one that crashes is named by what ended it. The server waits for none
of them: it asks without waiting, and a task hears the answers.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

from studio.live.processes.pipe import heard, request_frame
from studio.live.processes.trees import end_with_below
from studio.live.processes.warm_process import Failed, Link, ending

Heard = Callable[["Child", dict[str, Any], bytes], None]
ANSWERS = ("motion", "error", "fitted", "solid", "numbers", "described")
"""Kinds of messages that end a request."""
MOMENT = 1.0
"""Seconds between the end of what a child says and its keeper's word on it."""
PATIENCE = 3.0
"""Seconds in which a keeper ends all that it keeps; one that was stopped does not."""


class Child:
    """One process; it handles one request after the other."""

    def __init__(self, begin: Callable[[], Awaitable[Link]], heard: Heard, limit: float, most_bytes: int) -> None:
        self._begin, self._heard, self._limit, self._most_bytes = begin, heard, limit, most_bytes
        self._loop = asyncio.get_running_loop()
        self._link: Link | None = None
        self._asked: list[bytes] = []
        self._deadline: asyncio.TimerHandle | None = None
        self._waiting: int | None = None
        self._killed = asyncio.Event()
        self.busy = False
        self.ended = False
        self.task = self._loop.create_task(self._live())
        """Done when the process and all that it has begun have ended."""

    def ask(self, number: int, request: dict[str, Any], payload: bytes = b"") -> None:
        """Send one request; its answer, or the reason of the child's end, is reported.

        Its time begins with the process.
        """
        self.busy, self._waiting = True, number
        frame = request_frame({"id": number, **request}, payload)
        if self._link is None:
            self._asked.append(frame)
        else:
            self._send(self._link, frame)

    def kill(self) -> None:
        """End the process now; nothing more is reported of it."""
        self.ended = True
        self._killed.set()
        self._stop_clock()
        if self._link is not None:
            self._let_go(self._link)

    @property
    def pid(self) -> int:
        """Number of the process; 0 before it has begun."""
        return self._link.process if self._link is not None else 0

    async def _live(self) -> None:
        try:
            link = self._link = await self._begin()
        except Failed as error:
            self._over(str(error))
            return
        if self.ended:
            self._let_go(link)
        else:
            for frame in self._asked:
                self._send(link, frame)
        try:
            text = await self._until_it_ends(link)
            self._loop.call_soon(self._over, text)  # after what it has said
        finally:
            self._let_go(link)
            await self._awaited(link)

    async def _until_it_ends(self, link: Link) -> str:
        """Wait for the end of the process, by ``kill`` or by itself; return a sentence on it."""
        hearing = asyncio.ensure_future(self._hear(link))
        words = asyncio.ensure_future(link.words.readline())
        killed = asyncio.ensure_future(self._killed.wait())
        tasks = {hearing, words, killed}
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            if not self.ended:
                await asyncio.wait({hearing, words}, timeout=MOMENT)
            return self._ending(words.result() if words.done() else None)
        except (OSError, ValueError):
            return self._ending(b"")
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.wait(tasks)

    async def _hear(self, link: Link) -> None:
        while (message := await heard(link.reader)) is not None:
            self._loop.call_soon(self._receive, *message)

    def _receive(self, header: dict[str, Any], payload: bytes) -> None:
        if self.ended:
            return
        if header.get("kind") in ANSWERS:
            self.busy = False
            self._stop_clock()
        self._heard(self, header, payload)

    def _send(self, link: Link, frame: bytes) -> None:
        with suppress(OSError, RuntimeError):  # its end is heard of as well
            link.writer.write(frame)
        if self._limit > 0:
            self._stop_clock()
            self._deadline = self._loop.call_later(self._limit, self._too_long)

    def _too_long(self) -> None:
        if self.ended:
            return
        self._over(
            f"mechanism.py did not end within {self._limit:g} s and was stopped: an endless loop, or a motion that "
            "takes longer; fewer STEPS, a shorter DURATION, or --limit SECONDS for more time"
        )

    def _ending(self, words: bytes | None) -> str:
        """Return a sentence on its end, from the keeper's last words.

        It says so if the keeper was killed from outside.
        """
        if words == b"":
            return (
                "the process of mechanism.py was ended from outside, with the one that watches over it; save again, "
                "and the file is solved once more"
            )
        outcome = json.loads(words) if words is not None else {"ended": None, "used": 0}
        if outcome["used"]:
            return (
                f"mechanism.py has taken {outcome['used'] / 2**30:.1f} GiB of memory, more than the "
                f"{self._most_bytes / 2**30:.1f} GiB that a live page gives it, and was stopped. Use fewer steps or a "
                "shorter motion"
            )
        how = ending(outcome["ended"])
        return f"mechanism.py ended the process it ran in ({how}); no file of a mechanism should do that"

    def _over(self, text: str) -> None:
        """End the process, unless it has ended, and report the reason."""
        if self.ended:
            return
        self.kill()
        self._heard(self, {"kind": "error", "id": self._waiting, "text": text}, b"")

    def _let_go(self, link: Link) -> None:
        """Ask the keeper to end the process and all below it."""
        with suppress(OSError, RuntimeError):
            if link.control.can_write_eof() and not link.control.is_closing():
                link.control.write_eof()

    async def _awaited(self, link: Link) -> None:
        """Wait for the keeper; one that does not end is killed with all that is below it."""
        try:
            await asyncio.wait_for(link.words.read(), PATIENCE)
        except TimeoutError:
            await self._loop.run_in_executor(None, end_with_below, link.keeper)
        except OSError:
            pass
        link.control.close()
        link.writer.close()

    def _stop_clock(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None
