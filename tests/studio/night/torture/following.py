"""A live page that follows saves while its processes are killed and stopped, and what is wrong with what came of it."""

from __future__ import annotations

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import psutil

from shared.stage.paths import ROOT
from shared.stage.signals import end_with_parent
from studio.live.messages import unframed
from studio.live.processes.trees import MARK

SAVES = 6
PATIENCE = 120.0
"""Seconds in which a save is solved, or refused with a sentence, whatever has happened."""
ENDED = 15.0
"""Seconds in which all processes have ended after the server."""
SIGNALS = (signal.SIGKILL, signal.SIGSTOP, signal.SIGTERM, signal.SIGSEGV)
_wrong: list[int] = []
"""Numbers of the rounds that were played and not yet asked for."""


class InFolder(Protocol):
    """A project under attack, of which only its folder counts here."""

    folder: Path


def live_page_hit(project: InFolder, chance: random.Random) -> bool:
    """Save a mechanism again and again while one of the server's processes gets a signal; then end the server."""
    _wrong.append(_play(project.folder / "live", chance))
    return True


def wrong_pages(_: InFolder) -> int:
    """Saves that were not followed, and processes that outlived the server, in the round that was played last."""
    return _wrong.pop() if _wrong else 0


def _play(folder: Path, chance: random.Random) -> int:
    from tests.studio.live.arm import ARM

    shutil.rmtree(folder, ignore_errors=True)
    file = folder / "mechanisms" / "arm" / "mechanism.py"
    file.parent.mkdir(parents=True)
    file.write_text(ARM)
    environment = os.environ | {"MBSD_TEST_PARTS": str(folder / "mechanisms"), "MBSD_OUT": str(folder / "out")}
    command = [sys.executable, "-m", "tests.studio.live.serving", "arm", "--no-parts"]
    with (folder / "said.txt").open("wb") as said:
        server = subprocess.Popen(
            command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
            start_new_session=True, preexec_fn=partial(end_with_parent, signal.SIGTERM),
        )  # fmt: skip
    marks: set[str] = set()
    try:
        address = _address(folder / "said.txt", server)
        wrong = _follow(address, file, server, chance, marks) if address else 1
    finally:
        server.send_signal(chance.choice([signal.SIGKILL, signal.SIGTERM]))
        with suppress(subprocess.TimeoutExpired):
            server.wait(PATIENCE)
        server.kill()
    return wrong + _outlived(marks) + (folder / "said.txt").read_text(errors="replace").count("Traceback")


def _address(said: Path, server: subprocess.Popen[bytes]) -> str | None:
    ends = time.monotonic() + PATIENCE
    while time.monotonic() < ends and server.poll() is None:
        address = re.search(r"http://\S+/", said.read_text(errors="replace"))
        if address:
            return address[0]
        time.sleep(0.1)
    return None


def _follow(address: str, file: Path, server: subprocess.Popen[bytes], chance: random.Random, marks: set[str]) -> int:
    """Saves that were not followed, even after they were saved once more."""
    from websockets.exceptions import WebSocketException
    from websockets.sync.client import connect

    from tests.studio.live.arm import ARM

    wrong = 0
    origin: Any = "/".join(address.split("/")[:3])
    ends = time.monotonic() + PATIENCE
    while True:
        try:
            socket = connect(f"{address.replace('http', 'ws', 1)}socket", origin=origin, max_size=None)
            break
        except OSError:  # the address is printed before it answers
            if time.monotonic() > ends:
                return SAVES
            time.sleep(0.1)
    with socket:
        for k in range(SAVES):
            done = False
            for again in range(3):
                length = round(0.2 + k / 10 + again / 100, 3)
                beside = file.with_suffix(".new")
                beside.write_text(ARM.replace("length: float = 0.2 ", f"length: float = {length} "))
                beside.replace(file)
                time.sleep(chance.choice([0.0, 0.01, 0.1, 0.3]))
                if not again:
                    _hit(server, chance, marks)
                with suppress(TimeoutError, OSError, WebSocketException):
                    done = _is_solved(socket, length)
                if done:
                    break
            wrong += not done
    return wrong


def _is_solved(socket: Any, length: float) -> bool:
    """Return True if this length is solved, False if the page gets an error."""
    ends = time.monotonic() + PATIENCE
    while True:
        header, _ = unframed(socket.recv(timeout=max(ends - time.monotonic(), 0.01)))
        numbers = header.get("numbers") or [{}]
        if header["kind"] == "solved" and numbers[0].get("value") == length:
            return True
        if header["kind"] == "error":
            return False


def _hit(server: subprocess.Popen[bytes], chance: random.Random, marks: set[str]) -> None:
    """Send a signal to one of the processes of the server."""
    hits = []
    with suppress(psutil.Error):
        for process in psutil.Process(server.pid).children(recursive=True):
            with suppress(psutil.Error, OSError):
                mark = process.environ().get(MARK)
                if mark:
                    marks.add(mark)
                    hits.append(process)
    if hits:
        with suppress(psutil.Error):
            chance.choice(hits).send_signal(chance.choice(SIGNALS))


def _outlived(marks: set[str]) -> int:
    """Processes with a mark of a server that has ended; they are killed then."""
    ends = time.monotonic() + ENDED
    while True:
        left = []
        for process in psutil.process_iter():
            with suppress(psutil.Error, OSError):
                if process.status() != psutil.STATUS_ZOMBIE and process.environ().get(MARK) in marks:
                    left.append(process)
        if not left or time.monotonic() > ends:
            break
        time.sleep(0.2)
    for process in left:
        with suppress(psutil.Error):
            process.kill()
    return len(left)
