"""Work for the tests of the bridge: what a worker is asked to do, as functions of a module that workers find."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from shared.cluster.deal import Work
from shared.stage.errors import UserError

HANGS = 3.0
"""Seconds for which a worker hangs."""


def work(do: Any, most: int = 10_000) -> Work:
    """Return work whose results are taken as they come, a letter a byte."""
    return Work(do, lambda _, content: content.decode("latin-1"), most)


def doubled(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """Return the order's text twice, after the common part."""
    return files[common].read_bytes() + str(order).encode() * 2


def slow(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """Wait for the order's time."""
    time.sleep(order)
    return b"done"


def deadly(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """End the first process that gets the order."""
    marker = Path(order)
    if marker.name == "dies" and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.02)
    return b"done"


def refusing(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """Fail always, or on one worker."""
    from distributed import get_worker

    if order == "always" or order == get_worker().address:
        raise UserError(f"frame of {order}: the disk is full")
    return get_worker().address.encode()


def hanging(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """Hang on the worker whose address is the order."""
    from distributed import get_worker

    if order == get_worker().address:
        time.sleep(HANGS)
    return get_worker().address.encode()
