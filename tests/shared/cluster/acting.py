"""Work for the tests of the bridge: what a worker is asked to do, as functions of a module that workers find."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError


def doubled(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """The order's text twice, after what all have in common."""
    return files[common].read_bytes() + str(order).encode() * 2


def slow(files: Mapping[str, Path], common: str, order: Any) -> tuple[int, int]:
    """Takes the order's time; the number of the process, too."""
    time.sleep(order)
    return os.getpid(), 1


def deadly(files: Mapping[str, Path], common: str, order: Any) -> int:
    """The first process that gets the order ends by it."""
    marker = Path(order)
    if marker.name == "dies" and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.02)
    return os.getpid()


def refusing(files: Mapping[str, Path], common: str, order: Any) -> str:
    """Fails always, or on one worker."""
    from distributed import get_worker

    if order == "always" or order == get_worker().address:
        raise UserError(f"frame of {order}: the disk is full")
    return get_worker().address


def hanging(files: Mapping[str, Path], common: str, order: Any) -> str:
    """Hangs on the worker whose address is the order."""
    from distributed import get_worker

    if order == get_worker().address:
        time.sleep(4.0)
    return get_worker().address
