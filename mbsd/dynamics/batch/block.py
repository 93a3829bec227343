"""Arguments of a compiled loop laid out in one block of numbers, so that those of another simulation are copied there.

All arrays of numbers that a run reads or writes become views of the block. What a run is before its first step is then
a row of numbers: copied into the block it makes another run of the same kind, with nothing left of the one before.
Whole numbers (tables, addresses, counters) stand in arrays of their own: runs that share a block share their tables.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

ALIGNED = 8
"""Arrays begin at multiples of so many numbers: of 64 bytes."""
PADDING = [np.zeros(count) for count in range(ALIGNED)]


@dataclass
class Layout:
    """Where each array of numbers stands in the block, by its address in this process."""

    places: dict[int, int]
    size: int

    def place(self, array: np.ndarray, *index: int) -> int:
        """Place of an entry of an array that is in the block."""
        steps = sum(k * step for k, step in zip(index, array.strides, strict=False))
        return self.places[array.ctypes.data] + steps // array.itemsize


def laid_out(arguments: tuple[Any, ...]) -> tuple[tuple[Any, ...], np.ndarray, Layout]:
    """The same arguments with all their arrays of numbers in one block, the block, and its layout by the new arrays.

    An array that stands at several places of the arguments is one array there, too.
    """
    arrays: dict[int, np.ndarray] = {}
    for leaf in leaves(arguments):
        if _numbers(leaf):
            arrays.setdefault(id(leaf), leaf)
    places, at = {}, 0
    for key, array in arrays.items():
        places[key] = at
        at += -(-array.size // ALIGNED) * ALIGNED
    block = _aligned(at)
    views = {key: _view(block, places[key], array) for key, array in arrays.items()}
    new = {view.ctypes.data: places[key] for key, view in views.items() if view.size}
    copies: dict[int, np.ndarray] = {}

    def put(value: Any) -> Any:
        if isinstance(value, tuple):
            parts = [put(part) for part in value]
            return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        if _numbers(value):
            return views[id(value)]
        if isinstance(value, np.ndarray) and value.flags.writeable:
            return copies.setdefault(id(value), value.copy())
        return value

    return put(arguments), block, Layout(new, at)


def content(arguments: tuple[Any, ...]) -> np.ndarray:
    """The numbers of arguments as a block of :func:`laid_out` would hold them."""
    parts, seen = [], set[int]()
    for leaf in leaves(arguments):
        if _numbers(leaf) and id(leaf) not in seen:
            seen.add(id(leaf))
            parts.append(leaf.ravel())
            parts.append(PADDING[-leaf.size % ALIGNED])
    return np.concatenate(parts)


def kind_of(arguments: tuple[Any, ...]) -> tuple[Any, ...]:
    """All that runs with one layout have in common: shapes, tables of whole numbers, single numbers."""
    out: list[Any] = []
    seen: dict[int, int] = {}
    for leaf in leaves(arguments):
        if not isinstance(leaf, np.ndarray):
            out.append(leaf)
        elif _numbers(leaf):
            out += leaf.shape, leaf.flags.writeable, seen.setdefault(id(leaf), len(seen))
        else:
            out += leaf.shape, leaf.tobytes()
    return tuple(out)


def leaves(value: Any) -> list[Any]:
    """Arrays and single numbers within named tuples, in order."""
    out: list[Any] = []
    for part in value:
        if isinstance(part, tuple):
            out += leaves(part)
        else:
            out.append(part)
    return out


def _numbers(leaf: Any) -> bool:
    return isinstance(leaf, np.ndarray) and leaf.dtype == np.float64


def _aligned(size: int) -> np.ndarray:
    raw = np.zeros(size + ALIGNED)
    first = -(raw.ctypes.data // raw.itemsize) % ALIGNED
    return raw[first : first + size]


def _view(block: np.ndarray, at: int, array: np.ndarray) -> np.ndarray:
    view = block[at : at + array.size].reshape(array.shape)
    view[...] = array
    view.setflags(write=array.flags.writeable)
    return view
