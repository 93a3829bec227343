"""The parts of a mechanism, made beside the page: a newer edit ends the run and begins it anew."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from asyncio.subprocess import PIPE, STDOUT, Process
from collections.abc import Callable
from contextlib import suppress

from shared.stage.paths import ROOT

COMMAND = [sys.executable, "-m", "mechanisms"]
Told = Callable[[str], None]
NICE = 10
"""The parts wait for the page, not the page for them."""
LAST = 20
"""Lines of a stage that are kept."""


class Stages:
    """Runs ``python -m mechanisms STAGE NAME`` one after the other, the newest wish alone."""

    def __init__(self, name: str, tell: Told, done: Callable[[bool], None]) -> None:
        self.name, self._tell, self._done = name, tell, done
        self._task: asyncio.Task[None] | None = None
        self._process: Process | None = None

    @property
    def running(self) -> bool:
        """Whether parts are being made."""
        return self._task is not None and not self._task.done()

    def begin(self) -> None:
        """Make the parts of the files as they are now; an older run is ended."""
        self.end()
        self._task = asyncio.get_running_loop().create_task(self._run())

    def end(self) -> None:
        """End the run, if there is one."""
        if self._task is not None:
            self._task.cancel()
            self._task = None
        process, self._process = self._process, None
        if process is not None and process.returncode is None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)

    async def _run(self) -> None:
        good = await self._stage("parts", "--or-none")
        if good is not None:
            self._done(good)

    async def _stage(self, *words: str) -> bool | None:
        stage, *options = words
        command = [*COMMAND, stage, self.name, *options]
        environment = os.environ | {"NO_COLOR": "1", "TERM": "dumb"}
        process = await asyncio.create_subprocess_exec(
            *command, cwd=ROOT, env=environment, stdin=asyncio.subprocess.DEVNULL, stdout=PIPE, stderr=STDOUT,
            start_new_session=True,
        )  # fmt: skip
        self._process = process
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, process.pid, NICE)
        assert process.stdout is not None
        lines: list[str] = []
        async for line in process.stdout:
            lines = [*lines, line.decode(errors="replace").rstrip()][-LAST:]
        good = await process.wait() == 0
        for line in lines if not good else lines[-1:]:
            if line and "nothing to do" not in line:
                self._tell(line)
        return good
