"""Tasks in the place of frames."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

PICTURE = bytes(20_000)
"""As large as a picture of a postage stamp."""


def nothing(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """A picture at once."""
    return PICTURE


def waiting(files: Mapping[str, Path], common: str, order: float) -> bytes:
    """So many seconds that take no core."""
    time.sleep(order)
    return b"done"


def burning(files: Mapping[str, Path], common: str, order: float) -> bytes:
    """So many seconds of processor time."""
    end = time.thread_time() + order
    while time.thread_time() < end:
        sum(range(2000))
    return b"done"
