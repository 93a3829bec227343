"""Stages that build the parts beside the page: a newer edit ends the run and begins it anew."""

from __future__ import annotations

import asyncio
import codecs
import os
import sys
from asyncio.subprocess import PIPE, STDOUT, Process
from collections import deque
from collections.abc import Callable
from contextlib import suppress

from shared.stage.paths import ROOT
from studio.live.processes.pipe import Lines
from studio.live.processes.trees import MARK, end_with_below

COMMAND = [sys.executable, "-m", "mechanisms"]
KEEPER = [sys.executable, "-m", "studio.live.processes.keeper"]
Told = Callable[[str], None]
NICE = 10
"""The parts wait for the page, not the page for them."""
LAST = 20
"""Lines of a stage that are kept."""
CHUNK = 1 << 16
PATIENCE = 3.0
"""Seconds in which a keeper ends a run."""


class Stages:
    """Runs of ``python -m mechanisms STAGE NAME`` one after the other, only for the newest request."""

    def __init__(self, name: str, mark: str, tell: Told, done: Callable[[bool], None]) -> None:
        self.name, self._mark, self._tell, self._done = name, mark, tell, done
        self._task: asyncio.Task[None] | None = None
        self._ending: set[asyncio.Task[None]] = set()

    @property
    def running(self) -> bool:
        """True if parts are being built."""
        return self._task is not None and not self._task.done()

    def begin(self) -> None:
        """Build the parts of the files as they are now; an older run is ended."""
        self.end()
        self._task = asyncio.get_running_loop().create_task(self._run())

    def end(self) -> None:
        """End the run, if there is one, with all processes that it has begun."""
        if self._task is not None:
            task, self._task = self._task, None
            task.cancel()
            if not task.done():
                self._ending.add(task)
                task.add_done_callback(self._ending.discard)

    async def ended(self) -> None:
        """End the run, and wait for its end."""
        self.end()
        if self._ending:
            await asyncio.wait(self._ending)

    async def _run(self) -> None:
        """Run the stages; whatever happens, the page hears of an end."""
        try:
            good = await self._stage("parts", "--or-none")
        except Exception as error:
            self._tell(f"the parts cannot be made: {error}")
            good = False
        self._done(good)

    async def _stage(self, *words: str) -> bool:
        stage, *options = words
        environment = os.environ | {"NO_COLOR": "1", "TERM": "dumb", MARK: self._mark}
        process = await asyncio.create_subprocess_exec(
            *KEEPER, str(NICE), *COMMAND, stage, self.name, *options, cwd=ROOT, env=environment, stdin=PIPE,
            stdout=PIPE, stderr=STDOUT, start_new_session=True,
        )  # fmt: skip
        try:
            lines = await _said(process)
            code = await process.wait()
        finally:
            await _end(process)
        for line in lines if code else list(lines)[-1:]:
            if line and "nothing to do" not in line:
                self._tell(line)
        if code > 128 or (code and not lines):
            self._tell(f"the stage that makes the parts ended with exit code {code}")
        return code == 0


async def _said(process: Process) -> deque[str]:
    """Return the last lines of a process after its end; long ones are cut."""
    assert process.stdout is not None
    said, lines, decoder = deque[str](maxlen=LAST), Lines(), codecs.getincrementaldecoder("utf-8")("replace")
    while chunk := await process.stdout.read(CHUNK):
        said.extend(line.rstrip() for line in lines.add(decoder.decode(chunk)))
    rest = lines.rest().rstrip()
    if rest:
        said.append(rest)
    return said


async def _end(process: Process) -> None:
    """Ask the keeper to end it; a stopped keeper is ended with all that is below it."""
    if process.returncode is not None:
        return
    assert process.stdin is not None
    process.stdin.close()
    with suppress(TimeoutError):
        await asyncio.wait_for(_drained(process), PATIENCE)
        return
    end_with_below(process.pid)
    with suppress(TimeoutError):
        await asyncio.wait_for(process.wait(), PATIENCE)


async def _drained(process: Process) -> None:
    """Wait for the end of a process; its further output is dropped."""
    assert process.stdout is not None
    while await process.stdout.read(CHUNK):
        pass
    await process.wait()
