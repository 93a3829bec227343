"""Arguments of kernels as a table of machine words and a block of memory, for other languages.

Each leaf takes consecutive words of 8 bytes: a number takes one, an array the address of its first element, its shape
and its strides in bytes. Named tuples are their fields one after another. The block has the bytes of all arrays at the
start, and the position of each; arrays that share memory share it in the block.
"""

from __future__ import annotations

import ctypes
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba.core import cgutils, types
from numba.extending import intrinsic
from numpy.lib.array_utils import byte_bounds

WORD = 8
"""Bytes."""


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The arrays and numbers of an argument, each with its path of field names, in the order of the table."""
    if isinstance(value, tuple):
        names = getattr(value, "_fields", range(len(value)))
        for name, part in zip(names, value, strict=True):
            yield from leaves(part, f"{path}.{name}" if path else str(name))
    else:
        yield path, value


def words(value: Any) -> int:
    """How many words a leaf takes."""
    return 1 + 2 * value.ndim if isinstance(value, np.ndarray) else 1


def reader(kind: Any) -> Any:
    """Return the function by which kernels read numba's type ``kind`` from a table (pointer to int64)."""

    @intrinsic
    def read(typing, table):  # pyright: ignore[reportUnusedParameter]
        def code(context, builder, signature, arguments):  # pyright: ignore[reportUnusedParameter]
            return _value(context, builder, arguments[0], kind, [0])

        return kind(table), code

    return read


def _value(context: Any, builder: Any, table: Any, kind: Any, at: list[int]) -> Any:
    """The value from word ``at[0]`` on, which is moved behind it."""
    if isinstance(kind, types.BaseTuple):
        parts = [_value(context, builder, table, part, at) for part in kind.types]
        return context.make_tuple(builder, kind, parts)
    if isinstance(kind, types.Array):
        return _array(context, builder, table, kind, at)
    word = _word(builder, table, at)
    if isinstance(kind, types.Float):
        return builder.bitcast(word, cgutils.ir.DoubleType())
    if isinstance(kind, types.Boolean):
        return context.cast(builder, word, types.int64, types.boolean)
    if isinstance(kind, types.Integer):
        return context.cast(builder, word, types.int64, types.unliteral(kind))
    raise TypeError(f"a table holds no {kind}")


def _word(builder: Any, table: Any, at: list[int]) -> Any:
    place = builder.gep(table, [cgutils.ir.Constant(cgutils.ir.IntType(32), at[0])])
    at[0] += 1
    return builder.load(place)


def _array(context: Any, builder: Any, table: Any, kind: Any, at: list[int]) -> Any:
    view = context.make_array(kind)(context, builder)
    data = builder.inttoptr(_word(builder, table, at), context.get_data_type(kind.dtype).as_pointer())
    shape = [_word(builder, table, at) for _ in range(kind.ndim)]
    strides = [_word(builder, table, at) for _ in range(kind.ndim)]
    integer = context.get_value_type(types.intp)
    size = context.get_abi_sizeof(context.get_data_type(kind.dtype))
    context.populate_array(
        view,
        data=data,
        shape=cgutils.pack_array(builder, shape),
        strides=cgutils.pack_array(builder, strides),
        itemsize=integer(size),
        meminfo=None,
        parent=None,
    )
    return view._getvalue()


def number(value: Any) -> int:
    """The word of a number, or of the address of an array's first element."""
    if isinstance(value, np.ndarray):
        return value.ctypes.data
    if isinstance(value, float | np.floating):
        return int(np.float64(value).view(np.int64))
    assert isinstance(value, int | np.integer | np.bool_)
    return int(value)


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
