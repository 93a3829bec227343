"""Kernels that are compiled when they are first called: nobody waits for what his run does not use.

Whoever calls one finds its address in a cell of memory. While that is null, he asks for the kernel, which is then
compiled, or read from the cache, in the midst of his run. Cells are named in machine code, alike in every process, and
made before the caller's code is loaded (kernel_cache.py).
"""

from __future__ import annotations

import ctypes
import hashlib
import inspect
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import llvmlite.binding as llvm
from numba.core import cgutils, types
from numba.extending import intrinsic

from mbsd.base.running import CALLED

LOG = logging.getLogger("mbsd")
COMPILE = "mbsd.compile"
"""Name, in machine code, of what fills a cell."""
READY, STOPPED, FAILED = 0, 1, 2
"""Codes that it returns."""


@dataclass
class Cell:
    """Where a kernel stands, for one signature."""

    name: str
    """In machine code."""
    dispatcher: Any
    arguments: tuple[Any, ...]
    """numba's types."""
    returns: Any
    pointer: ctypes.c_void_p = field(default_factory=ctypes.c_void_p)

    def fill(self) -> None:
        """Compile the kernel, or read it, unless it is there."""
        if self.pointer.value:
            return
        self.dispatcher.compile(self.arguments)
        made = self.dispatcher.overloads[self.arguments]
        if types.unliteral(made.signature.return_type) != self.returns:
            raise TypeError(f"{self.dispatcher.py_func.__qualname__} returns {made.signature.return_type}")
        self.pointer.value = made.library.get_pointer_to_function(made.fndesc.llvm_func_name)


_CELLS: dict[str, Cell] = {}
_BY_PLACE: dict[int, Cell] = {}


def cell_of(dispatcher: Any, arguments: Sequence[Any], returns: Any) -> Cell:
    """Return the cell of a kernel for one signature; code that names it can be loaded from now on."""
    function = dispatcher.py_func
    what = f"{function.__module__}.{function.__qualname__}:{function.__code__.co_firstlineno}{tuple(arguments)}"
    name = f"mbsd.cell.{hashlib.sha256(what.encode()).hexdigest()[:20]}"
    if name not in _CELLS:
        cell = Cell(name, dispatcher, tuple(arguments), returns)
        place = ctypes.addressof(cell.pointer)
        _BY_PLACE[place] = cell
        llvm.add_symbol(name, place)
        _CELLS[name] = cell
    return _CELLS[name]


def compile_all() -> None:
    """Compile all kernels that code of this process may call."""
    done: set[str] = set()
    while waiting := _CELLS.keys() - done:  # one may name others
        for name in sorted(waiting):
            _CELLS[name].fill()
        done |= waiting


def _compile(place: int) -> int:
    try:
        _BY_PLACE[place].fill()
    except KeyboardInterrupt:
        return STOPPED
    except BaseException:  # nothing can be raised through machine code
        LOG.exception("mbsd: a kernel could not be compiled")
        return FAILED
    return READY


CALLED.add(_compile.__code__)
_HELD = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)(_compile)
llvm.add_symbol(COMPILE, ctypes.cast(_HELD, ctypes.c_void_p).value)


def by_cell(dispatcher: Any, returns: Any) -> Any:
    """Return the function that kernels call instead of ``dispatcher``, which returns numba's ``returns``."""

    def called(typing: Any, *arguments: Any) -> Any:  # pyright: ignore[reportUnusedParameter]
        return returns(*map(types.unliteral, arguments)), _through_cell(dispatcher)

    typing = inspect.Parameter("typing", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    parameters = inspect.signature(dispatcher.py_func).parameters.values()
    called.__signature__ = inspect.Signature([typing, *parameters])
    called.__name__ = dispatcher.py_func.__name__
    made = intrinsic(called)
    made.kernel = dispatcher
    return made


def _through_cell(dispatcher: Any) -> Callable[..., Any]:
    """Return numba's code generator of a call."""
    byte = cgutils.ir.IntType(8).as_pointer()
    status = cgutils.ir.IntType(32)

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        cell = cell_of(dispatcher, signature.args, signature.return_type)
        context.active_code_library.note_cell(cell)
        module, conventions = builder.module, context.call_conv
        place = module.globals.get(cell.name) or cgutils.ir.GlobalVariable(module, byte, cell.name)
        with cgutils.if_unlikely(builder, cgutils.is_null(builder, builder.load(place))):
            fill = cgutils.get_or_insert_function(module, cgutils.ir.FunctionType(status, [place.type]), COMPILE)
            compiled = builder.call(fill, [place])
            with cgutils.if_unlikely(builder, builder.icmp_signed("==", compiled, status(FAILED))):
                conventions.return_user_exc(builder, RuntimeError, ("mbsd: a kernel could not be compiled",))
            with cgutils.if_unlikely(builder, cgutils.is_null(builder, builder.load(place))):
                conventions.return_user_exc(builder, KeyboardInterrupt, ())
        kind = conventions.get_function_type(signature.return_type, signature.args)
        function = builder.bitcast(builder.load(place), kind.as_pointer())
        ended, result = conventions.call_function(builder, function, signature.return_type, signature.args, values)
        with cgutils.if_unlikely(builder, ended.is_error):
            conventions.return_status_propagate(builder, ended)
        return context.get_dummy_value() if signature.return_type is types.none else result

    return code
