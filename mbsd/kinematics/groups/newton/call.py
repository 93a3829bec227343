"""Calls the compiled solution of a block (block.py) at its machine address: plans without blocks never
compile it.
"""

from __future__ import annotations

from collections.abc import Callable

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mbsd.compiling.jit import COMPILED

POINTER = types.CPointer(types.float64)
INDICES = types.CPointer(types.int64)
ARRAYS = (INDICES, INDICES, INDICES, INDICES, *(POINTER,) * 17)
SIGNATURE = types.int64(types.int64, *ARRAYS)
"""Row k, and the arrays in the order of :func:`solve_block` in block.py."""
PYTHON: list[Callable[..., int]] = []
"""Without the compiler: the function itself."""


if COMPILED:

    @intrinsic
    def call_block(typing, address, k, arrays):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Call the solution at ``address`` for row k with a tuple of contiguous arrays; returns its status."""

        def code(context, builder, signature, arguments):
            where, row, values = arguments
            data = []
            for index, kind in enumerate(signature.args[2]):
                array = context.make_array(kind)(context, builder, builder.extract_value(values, index))
                data.append(array.data)
            integer = cgutils.ir.IntType(64)
            kinds = [integer, *(value.type for value in data)]
            function = cgutils.ir.FunctionType(integer, kinds)
            return builder.call(builder.inttoptr(where, function.as_pointer()), [row, *data])

        return types.int64(types.int64, types.int64, arrays), code

else:

    def call_block(address, k, arrays):
        """Call the solution at ``address`` for row k with a tuple of contiguous arrays; returns its status."""
        return PYTHON[address](k, *arrays)
