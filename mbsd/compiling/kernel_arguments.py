"""How kernels hand arrays and named tuples to one another: few words each.

An array goes by its address and shape, and strides only where rows are apart. numba hands over seven words and more for
each: its owner, how many numbers it has, their size and all strides. What is left out follows from an array's type and
shape, and its owner is the caller's concern: kernels keep no array.

A named tuple goes by the address of its fields, which the kernel that made it holds in its frame; nobody changes them.
So a kernel cannot return one. numba hands over all fields, a run's two hundred arrays in every call: most of what it
took to compile a small kernel was to take them apart and put them together again. LLVM knows that what is written to
arrays changes no field.

Functions of numba's own target may call kernels, which then get their arguments in this way. A kernel that hands an
array over to such a function is refused when it is compiled.

:func:`table` is a view of an array's part as a table: numba's own reshape takes 40 ns, this takes none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numba
from numba.core import cgutils, types
from numba.core.cpu import CPUContext
from numba.core.datamodel import ArgPacker, DataModelManager, default_manager
from numba.core.datamodel.models import ArrayModel, DataModel
from numba.core.imputils import user_function
from numba.extending import intrinsic


class _ArrayModel(ArrayModel):
    """numba's array but as an argument."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind)
        plain = isinstance(kind.dtype, types.Integer | types.Float | types.Boolean)
        passed = ("data", "shape") if kind.layout == "C" else ("data", "shape", "strides")
        self._passed = tuple(map(self.get_field_position, passed if plain else self._fields))

    def get_argument_type(self) -> Any:
        """Return types of what is handed over."""
        return tuple(self._models[k].get_argument_type() for k in self._passed)

    def as_argument(self, builder: Any, value: Any) -> Any:
        """Return the address that is handed over."""
        return tuple(self._models[k].as_argument(builder, self.get(builder, value, k)) for k in self._passed)

    def from_argument(self, builder: Any, value: Any) -> Any:
        """Return the array again."""
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


RECORD, ELEMENT = "record", "element"
"""Kinds of memory: fields of named tuples, and elements of arrays."""
WORD = 8
"""Bytes that each part of a field takes."""


def mark(builder: Any, instruction: Any, kind: str) -> None:
    """Mark for LLVM the kind of memory that an instruction uses; writes to one kind change no other."""
    module = builder.module
    root = module.add_metadata(["mbsd"])
    own = module.add_metadata([kind, root, cgutils.int32_t(0)])
    instruction.set_metadata("tbaa", module.add_metadata([own, own, cgutils.int32_t(0)]))


class RecordModel(DataModel):
    """A named tuple: the address of its fields, which nobody changes once they are written.

    They stand in the frame of the kernel that made the tuple. A field is what is handed over of it as an argument; that
    of another named tuple is its address.
    """

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind)
        self._packers = [ArgPacker(manager, (part,)) for part in kind]
        sizes = [len(packer.argument_types) for packer in self._packers]
        self._places = [sum(sizes[:k]) for k in range(len(sizes) + 1)]

    def get_value_type(self) -> Any:
        """Return the type of the address."""
        return cgutils.voidptr_t

    def get_return_type(self) -> Any:
        """Raise TypeError: the frame is gone when a kernel has returned."""
        raise TypeError(f"a kernel returns a {self._fe_type.name}; let it return numbers, or copy it into its caller")

    def make(self, builder: Any, values: Any) -> Any:
        """Write the fields; returns their address."""
        with builder.goto_entry_block():
            room = builder.alloca(cgutils.ir.IntType(64), max(self._places[-1], 1))
        address = builder.bitcast(room, cgutils.voidptr_t)
        for packer, value, first in zip(self._packers, values, self._places, strict=False):
            for k, part in enumerate(packer.as_arguments(builder, (value,)), first):
                mark(builder, builder.store(part, self._place(builder, address, k, part.type), align=WORD), RECORD)
        return address

    def read(self, builder: Any, address: Any, field: int) -> Any:
        """Return a field."""
        packer, parts = self._packers[field], []
        for k, kind in enumerate(packer.argument_types, self._places[field]):
            part = builder.load(self._place(builder, address, k, kind), align=WORD)
            mark(builder, part, RECORD)
            parts.append(part)
        (value,) = packer.from_arguments(builder, parts)
        return value

    @staticmethod
    def _place(builder: Any, address: Any, word: int, kind: Any) -> Any:
        return builder.bitcast(builder.gep(address, [cgutils.int32_t(WORD * word)], inbounds=True), kind.as_pointer())

    def as_argument(self, builder: Any, value: Any) -> Any:
        """Return what is handed over."""
        return value

    def from_argument(self, builder: Any, value: Any) -> Any:
        """Return the named tuple again."""
        return value


