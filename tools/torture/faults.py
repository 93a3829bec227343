"""What may go wrong: each fault hits a running project once, and may have to be undone before the next run."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tools.torture.project import Project

Hit = Callable[[Project, random.Random], bool]
"""Does it; False if there is nothing to hit yet."""


@dataclass(frozen=True)
class Fault:
    """One kind of fault."""

    name: str
    hit: Hit
    undo: Callable[[Project], object] | None = None
    """What a user does about it before the next run."""
    hits_film: bool = False
    """Whether the film itself may be what it damages."""
    during: str = ""
    """A word in the arguments of the process during which it hits; anywhere in the run if empty."""


def signal_to(role: str, what: signal.Signals) -> Hit:
    """A signal to the processes whose arguments have this word; "make" is the outermost make."""

    def hit(project: Project, chance: random.Random) -> bool:
        if role == "make":
            found = [p for p in project.alive() if p.number == project.runs[0].pid]
        else:
            found = [p for p in project.alive() if role in p.arguments and "-c" not in p.arguments.split()[:2]]
        if not found:
            return False
        chance.choice(found).send(what)
        return True

    return hit


def stop_for_a_while(project: Project, chance: random.Random) -> bool:
    """Stop the stage itself, as Ctrl-Z does, and let it go on."""
    found = [p for p in project.alive() if FILM in p.arguments]
    for process in found:
        process.send(signal.SIGSTOP)
        subprocess.run(["sleep", f"{chance.uniform(0.2, 1.5):.2f}"], check=True)
        process.send(signal.SIGCONT)
    return bool(found)


def full_disk(project: Project, chance: random.Random) -> bool:
    """Fill the disk but for a few kilobytes."""
    free = shutil.disk_usage(project.disk).free - chance.randrange(0, 60_000)
    with (project.disk / "ballast").open("wb") as ballast:
        os.posix_fallocate(ballast.fileno(), 0, max(free, 1))
    return True


def room_again(project: Project) -> None:
    """Remove what filled the disk."""
    (project.disk / "ballast").unlink(missing_ok=True)


def read_only(project: Project, chance: random.Random) -> bool:
    """Mount the disk read-only, which works while nobody writes; without a disk of its own, lock the folder."""
    if project.mounted:
        command = ["mount", "-o", "remount,ro", str(project.disk)]
        return not subprocess.run(command, capture_output=True).returncode
    folder = project.store.folder
    if folder.is_dir():
        folder.chmod(0o500)
    return folder.is_dir()


def writable(project: Project) -> None:
    """Take that back."""
    if project.mounted:
        subprocess.run(["mount", "-o", "remount,rw", str(project.disk)], check=True)
    elif project.store.folder.is_dir():
        project.store.folder.chmod(0o755)


def folder_for_lock(project: Project, chance: random.Random) -> bool:
    """Put a folder where the lock of the frames is."""
    lock = project.store.folder / ".lock"
    if not lock.is_file():
        return False
    lock.unlink()
    lock.mkdir()
    return True


def second_run(project: Project, chance: random.Random) -> bool:
    """Start the same command once more beside the first."""
    project.start()
    return True


def damaged(pick: Callable[[Project], list[Path]], how: Callable[[bytes, random.Random], bytes | None]) -> Hit:
    """Change one of the files that ``pick`` finds; ``how`` gives its new bytes, None removes it."""

    def hit(project: Project, chance: random.Random) -> bool:
        found = sorted(pick(project))
        if not found:
            return False
        path = chance.choice(found)
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
    """The pictures that are there."""
    return list(project.store.folder.glob("[!.]*.png"))


def swapped(project: Project, chance: random.Random) -> bool:
    """Exchange the content of two pictures; both are whole."""
    found = sorted(pictures(project))
    if len(found) < 2:
        return False
    first, second = chance.sample(found, 2)
    one, other = first.read_bytes(), second.read_bytes()
    first.write_bytes(other)
    second.write_bytes(one)
    return True


def records(project: Project) -> list[Path]:
    """Stamps, timing and index of the frames."""
    stamps = project.out.stamps.glob("[!.]*.json")
    return [*stamps, *(path for path in (project.store.timing, project.store.index) if path.is_file())]


def results(project: Project) -> list[Path]:
    """Motion, parts and shot."""
    return [path for path in project.out.folder.rglob("[!.]*") if path.suffix in (".json", ".stl") and path.is_file()]


def film(project: Project) -> list[Path]:
    """The finished film."""
    return [project.film] if project.film.is_file() else []


def cut(content: bytes, chance: random.Random) -> bytes:
    """Cut it anywhere; often just before its end."""
    return content[: chance.choice([0, len(content) - 1, len(content) - 12, chance.randrange(len(content) + 1)])]


def flipped(content: bytes, chance: random.Random) -> bytes:
    """Flip some bits of one byte."""
    place = chance.randrange(max(len(content), 1))
    return (
        content[:place]
        + bytes(byte ^ chance.randrange(1, 256) for byte in content[place : place + 1])
        + content[place + 1 :]
    )


def no_text(content: bytes, chance: random.Random) -> bytes:
    """Put a byte above 0x7f somewhere."""
    place = chance.randrange(max(len(content), 1))
    return content[:place] + bytes([chance.randrange(0x80, 0x100)]) + content[place + 1 :]


def gone(content: bytes, chance: random.Random) -> None:
    """Remove it."""


STAGE, FILM, BLENDER = "tools.torture.stage", "tools.torture.stage film", "render.blender.worker.worker"
NIGHT, MAKE = "studio.night run", "make -o install run-all"
TERM, INT, HUP, KILL = signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL
STOP, SEGV = signal.SIGSTOP, signal.SIGSEGV
MAKE_TELLS = [INT, HUP] if sys.platform == "linux" else []
"""Signals that make keeps to itself; only Linux shows that it got them."""
FAULTS = [
    *(Fault(f"{what.name} to make", signal_to("make", what), during=FILM) for what in (TERM, KILL, *MAKE_TELLS)),
    *(Fault(f"{what.name} to the coordinator", signal_to(NIGHT, what)) for what in (TERM, INT, HUP, KILL)),
    *(Fault(f"{what.name} to a stage", signal_to(STAGE, what), during=STAGE) for what in (TERM, INT, KILL)),
    *(Fault(f"{what.name} to Blender", signal_to(BLENDER, what), during=BLENDER) for what in (TERM, KILL, SEGV)),
    Fault("Blender stopped", signal_to(BLENDER, STOP), during=BLENDER),
    Fault("a stage stopped for a while", stop_for_a_while, during=FILM),
    Fault("SIGKILL to ffmpeg", signal_to("ffmpeg", KILL), during="ffmpeg"),
    Fault("a read-only disk", read_only, undo=writable, during=MAKE),
    Fault("a folder in place of a lock", folder_for_lock),
    Fault("two runs at once", second_run),
    Fault("a picture cut", damaged(pictures, cut)),
    Fault("a picture with a flipped byte", damaged(pictures, flipped)),
    Fault("a picture deleted", damaged(pictures, gone)),
    Fault("two pictures swapped", swapped),
    Fault("no text in a stamp, timing.json or frames.json", damaged(records, no_text)),
    Fault("a stamp, timing.json or frames.json cut", damaged(records, cut)),
    Fault("no text in data.json, parts.json or a solid", damaged(results, no_text)),
    Fault("a result or stamp with a flipped byte", damaged(results, flipped)),
    Fault("the film cut", damaged(film, cut), hits_film=True),
    Fault("the film with a flipped byte", damaged(film, flipped), hits_film=True),
]
FULL = [
    *[Fault("a full disk", full_disk, undo=room_again)] * 2,
    *[Fault("a disk that gets full under Blender", full_disk, undo=room_again, during=BLENDER)] * 3,
]
"""Only where a small disk could be mounted; more likely than each of the others."""
