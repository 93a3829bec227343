"""Tasks in the place of frames; ``python -m benchmarks.cluster.work ADDRESS COUNT`` runs workers in one process."""

from __future__ import annotations

import asyncio
import sys
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


async def main(address: str, count: int) -> None:
    """Run workers until the process is ended."""
    from distributed import Worker

    workers = [Worker(address, nthreads=1, name=f"simulated-{number}", dashboard=False) for number in range(count)]
    await asyncio.gather(*workers)
    await asyncio.gather(*(worker.finished() for worker in workers))


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1], int(sys.argv[2])))
