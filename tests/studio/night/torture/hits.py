"""Hits of a running project: signals, limits, damages; each function is or returns a :data:`Hit`."""

from __future__ import annotations

import errno
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from studio.night import runs
from tests.studio.night.torture.project import COORDINATOR, Project
from tests.studio.night.torture.stage import MODULE

Hit = Callable[[Project, random.Random], bool]
"""Does it; False if there is nothing to hit yet."""
TARGETS = ("run-all", "overnight")
"""Targets of make: a night in the terminal, and one in the background."""


def signal_to(role: str, what: signal.Signals) -> Hit:
    """A signal to the processes whose arguments have this word; "make" is the outermost make."""

    def hit(project: Project, chance: random.Random) -> bool:
        if role == "make":
            alive = [p for p in project.alive() if p.number == project.runs[0].pid]
        else:
            alive = [p for p in project.alive() if role in p.arguments and "-c" not in p.arguments.split()[:2]]
        if not alive:
            return False
        chance.choice(alive).send(what)
        return True

    return hit


def stop_for_a_while(project: Project, chance: random.Random) -> bool:
    """Stop the stage itself, as Ctrl-Z does, and let it go on."""
    alive = [p for p in project.alive() if f"{MODULE} film" in p.arguments]
    for process in alive:
        process.send(signal.SIGSTOP)
        subprocess.run(["sleep", f"{chance.uniform(0.2, 1.5):.2f}"], check=True)
        process.send(signal.SIGCONT)
    return bool(alive)


TRIES = 50
"""To fill a disk on which others write."""


def full_disk(project: Project, chance: random.Random) -> bool:
    """Fill the disk but for a few kilobytes."""
    left = chance.randrange(0, 60_000)
    for _ in range(TRIES):
        free = shutil.disk_usage(project.disk).free - left
        try:
            with (project.disk / "ballast").open("wb") as ballast:
                os.posix_fallocate(ballast.fileno(), 0, max(free, 1))
        except OSError as error:
            if error.errno != errno.ENOSPC:
                raise
            continue  # somebody wrote meanwhile
        return True
    return False


def room_again(project: Project) -> None:
    """Remove what filled the disk."""
    (project.disk / "ballast").unlink(missing_ok=True)


def read_only(project: Project, chance: random.Random) -> bool:
    """Mount the disk read-only, which works while nobody writes; without a disk of its own, lock the folder."""
    if project.mounted:
        command = ["mount", "-o", "remount,ro", str(project.disk)]
        return not subprocess.run(command, capture_output=True).returncode
    folders = [store.folder for store in project.stores if store.folder.is_dir()]
    for folder in folders:
        folder.chmod(0o500)
    return bool(folders)


def writable(project: Project) -> None:
    """Take that back."""
    if project.mounted:
        subprocess.run(["mount", "-o", "remount,rw", str(project.disk)], check=True)
    for store in project.stores:
        if store.folder.is_dir():
            store.folder.chmod(0o755)


def folder_for_lock(project: Project, chance: random.Random) -> bool:
    """Put a folder where the lock of the frames is."""
    locks = [lock for store in project.stores if (lock := store.folder / ".lock").is_file()]
    if not locks:
        return False
    lock = chance.choice(locks)
    lock.unlink()
    lock.mkdir()
    return True


def second_run(project: Project, chance: random.Random) -> bool:
    """Start the same once more beside the first, in the terminal or in the background."""
    project.start(chance.choice(TARGETS))
    return True


def asked_to_stop(project: Project, chance: random.Random) -> bool:
    """``make stop``, and ``make status`` meanwhile."""
    if not any(COORDINATOR in process.arguments for process in project.alive()):
        return False
    project.start("stop")
    project.start("status")
    return True


def clock_set_back(project: Project, chance: random.Random) -> bool:
    """Everything that is there was written tomorrow, as far as its file tells."""
    paths = [path for path in project.outs[0].folder.parent.rglob("*") if path.is_file()]
    tomorrow = time.time() + chance.uniform(600.0, 1e6)
    for path in paths:
        with suppress(OSError):  # a temporary file
            os.utime(path, (tomorrow, tomorrow))
    return bool(paths)


def limited(role: str, what: str) -> Hit:
    """A limit on a running process (Linux): on the size of files, as a full disk is one, or on its memory."""

    def hit(project: Project, chance: random.Random) -> bool:
        alive = [process for process in project.alive() if role in process.arguments]
        for process in alive:
            with suppress(OSError):
                if what == "files":
                    most = chance.randrange(0, 6000)
                    resource.prlimit(process.number, resource.RLIMIT_FSIZE, (most, most))
                else:
                    pages = int(Path(f"/proc/{process.number}/statm").read_text().split()[0])
                    most = pages * resource.getpagesize() + chance.randrange(0, 8_000_000)
                    resource.prlimit(process.number, resource.RLIMIT_AS, (most, most))
        return bool(alive)

    return hit


def damaged(pick: Callable[[Project], list[Path]], how: Callable[[bytes, random.Random], bytes | None]) -> Hit:
    """Change one of the files that ``pick`` finds; ``how`` gives its new bytes, None removes it."""

    def hit(project: Project, chance: random.Random) -> bool:
        targets = sorted(pick(project))
        if not targets:
            return False
        path = chance.choice(targets)
        try:
            content = path.read_bytes()
            new = how(content, chance)
            if new is None:
                path.unlink()
            else:
                path.write_bytes(new)
        except FileNotFoundError:
            return False
        return True

    return hit


def pictures(project: Project) -> list[Path]:
    """Return the existing pictures."""
    return project.pictures()


def swapped(project: Project, chance: random.Random) -> bool:
    """Exchange the content of two pictures; both are whole."""
    targets = sorted(pictures(project))
    if len(targets) < 2:
        return False
    first, second = chance.sample(targets, 2)
    ours, other = first.read_bytes(), second.read_bytes()
    first.write_bytes(other)
    second.write_bytes(ours)
    return True


def records(project: Project) -> list[Path]:
    """Return stamps, timing and index of the frames."""
    stamps = [path for out in project.outs for path in out.stamps.glob("[!.]*.json")]
    nights = list(runs.folder().glob("run-*.json"))
    kept = [path for store in project.stores for path in (store.timing, store.index) if path.is_file()]
    return [*stamps, *nights, *kept]


def results(project: Project) -> list[Path]:
    """Return motion, parts and shot."""
    files = [path for out in project.outs for path in out.folder.rglob("[!.]*")]
    return [path for path in files if path.suffix in (".json", ".stl") and path.is_file()]


def film(project: Project) -> list[Path]:
    """Return the finished films."""
    return [path for path in project.films if path.is_file()]
