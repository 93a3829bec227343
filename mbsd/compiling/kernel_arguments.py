"""How kernels hand arrays to one another: by the address and the shape, and strides only where rows are apart.

numba hands over seven words and more for each array: its owner, how many numbers it has, their size and all strides. A
run has some two hundred arrays, and what most kernels do with them takes no longer than to hand over so many words.
What is left out follows from an array's type and shape, and its owner is the caller's concern: kernels keep no array.

Functions of numba's own target may call kernels, which then get their arrays in this way. A kernel that hands an array
over to such a function is refused when it is compiled.
"""

from __future__ import annotations

from typing import Any

from numba.core import cgutils, types
from numba.core.cpu import CPUContext
from numba.core.datamodel import DataModelManager, default_manager
from numba.core.datamodel.models import ArrayModel
from numba.core.imputils import user_function


class _ArrayModel(ArrayModel):
    """numba's array but as an argument."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind)
        plain = isinstance(kind.dtype, types.Integer | types.Float | types.Boolean)
        passed = ("data", "shape") if kind.layout == "C" else ("data", "shape", "strides")
        self._passed = tuple(map(self.get_field_position, passed if plain else self._fields))

    def get_argument_type(self) -> Any:
        """Types of what is handed over."""
        return tuple(self._models[k].get_argument_type() for k in self._passed)

    def as_argument(self, builder: Any, value: Any) -> Any:
        """What is handed over."""
        return tuple(self._models[k].as_argument(builder, self.get(builder, value, k)) for k in self._passed)

    def from_argument(self, builder: Any, value: Any) -> Any:
        """The array again."""
        made = cgutils.ir.Constant(self.get_value_type(), None)
        for k, part in zip(self._passed, value, strict=True):
            made = self.set(builder, made, self._models[k].from_argument(builder, part), k)
        if len(self._passed) == len(self._fields):
            return made
        integer = cgutils.intp_t
        kind = self._fe_type
        size = integer(1 if isinstance(kind.dtype, types.Boolean) else kind.dtype.bitwidth // 8)
        shape = cgutils.unpack_tuple(builder, self.get(builder, made, "shape"), kind.ndim)
        strides, width, count = [], size, integer(1)
        for length in reversed(shape):
            strides.insert(0, width)
            width, count = builder.mul(width, length), builder.mul(count, length)
        made = self.set(builder, made, size, "itemsize")
        made = self.set(builder, made, count, "nitems")
        if kind.layout == "C":
            made = self.set(builder, made, cgutils.pack_array(builder, strides, integer), "strides")
        return made


_OURS = DataModelManager()
_OURS.register(types.Array, _ArrayModel)
MODELS = _OURS.chain(default_manager)
"""How values stand in machine code: as numba has it, but for arrays as arguments."""


class KernelContext(CPUContext):
    """numba's own target but for arrays as arguments."""

    def insert_user_function(self, func: Any, fndesc: Any, libs: Any = ()) -> None:
        """Make a kernel known, so that whoever calls it hands arrays over as kernels do."""
        call: Any = user_function(fndesc, libs)

        def through(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            ours = context.data_model_manager is MODELS
            return call(context if ours else self, builder, signature, values)

        called: Any = through
        called.signature, called.libs = call.signature, call.libs
        self._defns[func].append(called, called.signature)


def refuse_others(caller: Any, called: Any) -> None:
    """Raise TypeError where a kernel's module hands an array over to a function of a module that is no kernel's."""
    kinds = {function.name: _kind(function) for function in caller.functions if function.is_declaration}
    for function in called.functions:
        if not function.is_declaration and kinds.get(function.name, _kind(function)) != _kind(function):
            raise TypeError(
                f"a kernel hands an array over to {function.name}, which numba compiled; compile it as a kernel "
                "(mbsd.compiling.jit), or hand over numbers"
            )


def _kind(function: Any) -> str:
    """The type of a function in machine code."""
    return str(getattr(function, "global_value_type", function.type))
