"""The one decorator for compiled kernels.

    kernel      called from Python and from kernels; its callers do not contain it (kernel_library.py)
    shared      the same, where it is mostly kernels that call it: what Python calls is compiled when Python first does
    apart       the same for kernels alone: without a wrapper for Python it compiles in half the time
    internal    small, called by kernels alone, whose machine code contains it
    inlined     copied into the caller by numba: passing a System by value costs more than the work
    lazy        called by kernels alone, and compiled when one of them first calls it (lazy_kernel.py)
    merged      copied into the caller by LLVM, so that numba reads it once: for large ones
    threaded    runs in several threads at once, each with scratch of its own
    at_address  called through its machine address, and compiled when that is first wanted

What they compile is the same machine code on every processor of a kind (kernel_target.py), kept by what it is made of
(kernel_cache.py). Settings of numba in the user's process are neither read nor changed, but for DISABLE_JIT.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numba
from numba.core import sigutils, types
from numba.core.ccallback import CFunc
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher
from numba.core.registry import CPUDispatcher

from mbsd.compiling.kernel_cache import KernelCache
from mbsd.compiling.kernel_library import Apart
from mbsd.compiling.kernel_pipeline import KernelCompiler, LinkedCompiler
from mbsd.compiling.kernel_target import GENERIC
from mbsd.compiling.lazy_kernel import by_cell
from mbsd.compiling.notice import give_notice

give_notice()

COMPILED = not numba.config.DISABLE_JIT  # pyright: ignore[reportPrivateImportUsage]


class _Kernel(CPUDispatcher):
    """numba's dispatcher for our target and cache."""

    targetdescr = GENERIC
    apart = False
    """True if callers call it where it stands and do not take its code in."""

    def enable_caching(self) -> None:
        """Keep what is compiled."""
        self._cache = KernelCache(self.py_func)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Treat a literal number of a caller as any number; else each would compile its own copy."""
        return super().get_call_template(
            tuple(map(types.unliteral, args)), {name: types.unliteral(kind) for name, kind in kws.items()}
        )

    def add_overload(self, cres: Any) -> None:
        """Add what was compiled or loaded."""
        if self.apart and "<" not in self.py_func.__qualname__:
            cres.library.apart = Apart(cres.fndesc.llvm_func_name, self, tuple(cres.signature.args))
        if cres.library.only_linked:
            self.overloads[tuple(cres.signature.args)] = cres
        else:
            super().add_overload(cres)

    def for_python(self, arguments: tuple[Any, ...]) -> Any:
        """Return what Python calls for arguments of these types of numba's."""
        return self.compile(arguments)

    def only_entry_point(self) -> Any:
        """Return the machine code that Python calls; None unless exactly one signature is compiled."""
        made = list(self.overloads.values())
        return made[0].entry_point if len(made) == 1 else None


class _Shared(_Kernel):
    """A kernel without a wrapper for Python, which a second one has that calls it."""

    @cached_property
    def _face(self) -> _Kernel:
        """Return the kernel that Python calls."""
        names = ", ".join(inspect.signature(self.py_func).parameters)
        code, space = self.py_func.__code__, {"called": self, "__name__": self.py_func.__module__}
        lines = f"def face({names}):\n    return called({names})\n"
        exec(compile("\n" * (code.co_firstlineno - 1) + lines, code.co_filename, "exec"), space)
        face: Any = space["face"]
        face.__name__ = face.__qualname__ = f"{self.py_func.__name__}_for_python"
        return _compiled(False)(face)

    def _compile_for_args(self, *arguments: Any, **named: Any) -> Any:
        """Return the result of the first call with arguments of some types."""
        overload = self._face._compile_for_args(*arguments, **named)
        with global_compiler_lock:
            for kinds, made in self._face.overloads.items():
                if kinds not in self._known:  # numba would find two alike, choose neither, and ask here in each call
                    self._known.add(kinds)
                    self._insert([kind._code for kind in kinds], made.entry_point)
        return overload

    @cached_property
    def _known(self) -> set[tuple[Any, ...]]:
        """Return the signatures that calls from Python find by themselves."""
        return set()

    def add_overload(self, cres: Any) -> None:
        """Add what was compiled or loaded; Python does not call it."""
        if "<" not in self.py_func.__qualname__:
            cres.library.apart = Apart(cres.fndesc.llvm_func_name, self, tuple(cres.signature.args))
        self.overloads[tuple(cres.signature.args)] = cres

    def for_python(self, arguments: tuple[Any, ...]) -> Any:
        """Return what Python calls for arguments of these types of numba's."""
        return self._face.compile(arguments)

    def only_entry_point(self) -> Any:
        """Return the machine code that Python calls; None unless exactly one signature is compiled."""
        return self._face.only_entry_point()


