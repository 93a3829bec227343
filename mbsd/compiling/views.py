"""Tables within one array, as kernels see them: numba's own reshape takes 40 ns, this takes none."""

from __future__ import annotations

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mbsd.compiling.jit import COMPILED

if COMPILED:

    @intrinsic
    def table(typing, array, start, rows, width):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """(rows, width) of a contiguous array (n,), from ``start`` on; nothing checks that it ends within."""
        made = types.Array(array.dtype, 2, "C")

        def code(context, builder, signature, arguments):
            source = context.make_array(signature.args[0])(context, builder, arguments[0])
            integer = context.get_value_type(types.intp)
            start, rows, width = (
                context.cast(builder, value, kind, types.intp)
                for value, kind in zip(arguments[1:], signature.args[1:], strict=True)
            )
            size = integer(context.get_abi_sizeof(context.get_data_type(array.dtype)))
            view = context.make_array(made)(context, builder)
            context.populate_array(
                view,
                data=builder.gep(source.data, [start]),
                shape=cgutils.pack_array(builder, [rows, width]),
                strides=cgutils.pack_array(builder, [builder.mul(width, size), size]),
                itemsize=size,
                meminfo=None,
                parent=None,
            )
            return view._getvalue()

        return made(array, start, rows, width), code

else:

    def table(array, start, rows, width):
        """(rows, width) of a contiguous array (n,), from ``start`` on."""
        return array[start : start + rows * width].reshape((rows, width))
