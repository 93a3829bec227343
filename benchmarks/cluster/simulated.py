"""``python -m benchmarks.cluster.simulated ADDRESS COUNT``: so many workers in one process."""

from __future__ import annotations

import asyncio
import sys

from distributed import Worker


async def main(address: str, count: int) -> None:
    """Run until the process is ended."""
    workers = [Worker(address, nthreads=1, name=f"simulated-{number}", dashboard=False) for number in range(count)]
    await asyncio.gather(*workers)
    await asyncio.gather(*(worker.finished() for worker in workers))


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1], int(sys.argv[2])))
