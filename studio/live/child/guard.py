"""Ends this process when the server is gone, and when its memory passes a limit."""

from __future__ import annotations

import os
import resource
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

PERIOD = 0.25
"""Seconds between two looks."""
PAGE = resource.getpagesize()


def watch(server: int, most_bytes: int, tell: Callable[[str], None]) -> None:
    """Begin to look at the process ``server`` and at the memory of this one, of which it may take ``most_bytes``."""
    threading.Thread(target=_look, args=(server, most_bytes, tell), daemon=True).start()


def _look(server: int, most_bytes: int, tell: Callable[[str], None]) -> None:
    while True:
        time.sleep(PERIOD)
        try:
            os.kill(server, 0)
        except ProcessLookupError:
            os._exit(0)
        except PermissionError:
            pass
        used = resident()
        if used > most_bytes:
            tell(
                f"mechanism.py has taken {used / 2**30:.1f} GiB of memory, more than the {most_bytes / 2**30:.1f} GiB "
                "that a live page gives it, and was stopped; fewer steps or a shorter motion need less"
            )
            os._exit(1)


def resident() -> int:
    """Bytes of this process that are in memory."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE
    except (OSError, IndexError, ValueError):
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return peak if sys.platform == "darwin" else 1024 * peak
