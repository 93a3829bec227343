"""Blender's process from outside: its start, its memory, its end, and the process that is kept for the next job."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import IO

import msgspec

from render.blender.job import Answer, Job, Picture
from render.blender.process import Patience, scratch_folder
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, out_root, refuse_links
from shared.stage.signals import terminable

# Says how a Blender process ended, or why it does not go on.

ENDED = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
"""Signals by which somebody wishes it to end."""


class Silent(Exception):
    """The process gives no sign of life any more; the message is the first half of a sentence."""

    def __init__(self, message: str, remedy: str = "") -> None:
        super().__init__(message)
        self.remedy = remedy
        """Remedy if it happens again."""


def how_it_ended(code: int, doing: str, said: str) -> str:
    """Return the reason for an exit code other than 0, which is the negative number of a signal after a kill or crash.

    What Blender ``said`` last explains an error that it noticed itself, never a kill from outside.
    """
    lines = [line for line in said.strip().splitlines() if line.strip()]
    last = lines[-1].strip() if lines else "it said nothing"
    if code >= 0:
        return f"Blender ended with code {code} ({doing}): {last}"
    name = _signal_name(-code)
    if -code == signal.SIGKILL:
        return f"Blender was killed by {name} ({doing}): by the system if the memory ran out, else by a user"
    if -code in ENDED:
        return f"Blender was ended from outside by {name} ({doing}); the same command goes on from here"
    if -code == signal.SIGABRT:
        return f"Blender gave up by {name} ({doing}): {last}"
    return f"Blender crashed by {name} ({doing})"


def remedy_of(code: int) -> str:
    """Return the remedy if Blender ends with this code again and again."""
    if -code == signal.SIGKILL:
        return "close other programs or take a smaller PRESET"
    return "make check tells the device"


def is_crash(code: int) -> bool:
    """Return True if an exit code tells of a crash, or of a kill that is no wish of a user to end it."""
    return code < 0 and -code not in ENDED


def how_it_stands(process: int) -> str:
    """Return the state of a silent process in words, after a comma; empty if the system reports none."""
    try:
        listing = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, timeout=5)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    state = listing.stdout.strip()[:1]
    if state == "T":
        return f", stopped by a signal: kill -CONT {process} lets it go on"
    if state == "D":
        return ", waits for a disk or a device"
    return ""


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


# Memory of a Blender process: one that grows from picture to picture is replaced before the machine is full.
#
# Measured: 1000 pictures in one process take as much as ten (docs/night.md).

SETTLED = 5
"""Pictures after which a process has all that it needs for any of them."""
GROWTH, SLACK = 1.5, 300e6
"""So many times what it had then, and so many bytes more, are too much."""


class Grown(Exception):
    """A process takes much more memory than it needs; the message is the first half of a sentence."""


class Memory:
    """Memory of one process: what it took when it had settled, and what it takes now."""

    def __init__(self) -> None:
        self.pictures = 0
        self.settled = 0.0
        """Resident bytes, the most after any of the first pictures."""

    def refuse_growth(self, process: int) -> None:
        """Count a picture. Raises Grown if the process takes more than :func:`limit` of what it had settled at."""
        taken = resident(process)
        self.pictures += 1
        if self.pictures <= SETTLED:
            self.settled = max(self.settled, taken)
        elif taken > limit(self.settled):
            raise Grown(
                f"Blender takes {taken / 1e6:.0f} MB of memory after {self.pictures} pictures, "
                f"{self.settled / 1e6:.0f} MB after {SETTLED}"
            )


def limit(settled: float) -> float:
    """Return bytes that a process may take which took ``settled`` bytes after its first pictures."""
    return GROWTH * settled + SLACK


def resident(process: int) -> float:
    """Return bytes of memory that a process takes; 0 where that cannot be asked."""
    import psutil

    with suppress(psutil.Error):
        return float(psutil.Process(process).memory_info().rss)
    return 0.0


# Runs the Blender process and relays its answers. However it ends, no process and no temporary folder remains.

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
        """Yield the answers to a job; restart a process that hangs, once for each picture."""
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
        """Yield the answers of one process; raises Silent, Grown or UserError if it does not make all of the job."""
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
        """Yield the whole lines of its answers; raises Silent when none comes for too long.

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
    """Return the environment in which Blender writes below ``out`` alone, nothing into the home folder."""
    return dict(
        os.environ,
        BLENDER_USER_RESOURCES=str(home / "user"),
        XDG_CACHE_HOME=str(home / "cache"),
        TMPDIR=str(scratch),
        PYTHONPATH=os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")])),
    )


# A Blender process that keeps its scene and makes pictures one after the other, as they are asked for.


class KeptBlender:
    """Starts with the first picture, and again after one that failed; one that grew too large is replaced.

    ``job`` says the scene, its pictures do not count.
    """

    def __init__(self, job: Job) -> None:
        self.job = msgspec.structs.replace(job, pictures=[], waits=True)
        self.device = ""
        self._folder = ""
        self._stack = ExitStack()
        self._child: Child | None = None
        self._answers: Iterator[Answer] = iter(())

    def make(self, state: int, key: str, name: str, plate: int = -1) -> Answer:
        """Render one picture; the answer has its path, which the next picture may remove.

        Raises UserError with the reason if Blender cannot.
        """
        try:
            try:
                return self._ordered(state, key, name, plate)
            except Grown:
                self.stop()
                return self._ordered(state, key, name, plate)
        except (Silent, Grown) as failure:
            self.stop()
            raise UserError(str(failure)) from failure
        except BaseException:
            self.stop()
            raise

    def stop(self) -> None:
        """End the process and remove what it left."""
        if self._child is not None:
            self._child.stop()
            self._child = None
        self._stack.close()

    def _ordered(self, state: int, key: str, name: str, plate: int) -> Answer:
        if self._child is None:
            self._start()
        for path in Path(self._folder).glob("*.png"):
            path.unlink()
        picture = Picture(state=state, folder=self._folder, key=key, name=name, plate=plate)
        assert self._child is not None
        assert self._child.process is not None
        assert self._child.process.stdin is not None
        try:
            self._child.process.stdin.write(msgspec.json.encode(picture) + b"\n")
            self._child.process.stdin.flush()
        except BrokenPipeError:
            pass  # its last answer, or how it ended, tells why
        for answer in self._answers:
            if answer.key == picture.key:
                return answer
        raise UserError(f"Blender ended before {picture.name} was made")

    def _start(self) -> None:
        home = out_root() / ".blender"
        for folder in (home / "user", home / "cache"):
            refuse_links(folder)
        scratch = self._stack.enter_context(scratch_folder(home))
        self._folder = str(scratch.resolve())
        self._child = Child(home, scratch, Patience())
        self._answers = self._child.attempt(msgspec.structs.replace(self.job, plates_folder=self._folder))
        for answer in self._answers:
            if answer.device:
                self.device = answer.device
                return
