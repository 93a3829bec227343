"""One run of rsync: its arguments, its output, and its end with this process."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.signals import end_with_parent, terminable
from shared.system import missing

SSH = "ssh -o ConnectTimeout=20 -o ServerAliveInterval=20 -o ServerAliveCountMax=6"
"""A machine that is gone is given up after two minutes. $RSYNC_RSH, if set, takes its place."""
KINDS = ("*.mp4", "*.srt")
"""Patterns of the files that are fetched."""
FILE = re.compile(r"^file (\d+) (\d+) (.*)$")


@dataclass
class Transfer:
    """Outcome of a run of rsync."""

    code: int
    """rsync's exit code; 0 is success."""
    said: list[str]
    """Its errors, and those of ssh."""
    received: int = 0
    """Bytes of files that came over the line."""
    there: int = 0
    """Bytes of them that were here already."""


def transfer(source: str, target: Path, beside: Path, lock: int, report: Callable[[str, int], None]) -> Transfer:
    """Copy the films of ``source`` and their subtitles into ``target``.

    Films that ``beside`` has with the same bytes are left out.

    A file that is in ``target`` in part gets the rest alone. ``report`` is called with the name and the size of each
    file that is done. rsync keeps the open file ``lock``, so that a lock on it is held until it has ended itself.
    """
    command = [program("rsync"), "-r", "--checksum", "--inplace", "--no-whole-file", "--stats"]
    command += ["--out-format=file %b %l %n", f"--compare-dest={beside.resolve()}", f"--rsh={remote_shell()}"]
    command += [
        "--exclude=.*",
        *(f"--include={kind}" for kind in KINDS),
        "--exclude=*",
        "--",
        f"{source}/",
        f"{target.resolve()}/",
    ]
    environment = {key: value for key, value in os.environ.items() if not key.startswith("RSYNC_")} | {"LC_ALL": "C"}
    with terminable():
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env=environment,
            pass_fds=[lock],
            preexec_fn=partial(end_with_parent, signal.SIGTERM),
        )
        try:
            return _listened(process, report)
        finally:
            with suppress(ProcessLookupError):
                process.terminate()  # rsync keeps what it has
            process.wait()


def _listened(process: subprocess.Popen[str], report: Callable[[str, int], None]) -> Transfer:
    assert process.stdout is not None
    transfer = Transfer(code=0, said=[])
    for line in process.stdout:
        words = line.strip()
        if done := FILE.match(words):
            if not done[3].endswith("/"):
                report(done[3], int(done[2]))
        elif number := re.match(r"(Literal|Matched) data: ([\d,.]+)", words):
            count = int(re.sub(r"\D", "", number[2]))
            if number[1] == "Literal":
                transfer.received = count
            else:
                transfer.there = count
        elif words and not re.match(r"(Number of|Total|File list|sent |total size)", words):
            transfer.said.append(words)
    transfer.code = process.wait()
    return transfer


def remote_shell() -> str:
    """Return the command by which rsync reaches the other machine."""
    return os.environ.get("RSYNC_RSH") or SSH


def shell_program() -> str:
    """Return the path of the program of the remote shell."""
    return shlex.split(remote_shell())[0]


def program(name: str) -> str:
    """Return the program's path; raises UserError with the command that installs it."""
    path = missing.program(name)
    if path is None:
        command = missing.remedy([name])
        raise UserError(f"fetch: {name} is not installed here" + (f"; {command}" if command else ""))
    return path
