"""A scheduler and three workers for the rounds on a cluster, with results of their own, and what hits one of them."""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Protocol

import psutil

from shared.cluster.__main__ import worker_command
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from shared.stage.signals import end_with_parent

COUNT = 3
BEGIN = 90.0
"""Seconds in which the scheduler answers, and all workers are there."""
BLENDER = "render.blender.worker.worker"
SMALL = 60
"""Megabytes of the disk in memory that one worker keeps everything on."""


class Workers:
    """The cluster, which ends with this process; its folder is not that of the project, so that its processes are
    nobody's orphans.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.small = folder / "w0"
        self.small.mkdir(parents=True)
        mount = ["mount", "-t", "tmpfs", "-o", f"size={SMALL}m", "none", str(self.small)]
        self.mounted = shutil.which("mount") is not None and not subprocess.run(mount, capture_output=True).returncode
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.nannies: list[subprocess.Popen[bytes]] = []
        self.hostile: subprocess.Popen[bytes] | None = None
        self.scheduler = self._start("scheduler", "--port", str(self.port))
        try:
            self._wait_for_scheduler()
            self._start_workers()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """End all of it."""
        self.expel()
        _kill_all(*self.nannies, self.scheduler)
        if self.mounted:
            subprocess.run(["umount", "-l", str(self.small)], check=False)
            self.mounted = False

    def restart(self) -> None:
        """Have a scheduler again where the old one was; its workers come back by themselves."""
        _kill_all(self.scheduler)
        self.scheduler = self._start("scheduler", "--port", str(self.port))
        self._wait_for_scheduler()
        self._wait_for_workers()

    def heal(self) -> None:
        """Room on the disk, and no process that is stopped or has a limit: those get a successor by their nanny."""
        (self.small / "ballast").unlink(missing_ok=True)
        for process in self._below(lambda _: True):
            with suppress(psutil.Error, OSError):
                stopped = process.status() == psutil.STATUS_STOPPED
                limits = [
                    resource.prlimit(process.pid, kind)[1] for kind in (resource.RLIMIT_FSIZE, resource.RLIMIT_AS)
                ]
                if stopped or any(limit != resource.RLIM_INFINITY for limit in limits):
                    process.kill()
        self._wait_for_workers()

    def admit(self, kind: str) -> None:
        """A fourth worker that answers with this kind of rubbish."""
        folder = self.folder / "hostile"  # it is no process of the project
        command = [
            *worker_command(self.address, "127.0.0.1", "hostile", folder),
            "--preload",
            "tests.studio.night.torture.hostile",
        ]
        self.hostile = self._called(command, "hostile", HOSTILE=kind)
        self._wait_for_workers(1)

    def expel(self) -> None:
        """End it."""
        if self.hostile is not None:
            _kill_all(self.hostile)
            self.hostile = None

    def workers(self) -> list[psutil.Process]:
        """The processes that do the work, each below its nanny."""
        return self._below(lambda words: "spawn_main" in words)

    def blenders(self) -> list[psutil.Process]:
        """Blender of each worker that has one."""
        return self._below(lambda words: BLENDER in words)

    def _below(self, fits: Callable[[str], bool]) -> list[psutil.Process]:
        below = []
        for nanny in self.nannies:
            with suppress(psutil.Error):
                for process in psutil.Process(nanny.pid).children(recursive=True):
                    with suppress(psutil.Error):
                        if fits(" ".join(process.cmdline())):
                            below.append(process)
        return below

    def _start(self, *words: str, out: str = "scheduler") -> subprocess.Popen[bytes]:
        return self._called([sys.executable, "-m", "shared.cluster", *words], out)

    def _called(self, command: list[str], out: str, **more: str) -> subprocess.Popen[bytes]:
        environment = os.environ | {"MBSD_OUT": str(self.folder / out), "PYTHONPATH": str(ROOT), "MBSD_PATIENCE": "12"}
        with (self.folder / "said.txt").open("ab") as said:
            return subprocess.Popen(
                command, cwd=ROOT, env=environment | more,
                stdin=subprocess.DEVNULL, stdout=said, stderr=said, start_new_session=True,
                preexec_fn=partial(end_with_parent, signal.SIGTERM),
            )  # fmt: skip

    def _start_workers(self) -> None:
        self.nannies = [self._start("worker", self.address, "--name", f"w{n}", out=f"w{n}") for n in range(COUNT)]
        self._wait_for_workers()

    def _wait_for_scheduler(self) -> None:
        def answers() -> bool:
            with suppress(OSError):
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return True
            return False

        self._wait(answers, "no scheduler")

    def _wait_for_workers(self, more: int = 0) -> None:
        from mbsd.dealing.connection import workers_of
        from shared.cluster.address import connected

        count = COUNT + more
        with connected(self.address) as client:
            self._wait(lambda: len(workers_of(client)) >= count, "not all workers")

    def _wait(self, ready: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + BEGIN
        while not ready():
            if time.monotonic() > end:
                raise UserError(
                    f"torture: {what} after {BEGIN:.0f} s: {(self.folder / 'said.txt').read_text()[-2000:]}"
                )
            time.sleep(0.2)


class Clustered(Protocol):
    """Project under attack that may have a cluster."""

    @property
    def workers(self) -> Workers | None:
        """The cluster, in rounds that have one."""
        ...


def _kill_all(*processes: subprocess.Popen[bytes]) -> None:
    """Kill them with all that they have started."""
    for process in processes:
        with suppress(psutil.Error):
            for child in psutil.Process(process.pid).children(recursive=True):
                with suppress(psutil.Error):
                    child.kill()
        process.kill()
        process.wait()


def signal_to_one(pick: Callable[[Workers], list[psutil.Process]], what: signal.Signals) -> Callable[..., bool]:
    """A signal to one of the processes."""

    def hit(project: Clustered, chance: random.Random) -> bool:
        workers = pick(project.workers) if project.workers else []
        if not workers:
            return False
        with suppress(psutil.Error):
            chance.choice(workers).send_signal(what)
        return True

    return hit


def limit_one(pick: Callable[[Workers], list[psutil.Process]], what: str) -> Callable[..., bool]:
    """A limit on one of them: on the size of its files, as a full disk is one, or on its memory."""

    def hit(project: Clustered, chance: random.Random) -> bool:
        workers = pick(project.workers) if project.workers else []
        if not workers:
            return False
        process = chance.choice(workers)
        with suppress(psutil.Error, OSError):
            if what == "files":
                most, kind = chance.randrange(0, 6000), resource.RLIMIT_FSIZE
            else:
                most, kind = process.memory_info().vms + chance.randrange(0, 8_000_000), resource.RLIMIT_AS
            resource.prlimit(process.pid, kind, (most, most))
        return True

    return hit


def disk_of_one(project: Clustered, chance: random.Random) -> bool:
    """Fill the small disk of one worker but for a few kilobytes."""
    if project.workers is None or not project.workers.mounted:
        return False
    free = shutil.disk_usage(project.workers.small).free - chance.randrange(0, 60_000)
    with (project.workers.small / "ballast").open("wb") as ballast:
        os.posix_fallocate(ballast.fileno(), 0, max(free, 1))
    return True


def admitted(kind: str) -> Callable[[Clustered], None]:
    """Before the run, a worker that lies in this way."""

    def admit(project: Clustered) -> None:
        assert project.workers is not None
        project.workers.admit(kind)

    return admit


def is_there(project: Clustered, chance: random.Random) -> bool:
    """Nothing more is done to the run than that there is such a worker."""
    return project.workers is not None and project.workers.hostile is not None


def expelled(project: Clustered) -> None:
    """Remove a worker with wrong answers, as a user does."""
    assert project.workers is not None
    project.workers.expel()


def no_scheduler(project: Clustered, chance: random.Random) -> bool:
    """Kill the scheduler."""
    if project.workers is None:
        return False
    project.workers.scheduler.kill()
    return True


def healed(project: Clustered) -> None:
    """Heal a worker as a user does."""
    assert project.workers is not None
    project.workers.heal()


def scheduler_again(project: Clustered) -> None:
    """Start the scheduler again as a user does."""
    assert project.workers is not None
    project.workers.restart()
