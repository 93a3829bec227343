"""Runs the Blender process and relays its answers. However it ends, no process and no temporary folder remains."""

from __future__ import annotations

import os
import select
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

import msgspec

from render.blender.ending import Silent, how_it_ended, how_it_stands, is_crash, remedy_of
from render.blender.job import Answer, Job
from render.blender.memory import Grown, Memory
from render.blender.patience import Patience
from render.blender.scratch import scratch_folder
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, out_root, refuse_links
from shared.stage.signals import terminable

WORKER = "render.blender.worker.worker"
TICK = 1.0
"""Seconds between two looks at a silent Blender."""
FIRST_WORD = 30.0
"""Seconds of silence after which the user gets a message, if Blender is stopped or a quarter of its time is over; then
after twice as many, and so on."""


@contextmanager
def blender(job: Job, longest: float = 0.0) -> Iterator[Iterator[Answer]]:
    """Start the job in a process of its own; yields its answers as they come.

    A process that hangs, crashes, is killed by the system or grows is started again with what is left of the job;
    ``longest`` is the time that a picture is known to take (s, 0 if unknown). The process is stopped when the block
    ends, also by Ctrl-C or SIGTERM. Raises UserError with the reason if Blender fails, or hangs or crashes twice
    without making a picture in between.
    """
    home = out_root() / ".blender"
    for folder in (home / "user", home / "cache"):
        refuse_links(folder)
    with terminable(), scratch_folder(home) as scratch:
        child = Child(home, scratch, Patience(longest))
        try:
            yield child.answers(job)
        finally:
            child.stop()


class Child:
    """One Blender process after the other, until the job is done."""

    def __init__(self, home: Path, scratch: Path, patience: Patience) -> None:
        self.home, self.scratch, self.patience = home, scratch, patience
        self.process: subprocess.Popen[bytes] | None = None
        self.doing = ""

    def answers(self, job: Job) -> Iterator[Answer]:
        """What the job comes to; starts a process that hangs again, once for each picture."""
        left = {picture.key: picture for picture in job.pictures}
        hung = False
        while True:
            try:
                for answer in self.attempt(job):
                    if answer.key:
                        left.pop(answer.key, None)
                        hung = False
                    yield answer
                return
            except Grown as grown:
                self.stop()
                if not left:
                    return
                say("film", f"{grown}; it is replaced by a new one")
            except Silent as silent:
                self.stop()
                if job.pictures and not left:
                    return  # it hung or crashed on its way out
                if hung:
                    remedy = f"; {silent.remedy}" if silent.remedy else ""
                    raise UserError(
                        f"{silent}, for the second time{remedy}; nothing was lost, the same command goes on"
                    ) from None
                hung = True
                warn("film", f"{silent}; it is started again")
            job = msgspec.structs.replace(job, pictures=list(left.values()))

    def attempt(self, job: Job) -> Iterator[Answer]:
        """The answers of one process; raises Silent, Grown or UserError if it does not make all of the job."""
        paper = self.scratch / "job.json"
        write_bytes(paper, msgspec.json.encode(job))
        self.patience.pictures, self.doing = 0, "starts"
        memory = Memory()
        with tempfile.TemporaryFile(dir=self.scratch) as chat:
            self.process = subprocess.Popen(
                [sys.executable, "-m", WORKER, str(paper)],
                cwd=ROOT,
                env=_environment(self.home, self.scratch),
                stdin=subprocess.PIPE,  # closes with us, which ends the worker even if we are killed
                stdout=subprocess.PIPE,
                stderr=chat,
                start_new_session=True,  # Ctrl-C on the terminal reaches us alone
            )
            for line in self._lines(self.process):
                answer = msgspec.json.decode(line, type=Answer)
                if answer.error:
                    raise UserError(answer.error)
                if answer.doing:
                    self.doing = answer.doing
                    continue
                if answer.key:
                    self.patience.finished(answer.cycles)
                yield answer
                if answer.key:
                    memory.refuse_growth(self.process.pid)
            self._end(self.process, chat)

    def _lines(self, process: subprocess.Popen[bytes]) -> Iterator[bytes]:
        """Whole lines of its answers; raises Silent when none comes for too long.

        Silence is counted in ticks, so that a stop of this process itself (Ctrl-Z, a laptop that sleeps) is none.
        """
        assert process.stdout is not None
        pipe, rest, silence, word = process.stdout.fileno(), b"", 0.0, FIRST_WORD
        while True:
            if select.select([pipe], [], [], TICK)[0]:
                block = os.read(pipe, 65536)
                if not block:
                    return  # what is left of a line was cut by a kill
                *lines, rest = (rest + block).split(b"\n")
                yield from lines
                silence, word = 0.0, FIRST_WORD
                continue
            silence += TICK
            limit = self.patience.limit(self.doing)
            if silence < min(word, limit):
                continue
            standing = how_it_stands(process.pid)
            message = f"Blender has said nothing for {duration(silence)} ({self.doing}{standing})"
            if silence >= limit:
                raise Silent(message)
            if standing or silence >= limit / 4:  # a large picture may well be quiet for that long
                word = 2 * silence
                warn("film", f"{message}; it is started again after {duration(limit)}")

    def _end(self, process: subprocess.Popen[bytes], chat: IO[bytes]) -> None:
        """Wait for its exit code after its last answer."""
        try:
            code = process.wait(timeout=self.patience.limit(self.doing))
        except subprocess.TimeoutExpired:
            raise Silent(f"Blender does not end ({self.doing}{how_it_stands(process.pid)})") from None
        if code:
            chat.seek(0)
            message = how_it_ended(code, self.doing, chat.read().decode(errors="replace"))
            raise Silent(message, remedy_of(code)) if is_crash(code) else UserError(message)

    def stop(self) -> None:
        """Kill the process and wait for its end."""
        if self.process is None:
            return
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe:
                pipe.close()
        self.process = None


def _environment(home: Path, scratch: Path) -> dict[str, str]:
    """Everything Blender writes for itself goes below ``out``, nothing into the home folder."""
    return dict(
        os.environ,
        BLENDER_USER_RESOURCES=str(home / "user"),
        XDG_CACHE_HOME=str(home / "cache"),
        TMPDIR=str(scratch),
        PYTHONPATH=os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")])),
    )
