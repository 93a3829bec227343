"""The Blender process ends with the one that started it, however that ends."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading

PR_SET_PDEATHSIG = 1
"""Number of the request in Linux's <sys/prctl.h>."""


def die_with_parent() -> None:
    """End when the parent ends, however it does: our standard input closes then, and Linux can tell as well."""
    threading.Thread(target=_end_with_input, daemon=True).start()
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _end_with_input() -> None:
    while os.read(0, 4096):
        pass
    os._exit(1)
