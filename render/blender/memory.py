"""Whether a Blender process grows from picture to picture; one that does is replaced before the machine is full.

Measured: 1000 pictures in one process take as much as ten (docs/night.md).
"""

from __future__ import annotations

from contextlib import suppress

SETTLED = 5
"""Pictures after which a process has all that it needs for any of them."""
GROWTH, SLACK = 1.5, 300e6
"""So many times what it had then, and so many bytes more, are too much."""


class Grown(Exception):
    """A process takes much more memory than it needs; the message is the first half of a sentence."""


class Memory:
    """Memory of one process: what it took when it had settled, and what it takes now."""

    def __init__(self) -> None:
        self.pictures = 0
        self.settled = 0.0
        """Resident bytes, the most after any of the first pictures."""

    def refuse_growth(self, process: int) -> None:
        """Count a picture. Raises Grown if the process takes more than :func:`limit` of what it had settled at."""
        taken = resident(process)
        self.pictures += 1
        if self.pictures <= SETTLED:
            self.settled = max(self.settled, taken)
        elif taken > limit(self.settled):
            raise Grown(
                f"Blender takes {taken / 1e6:.0f} MB of memory after {self.pictures} pictures, "
                f"{self.settled / 1e6:.0f} MB after {SETTLED}"
            )


def limit(settled: float) -> float:
    """Bytes that a process may take which took ``settled`` bytes after its first pictures."""
    return GROWTH * settled + SLACK


def resident(process: int) -> float:
    """Bytes of memory that a process takes; 0 where that cannot be asked."""
    import psutil

    with suppress(psutil.Error):
        return float(psutil.Process(process).memory_info().rss)
    return 0.0
