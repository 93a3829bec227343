"""Locks on files that belong to one process. The system releases a lock when its owner ends.

A lock therefore tells what the number of a process cannot: whether the owner still runs, also in a container, after a
restart of the machine, or on another computer that shares the disk.
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path


def try_lock(handle: int) -> bool:
    """Lock an open file for this process, without waiting; False if another process holds it.

    Raises OSError where the disk knows no locks.
    """
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def is_abandoned(path: Path) -> bool:
    """Return True if the process that locked this file has ended; False if that is unknown."""
    try:
        handle = os.open(path, os.O_RDWR | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        return try_lock(handle)
    except OSError:
        return False
    finally:
        os.close(handle)
