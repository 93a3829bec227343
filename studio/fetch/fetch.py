"""Films of another machine and their subtitles, copied into out/films/ if they have changed.

Films arrive in out/.fetch/ and get their names in out/films/ when all are whole. What was brought in part stays there,
also after a kill or a power cut, and the next run brings the rest alone.
"""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from shared.stage import files
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import refusal
from shared.stage.paths import out_root, refuse_links
from studio.fetch.transfer import KINDS, Transfer, program, shell_program, transfer

FOLDER = "mbsd"
"""Folder of the project on the other computer, below the home folder."""
HOST = re.compile(r"(?:[\w.+-]+@)?(?:[A-Za-z0-9_][\w.-]*|\[[0-9A-Fa-f:.]+(?:%\w+)?\])", re.ASCII)
PATH = re.compile(r"[\w./~+=,@-]+")
WAIT = 10.0
"""Seconds to wait for another fetch, which may be about to end."""


def run(host: str, folder: str = "") -> list[str]:
    """Fetch the films and return the names of those that came.

    Raises UserError if ``host`` or ``folder`` is no name, rsync or ssh is missing, the machine cannot be reached or has
    no films, or the connection breaks; what came until then is kept.
    """
    source = source_of(host, folder)
    for word in ("rsync", shell_program()):
        program(word)  # reported before anything is made
    films, arriving = out_root() / "films", out_root() / ".fetch"
    refuse_links(films)
    films.mkdir(parents=True, exist_ok=True)

    def report(name: str, size: int) -> None:
        say("fetch", f"{name}: {size / 1e6:.1f} MB")

    with _locked(arriving) as lock:
        before = _bytes(arriving)
        if before:
            say("fetch", f"{before / 1e6:.1f} MB remain from a stopped run")
        say("fetch", f"{source} to {films}")
        result = transfer(source, arriving, films, lock, report)
        if result.code:
            kept = _bytes(arriving)
            if not kept:
                shutil.rmtree(arriving, ignore_errors=True)
            raise UserError(_reason(result, host, source, kept))
        moved = _moved(arriving, films)
    if moved:
        line = f"{result.received / 1e6:.1f} MB over the line, {result.there / 1e6:.1f} MB of them were here"
        films_and = "films and subtitles" if any(name.endswith(".srt") for name in moved) else "films"
        say("fetch", f"{len(moved)} {films_and} came, {line}")
    else:
        say("fetch", "nothing to do: all films are here")
    return moved


def source_of(host: str, folder: str) -> str:
    """Return the place of the films as rsync takes it.

    Raises UserError for a wrong name of a machine or folder.
    """
    if not HOST.fullmatch(host):
        raise UserError(f"fetch: HOST={host!r} is not user@machine; make fetch HOST=anna@server FOLDER={FOLDER}")
    folder = folder.removeprefix("~/").rstrip("/") or FOLDER
    if not PATH.fullmatch(folder) or "~" in folder[:1]:
        raise UserError(
            f"fetch: FOLDER={folder!r} cannot pass through two shells; use letters, digits, . _ - / "
            "alone, from the home folder or from /"
        )
    return f"{host}:{folder}/out/films"


@contextmanager
def _locked(folder: Path) -> Iterator[int]:
    """Hold the folder for one fetch, including an rsync that outlives it; yield its lock.

    The folder is created if it is missing.
    """
    end = time.monotonic() + WAIT
    handle = -1
    try:
        while True:
            handle = _lock_of(folder)
            if files.try_lock(handle) and os.fstat(handle).st_nlink:
                yield handle
                return
            os.close(handle)
            handle = -1
            if time.monotonic() >= end:
                raise UserError("fetch: another fetch brings films into this folder; wait for it or stop it")
            time.sleep(0.1)
    finally:
        if handle >= 0:
            os.close(handle)


def _lock_of(folder: Path) -> int:
    refuse_links(folder)
    path = folder / ".lock"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    except OSError as error:
        raise UserError(refusal(path, error)) from error


def _moved(arriving: Path, films: Path) -> list[str]:
    """Rename the films that have arrived; each is whole, old or new, at any moment."""
    names = sorted(path.name for path in _files(arriving))
    for name in names:
        os.replace(arriving / name, films / name)
    shutil.rmtree(arriving, ignore_errors=True)
    return names


def _bytes(folder: Path) -> int:
    return sum(path.stat().st_size for path in _files(folder) if path.is_file())


def _files(folder: Path) -> list[Path]:
    return [path for kind in KINDS for path in folder.glob(kind)]


def _reason(result: Transfer, host: str, source: str, kept: int) -> str:
    """Return what rsync's exit code and output mean, and what to do."""
    said = "\n".join(result.said)
    last = next((line for line in result.said if not line.startswith("rsync error")), f"rsync ended with {result.code}")
    if "command not found" in said or result.code in (126, 127):
        return f"fetch: rsync is not installed on {host}: {last}; sudo apt-get install -y rsync there"
    if "No space left" in said or "File too large" in said:
        return f"fetch: {last}; free some disk space or set MBSD_OUT to another folder. {_kept(kept)}"
    if "change_dir" in said and "No such file" in said:
        return f"fetch: {source} does not exist; make fetch HOST={host} FOLDER=<the project's folder on that machine>"
    if not kept and (result.code == 255 or "(0 bytes received so far)" in said):
        return f"fetch: {host} cannot be reached: {last}; try ssh {host}"
    return f"fetch: the transfer ended early: {last}. {_kept(kept)}"


def _kept(count: int) -> str:
    words = f"{count / 1e6:.1f} MB are kept, the" if count else "The"
    return f"{words} same command goes on from here"
