"""Arguments of kernels as one block of memory: its bytes at the start, and each array's place.

Arrays that share memory share it in the block.
"""

from __future__ import annotations

import ctypes
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.lib.array_utils import byte_bounds

ALIGNED = 64
"""Arrays begin at multiples of so many bytes."""


@dataclass(frozen=True)
class Memory:
    """A block and what is in it."""

    content: bytes
    starts: tuple[int, ...]
    """Addresses in this process of what is in it, in order."""
    offsets: tuple[int, ...]

    def offset(self, array: np.ndarray, *index: int) -> int:
        """Bytes from the start of the block to an array that is in it, or to one of its entries.

        An empty array, which nobody reads, stands at the start.
        """
        if not array.size:
            return 0
        steps = sum(k * step for k, step in zip(index, array.strides, strict=False))
        row = bisect_right(self.starts, array.ctypes.data) - 1
        return self.offsets[row] + array.ctypes.data - self.starts[row] + steps


def memory_of(arrays: Iterable[np.ndarray]) -> Memory:
    """A block that holds all these arrays as they are now, in their order."""
    spans = list(dict.fromkeys(_span(array) for array in arrays if array.size))
    merged = _merged(spans)
    starts = [low for low, _ in merged]
    rows = [bisect_right(starts, low) - 1 for low, _ in spans]
    offsets, size = [0] * len(merged), 0
    for row in dict.fromkeys(rows):  # not by address, which is another in every process
        low, high = merged[row]
        offsets[row] = size
        size += -(-(high - low) // ALIGNED) * ALIGNED
    block = bytearray(size)
    for (low, high), row in zip(spans, rows, strict=True):
        at = offsets[row] + low - starts[row]
        block[at : at + high - low] = ctypes.string_at(low, high - low)
    return Memory(bytes(block), tuple(starts), tuple(offsets))


def _merged(spans: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    """Spans by address, those that overlap as one."""
    out: list[tuple[int, int]] = []
    for low, high in sorted(spans):
        if out and low < out[-1][1]:
            out[-1] = out[-1][0], max(out[-1][1], high)
        else:
            out.append((low, high))
    return out


def _span(array: np.ndarray) -> tuple[int, int]:
    """First address of an array and the one behind it."""
    low, high = byte_bounds(array)
    return int(low), int(high)