_OURS = DataModelManager()
_OURS.register(types.Array, _ArrayModel)
_OURS.register(types.NamedTuple, RecordModel)
_OURS.register(types.NamedUniTuple, RecordModel)
MODELS = _OURS.chain(default_manager)
"""Layout of values in machine code: as numba has it, but for arrays as arguments, and for named tuples."""


def _getattr_of_record(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    return context.data_model_manager[kind].read(builder, value, kind.fields.index(name))


@dataclass(frozen=True, eq=False)
class OnlyLinked:
    """Stands for a kernel that only kernels call, which contain it."""

    name: str

    def __call__(self, *_: Any) -> Any:
        """Raise TypeError."""
        raise TypeError(f"{self.name} is called by kernels alone")


class KernelContext(CPUContext):
    """numba's own target but for arrays as arguments, and for named tuples."""

    def get_getattr(self, typ: Any, attr: str) -> Any:
        """Return what reads an attribute."""
        return _getattr_of_record if isinstance(typ, types.BaseNamedTuple) else super().get_getattr(typ, attr)

    def make_tuple(self, builder: Any, typ: Any, values: Any) -> Any:
        """Return a tuple of the values."""
        if isinstance(typ, types.BaseNamedTuple):
            return self.data_model_manager[typ].make(builder, values)
        return super().make_tuple(builder, typ, values)

    def pack_value(self, builder: Any, ty: Any, value: Any, ptr: Any, align: int | None = None) -> None:
        """Write an element of an array, which is no part of a named tuple."""
        stored = builder.store(self.data_model_manager[ty].as_data(builder, value), ptr, align=align)
        mark(builder, stored, ELEMENT)

    def unpack_value(self, builder: Any, ty: Any, ptr: Any, align: int | None = None) -> Any:
        """Read an element of an array, which is no part of a named tuple."""
        if not isinstance(ty, types.Integer | types.Float | types.Boolean):
            return super().unpack_value(builder, ty, ptr, align)
        loaded = builder.load(ptr, align=align)
        mark(builder, loaded, ELEMENT)
        return self.data_model_manager[ty].from_data(builder, loaded)

    def get_executable(self, library: Any, fndesc: Any, env: Any) -> Any:
        """Return what Python calls; a mere name for kernels that are linked into their callers."""
        if not library.only_linked:
            return super().get_executable(library, fndesc, env)
        library._ensure_finalized()
        return OnlyLinked(fndesc.qualname)

    def insert_user_function(self, func: Any, fndesc: Any, libs: Any = ()) -> None:
        """Make a kernel known, so that whoever calls it hands arrays over as kernels do."""
        call: Any = user_function(fndesc, libs)

        def call_ours(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            if context.data_model_manager is MODELS:
                return call(context, builder, signature, values)
            ours = [self._taken_over(builder, *given) for given in zip(signature.args, values, strict=True)]
            return call(self, builder, signature, ours)

        called: Any = call_ours
        called.signature, called.libs = call.signature, call.libs
        self._defns[func].append(called, called.signature)

    def _taken_over(self, builder: Any, kind: Any, value: Any) -> Any:
        """Return a value of numba's as kernels have it."""
        if not isinstance(kind, types.BaseTuple):
            return value
        fields: Any = kind
        parts = [self._taken_over(builder, part, builder.extract_value(value, k)) for k, part in enumerate(fields)]
        return self.make_tuple(builder, kind, parts)


def refuse_others(caller: Any, called: Any) -> None:
    """Raise TypeError if a kernel's module passes an array to a function of a module without kernels."""
    kinds = {function.name: _kind(function) for function in caller.functions if function.is_declaration}
    for function in called.functions:
        if not function.is_declaration and kinds.get(function.name, _kind(function)) != _kind(function):
            raise TypeError(
                f"a kernel hands an array over to {function.name}, which numba compiled; compile it as a kernel "
                "(mbsd.compiling.jit), or hand over numbers"
            )


def _kind(function: Any) -> str:
    """Return the type of a function in machine code."""
    return str(getattr(function, "global_value_type", function.type))


if not numba.config.DISABLE_JIT:  # pyright: ignore[reportPrivateImportUsage, reportAttributeAccessIssue]

    @intrinsic
    def table(typing, array, start, rows, width):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Return (rows, width) of a contiguous array (n,) from ``start`` on; nothing checks its end."""
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
        """Return (rows, width) of a contiguous array (n,), from ``start`` on."""
        return array[start : start + rows * width].reshape((rows, width))
