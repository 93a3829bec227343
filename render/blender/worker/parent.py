"""The Blender process ends with the one that started it, however that ends."""

from __future__ import annotations

import ctypes
import os
import queue
import signal
import sys
import threading
from collections.abc import Iterator

PR_SET_PDEATHSIG = 1
"""Number of the request in Linux's <sys/prctl.h>."""


def die_with_parent() -> Iterator[bytes]:
    """End when the parent ends, however it does: our standard input closes then, and Linux can tell as well.

    Returns the lines that come meanwhile; waiting for the next one ends with this process.
    """
    lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_end_with_input, args=(lines,), daemon=True).start()
    return iter(lines.get, None)


def die_with_its_thread() -> None:
    """End at once when the thread of the parent that started us ends, which Linux tells."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _end_with_input(lines: queue.SimpleQueue[bytes]) -> None:
    rest = b""
    while block := os.read(0, 65536):
        *whole, rest = (rest + block).split(b"\n")
        for line in whole:
            lines.put(line)
    os._exit(1)