class _AtAddress(CFunc):
    """numba's function at an address for our target and cache."""

    _targetdescr = GENERIC

    def enable_caching(self) -> None:
        """Keep what is compiled."""
        self._cache = KernelCache(self._pyfunc)

    @property
    def address(self) -> Any:
        """Return the address; compile the function when it is first wanted."""
        if self._wrapper_address is None:
            self.compile()
        return self._wrapper_address


_OPTIONS = {"nopython": True, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True, "no_rewrites": True}
# _nrt off: kernels allocate nothing, and without it numba counts references to every array of a tuple (2x slower)


def _compiled(apart: bool, kind: type[_Kernel] = _Kernel, **more: Any) -> Callable[[Callable[..., Any]], Any]:
    def decorate(function: Callable[..., Any]) -> Any:
        if not COMPILED:
            return function
        compiler = LinkedCompiler if "no_cpython_wrapper" in more and not apart else KernelCompiler
        made = kind(py_func=function, locals={}, targetoptions={**_OPTIONS, **more}, pipeline_class=compiler)
        made.apart = apart
        made.enable_caching()
        return made

    return decorate


kernel = _compiled(True)
"""Compile for float64 arrays; IEEE division, no re-association, so the numbers do not depend on the compiler.
Kernels may not allocate: scratch comes in from outside."""

internal = _compiled(False, no_cpython_wrapper=True)
"""The same for small kernels that only kernels call."""

apart = _compiled(True, no_cpython_wrapper=True)
"""The same for large ones: callers do not contain them, so that each is optimised once."""

shared = _compiled(True, _Shared, no_cpython_wrapper=True)
"""The same for large ones that Python calls, too, but not in most runs: reading the arrays of a run costs as much to
compile as a small kernel."""

_RETURNED = {int: types.int64, float: types.float64, bool: types.boolean, None: types.none}


def lazy(returns: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator for large kernels that many runs do not call: compiled when first called.

    ``returns``: int, float, bool or None, the type of what the function returns.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        return by_cell(apart(function), _RETURNED[returns]) if COMPILED else function

    return decorate


inlined = _compiled(False, inline="always")
"""The same for kernels whose body is copied into the caller."""

merged = _compiled(False, no_cpython_wrapper=True, forceinline=True)
"""The same for large kernels whose body is copied into the caller: by LLVM, so that numba reads it once."""

threaded = _compiled(True, nogil=True)
"""The same for kernels that run in several threads at once, each with scratch of its own."""


def at_address(signature: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator for functions called through ``.address``; without the compiler the function."""

    def decorate(function: Callable[..., Any]) -> Any:
        if not COMPILED:
            return function
        made = _AtAddress(
            function, sigutils.normalize_signature(signature), {}, {"error_model": "numpy"}, KernelCompiler
        )
        made.enable_caching()
        return made

    return decorate


OFTEN = 50
"""Calls after which it pays to look up types once and for all: of the arrays of a run with events that takes 1.7 ms."""


class Often:
    """A kernel called over and over with arguments of the same types.

    numba looks at the types of all arguments in each call, 8 us for the arrays of a run and 75 us for those of one with
    events. Where one signature alone is compiled, a call that numba has taken had these types, and all others go to the
    machine code itself; else they do so after some calls. Arguments must then have the types, memory layouts included,
    of the call before; nothing checks it.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function, self._calls = function, 0

    def __call__(self, *arguments: Any) -> Any:
        """Call the kernel."""
        function = self._function
        if not isinstance(function, Dispatcher):
            return function(*arguments)
        self._calls += 1
        result = function(*arguments)
        machine_code = function.only_entry_point()
        if machine_code is None and self._calls == OFTEN:
            machine_code = function.for_python(tuple(map(function.typeof_pyval, arguments)))
        self._function = machine_code or function
        return result
