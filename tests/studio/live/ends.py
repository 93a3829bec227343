"""Processes that a warm process of these tests forks: they answer, and end as their names say."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

from studio.live.messages import framed, unframed
from studio.live.processes.pipe import Pipe

FORKS = "import os, time\nif os.fork() == 0:\n    os.setsid()\nos.write(1, b'%d\\n' % os.getpid())\ntime.sleep(600)\n"


def serve(pipe: Pipe, name: str) -> None:
    """Answer each request; ``name`` says how it ends."""
    while True:
        request, _ = unframed(pipe.receive())
        if name == "dies":
            os._exit(3)
        if name == "closes":
            pipe.close()
            threading.Event().wait()
        if name == "leaves another" and os.fork() == 0:
            threading.Event().wait(600)
        if name == "begins others":
            begin_others(Path(request["file"]))
        if name == "holds the lock of Python":
            ctypes.PyDLL(None).sleep(600)
        if name == "takes memory":
            taken = bytearray(1 << 30)
            time.sleep(600)
            del taken
        pipe.send(framed({"kind": "motion", "id": request["id"]}))


def begin_others(file: Path) -> None:
    """Begin a process in a session of its own that begins another such, and write their numbers into a file."""
    first = subprocess.Popen(
        [sys.executable, "-c", FORKS], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, start_new_session=True
    )
    assert first.stdout is not None
    numbers = [first.stdout.readline().decode().strip() for _ in range(2)]
    file.write_text(" ".join(numbers))
