"""Arguments of kernels in a table of machine words, which a caller in another language fills.

Each leaf takes consecutive words of 8 bytes: a number takes one, an array the address of its first element, its shape
and its strides in bytes. Named tuples are their fields one after another.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numba.core import cgutils, types
from numba.extending import intrinsic

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
