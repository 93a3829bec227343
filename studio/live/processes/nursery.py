"""Source of processes with the author's code: a warm process, replaced when it has ended or stopped."""

from __future__ import annotations

import asyncio
import os
import secrets
import time
from collections.abc import Callable
from contextlib import suppress

from shared.stage.console import warn
from studio.live.processes.children import Child, Heard
from studio.live.processes.trees import end_marked
from studio.live.processes.warm_process import Failed, Link, WarmProcess

WARM = "studio.live.child.warm"
"""Module that the warm process loads; its ``serve`` runs in each process."""
MEMORY_PART = 0.5
"""Fraction of the machine's memory that a child may take with all that it begins."""
TRIES = 3
"""Warm processes that are asked before a process is given up."""
MOMENT = 2.0
"""Seconds in which a warm process that gave no process is known to have ended."""
QUICK = 5.0
"""Seconds: one that has ended sooner after it was ready is begun again only when a child is asked for."""
PATIENCE = 10.0
"""Seconds that the children get to end with the server."""


class Nursery:
    """Forks of a process that has loaded solver and kernels."""

    def __init__(self, limit: float, module: str | None = None) -> None:
        self.limit = limit
        """Seconds that a request may take."""
        self.say: Callable[[str], None] = lambda text: warn("live", text)
        """Told in a sentence when the warm process had to be started anew."""
        self.most_bytes = int(MEMORY_PART * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
        self.mark = f"{os.getpid()}-{secrets.token_hex(8)}"
        """In the environment of all processes of this server."""
        self._module = WARM if module is None else module
        self._warm: WarmProcess | None = None
        self._starting: asyncio.Task[WarmProcess] | None = None
        self._children: set[asyncio.Task[None]] = set()
        self._since = 0.0
        """Time at which the warm process was ready (s, by the monotonic clock)."""
        self._ended = False

    @property
    def warm_pid(self) -> int | None:
        """Number of the warm process, None if there is none."""
        return self._warm.pid if self._warm is not None else None

    async def warm(self) -> None:
        """Have the warm process load everything; returns when it has. Raises Failed."""
        await self._ready()

    def child(self, name: str, heard: Heard, limit: float | None = None) -> Child:
        """Return a new child for this mechanism; ``heard`` gets its messages, in the server's loop."""
        child = Child(lambda: self._link(name), heard, self.limit if limit is None else limit, self.most_bytes)
        self._children.add(child.task)
        child.task.add_done_callback(self._children.discard)
        return child

    async def end(self) -> None:
        """End the warm process and all processes with this server's mark; children are killed before."""
        self._ended = True
        if self._children:
            await asyncio.wait(self._children, timeout=PATIENCE)
        if self._starting is not None:
            self._starting.cancel()
        if self._warm is not None:
            self._warm.close()
        await asyncio.get_running_loop().run_in_executor(None, end_marked, self.mark)

    async def _link(self, name: str) -> Link:
        for _ in range(TRIES):
            warm = await self._ready()
            try:
                return await warm.fork(name, self.most_bytes)
            except Failed as error:
                if not await warm.ends_within(MOMENT):  # how it ended says more
                    warm.close()
                    self._gone(warm, f"gave no process: {error}")
        raise Failed(
            f"no process could be forked for mechanism.py, {TRIES} times in a row; save the file again, or start the "
            "live page again"
        )

    async def _ready(self) -> WarmProcess:
        """Return the warm process; the first caller starts it."""
        if self._starting is None and self._warm is not None and not self._warm.ended:
            return self._warm
        if self._starting is None:
            self._starting = asyncio.create_task(self._start())
            self._starting.add_done_callback(self._started)
        return await asyncio.shield(self._starting)

    async def _start(self) -> WarmProcess:
        """Start a warm process.

        One that ends while it loads is started again a few times, for that may have been a signal.
        """
        reason = ""
        for _ in range(TRIES):
            warm = WarmProcess(self._module, self.mark, self._gone)
            self._warm = warm
            try:
                await warm.start()
                self._since = time.monotonic()
                return warm
            except Failed as error:
                reason = str(error)
            except BaseException:
                warm.close()
                raise
            finally:
                if self._ended:
                    warm.close()
            warm.close()
        raise Failed(
            f"the process that loads the solver for mechanism.py cannot be started: {reason}; save the file again to "
            "try once more"
        )

    def _started(self, task: asyncio.Task[WarmProcess]) -> None:
        self._starting = None
        if not task.cancelled():
            task.exception()  # whoever waited has it; if nobody did, the next one tries anew

    def _gone(self, warm: WarmProcess, how: str) -> None:
        """Start another warm process after one has ended, and inform the pages."""
        if self._ended or warm is not self._warm:
            return
        self.say(f"the process from which those of mechanism.py are forked {how}; it is replaced")
        if (
            self._starting is None and time.monotonic() - self._since > QUICK
        ):  # else when it is needed: it could go on so
            with suppress(RuntimeError):  # the loop has ended
                self._starting = asyncio.create_task(self._start())
                self._starting.add_done_callback(self._started)
