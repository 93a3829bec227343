"""The Blender process ends with the one that started it, however that ends."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Iterator


def die_with_parent() -> Iterator[bytes]:
    """End when the parent ends, however it does: our standard input closes then, and Linux can tell as well.

    Returns the lines that come meanwhile; waiting for the next one ends with this process.
    """
    lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_end_with_input, args=(lines,), daemon=True).start()
    return iter(lines.get, None)


def _end_with_input(lines: queue.SimpleQueue[bytes]) -> None:
    rest = b""
    while block := os.read(0, 65536):
        *whole, rest = (rest + block).split(b"\n")
        for line in whole:
            lines.put(line)
    os._exit(1)
