"""User functions that kernels call by address: plain Python functions, or ones compiled with numba.

    void f(double t, const double *in, double *out)

The user writes ``f(t, part, ...)`` and returns a number, or as many numbers as are wanted. The parts are slices of
``in``: arrays, or numbers where a part's length is 1. A function compiled with ``numba.njit`` is compiled in; a Python
function costs a few microseconds a call. ``numba.cfunc`` objects of the signature above are taken as they are.

A C function cannot raise. What a user's function raises, and numbers that are not finite, come out as NaN and are
remembered; whoever ran the kernel calls :meth:`Callback.check`, which raises ModelError with the time and the inputs.

Integrators with an error estimate try states far off and refuse them: there a function may overflow or leave its domain
(ArithmeticError, ValueError, not finite), which :meth:`Callback.forget` drops once a shorter step has been accepted. So
the failure kept is the last one at inputs that are finite themselves, and the first one of any other kind.

A function compiled with numba gets its frame once in each thread, for all mechanisms that use it one after another.
"""

from __future__ import annotations

import ctypes
import math
import threading
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numba
import numpy as np
from numba import types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.core.dispatcher import Dispatcher
from numba.extending import intrinsic

from mbsd.base.arguments import described
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import shown
from mbsd.base.running import CALLED, Kept, was_interrupted

SIGNATURE = types.void(types.float64, types.CPointer(types.float64), types.CPointer(types.float64))
PROTOTYPE = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_ssize_t, ctypes.c_ssize_t)
"""The same for ctypes, with the addresses as whole numbers."""
OF_NUMBERS = ArithmeticError, ValueError
"""Errors that functions raise if they overflow or leave their domain."""


class WrongValue(Exception):
    """A user's function gave a wrong value; the text goes on after "the user's function"."""


def as_numbers(values: Any, count: int) -> np.ndarray:
    """Return a user function's result, in a row or in rows, as (count,) numbers.

    Raises WrongValue otherwise.
    """
    wanted = "a number" if count == 1 else f"{count} numbers"
    try:
        array = np.atleast_1d(np.asarray(values))
    except ValueError as error:
        raise WrongValue(f"gives rows of unequal length, {shown(values)}; {wanted} are wanted") from error
    if array.dtype.kind not in "fiu":
        raise WrongValue(f"gives {shown(values)}; it must give {wanted}")
    if array.size != count:
        raise WrongValue(f"gives {array.size} numbers; {count} are wanted")
    return array.ravel()


class Callback:
    """A user function at an address. Keep it alive as long as kernels may call it."""

    def __init__(self, function: Callable, parts: Sequence[int], outputs: int, what: str, timed: bool = True) -> None:
        """Make ``function(t, part, ...)``, with parts of these lengths and ``outputs`` numbers, callable.

        ``what`` names the function in errors: mechanism and joint or force. ``timed``: the time it gets is that of the
        motion. Raises ModelError if it is no function, or if numba cannot compile it.
        """
        self.function, self.parts, self.outputs, self.what, self.timed = function, tuple(parts), outputs, what, timed
        self._failure = np.zeros(2 + sum(parts))
        """1 where it failed, time (s), inputs."""
        self._error: BaseException | None = None
        self._views: dict[tuple[int, int], np.ndarray] = {}
        if isinstance(function, CFunc):
            self._held: Any = function
            self.address: int = function.address
        elif isinstance(function, Dispatcher):
            key = function, self.parts, outputs, threading.get_ident()
            self._held, self._failure = _FRAMES.get(key, lambda: (self._compile(), self._failure))
            self._failure[0] = 0.0
            self.address = self._held.address
        elif callable(function):
            self._held = PROTOTYPE(self._run)
            self.address = ctypes.cast(self._held, ctypes.c_void_p).value or 0
        else:
            raise ModelError(f"{what}: {shown(function)} is no function; give one of the time and the state")

    def forget(self, before: float = math.inf) -> None:
        """Drop an overflow or the like that happened before a time (s) up to which states were accepted since."""
        if self._serious is None and (before == math.inf or (self.timed and self._failure[1] < before)):
            self._failure[0], self._error = 0.0, None

    @property
    def _serious(self) -> BaseException | None:
        return None if isinstance(self._error, OF_NUMBERS) else self._error

    @staticmethod
    def is_machine_code(function: object) -> bool:
        """Return True if a function is compiled with numba."""
        return isinstance(function, CFunc | Dispatcher)

    @property
    def compiled(self) -> bool:
        """True if it is machine code, of which several threads may call copies."""
        return self.is_machine_code(self.function)

    @property
    def failed(self) -> bool:
        """True if it failed since the last check, as far as is known."""
        return bool(self._failure[0])

    def check(self) -> None:
        """Raise what the function raised since the last check, as a ModelError; interrupts as they are."""
        failed, error = bool(self._failure[0]), self._error
        self._failure[0], self._error = 0.0, None
        if not failed:
            return
        t, inputs = float(self._failure[1]), self._failure[2:].copy()
        if isinstance(error, MechanismError) or (error is not None and not isinstance(error, Exception)):
            raise error
        when = f"at t = {t:.6g} s with" if self.timed else "at"
        at = f"{self.what}: {when} {np.array2string(inputs, precision=6)} the user's function"
        if error is None:
            try:
                values = self._values(t, inputs)
            except Exception as again:
                error = again
            else:
                raise ModelError(f"{at} gives {values}; it must give finite numbers")
        if isinstance(error, WrongValue):
            raise ModelError(f"{at} {error}") from error.__cause__
        raise ModelError(f"{at} fails: {described(error)}") from error

    def _values(self, t: float, inputs: np.ndarray) -> np.ndarray:
        """Return the checked values of the function, called from Python."""
        arguments, at = [], 0
        for length in self.parts:
            arguments.append(float(inputs[at]) if length == 1 else inputs[at : at + length])
            at += length
        return as_numbers(self.function(t, *arguments), self.outputs)

    def _run(self, t: float, inputs: int, outputs: int) -> None:
        copied, out = self._view(inputs, len(self._failure) - 2).copy(), self._view(outputs, self.outputs)
        failed: BaseException | None = None
        try:
            out[:] = self._values(t, copied)
            if was_interrupted():
                raise KeyboardInterrupt
            if all(map(math.isfinite, out)):
                return
        except BaseException as error:  # kept for check(): nothing can be raised through a C function
            failed = error
        out[:] = math.nan
        if not self._failure[0] or (self._serious is None and np.isfinite(copied).all()):
            self._error = failed
            self._failure[0], self._failure[1], self._failure[2:] = 1.0, t, copied

    CALLED.update((_run.__code__,))

    def _view(self, address: int, length: int) -> np.ndarray:
        key = address, length
        if key not in self._views:
            buffer = (ctypes.c_double * length).from_address(address)
            self._views[key] = np.frombuffer(buffer, np.float64) if length else np.zeros(0)
        return self._views[key]

    CALLED.update((_view.__code__,))

    def _compile(self) -> CFunc:
        """Return the numba function in a frame that splits the input and remembers a failure."""
        function, count, outputs = _spread(self.function, self.parts), sum(self.parts), self.outputs
        scalar, failure = outputs == 1, self._failure.ctypes.data

        def frame(t, inputs, out):
            given = numba.carray(inputs, (count,))
            good = True
            try:
                values = function(t, given.copy())
                if scalar:
                    out[0] = values
                else:
                    good = len(values) == outputs
                    for k in range(outputs):
                        out[k] = values[k] if good else math.nan
            except Exception:
                good = False
            for k in range(outputs):
                good = good and math.isfinite(out[k])
            if not good:
                record = numba.carray(_pointer(failure), (count + 2,))  # pyright: ignore[reportCallIssue]
                for k in range(outputs):
                    out[k] = math.nan
                later = record[0] == 0.0
                if not later:  # what follows from inputs that are not finite is no cause
                    later = True
                    for k in range(count):
                        later = later and math.isfinite(given[k])
                if later:
                    record[0] = 1.0
                    record[1] = t
                    for k in range(count):
                        record[2 + k] = given[k]

        try:
            return numba.cfunc(SIGNATURE)(frame)
        except numba.core.errors.NumbaError as error:
            first = str(error).strip().splitlines()
            raise ModelError(
                f"{self.what}: numba cannot compile the function for t and parts of {list(self.parts)} numbers "
                f"giving {outputs}: {' '.join(first)[:400]}"
            ) from error


_FRAMES: Kept[tuple[CFunc, np.ndarray]] = Kept()
"""Frames of compiled functions with the records of their failures."""


def _spread(function: Any, parts: tuple[int, ...]) -> Any:
    """Return ``function(t, part, ...)`` as a compiled function of t and one array."""
    ends = [int(end) for end in np.cumsum((0, *parts))]
    pick = tuple(_picker(a, b) for a, b in pairwise(ends))
    if len(pick) == 0:
        return numba.njit(lambda t, x: function(t))
    if len(pick) == 1:
        (first,) = pick
        return numba.njit(lambda t, x: function(t, first(x)))
    if len(pick) == 2:
        first, second = pick
        return numba.njit(lambda t, x: function(t, first(x), second(x)))
    if len(pick) == 3:
        first, second, third = pick
        return numba.njit(lambda t, x: function(t, first(x), second(x), third(x)))
    raise ModelError(f"a compiled function takes three parts at most beside the time, not {len(pick)}")


def _picker(begin: int, end: int) -> Any:
    if end - begin == 1:
        return numba.njit(lambda x: x[begin])
    return numba.njit(lambda x: x[begin:end])


@intrinsic
def _pointer(typing, address):  # pyright: ignore[reportUnusedParameter]
    """Return a whole number as a pointer to numbers."""
    result = types.CPointer(types.float64)

    def code(context, builder, signature, arguments):  # pyright: ignore[reportUnusedParameter]
        return builder.inttoptr(arguments[0], context.get_value_type(result))

    return result(types.intp), code


if numba.config.DISABLE_JIT:  # pyright: ignore[reportAttributeAccessIssue]

    def call(address, t, inputs, outputs):  # pyright: ignore[reportRedeclaration]
        """Call the function at ``address``: t, inputs (n,) to outputs (m,), contiguous arrays."""
        PROTOTYPE(int(address))(t, inputs.ctypes.data, outputs.ctypes.data)

else:

    @intrinsic
    def call(typing, address, t, inputs, outputs):  # pyright: ignore[reportUnusedParameter]
        """Call the function at ``address``: t, inputs (n,) to outputs (m,), contiguous arrays or pointers."""

        def code(context, builder, signature, arguments):
            where, time, *arrays = arguments
            data = [
                array if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, array).data
                for kind, array in zip(signature.args[2:], arrays, strict=True)
            ]
            double = cgutils.ir.DoubleType()
            pointer = double.as_pointer()
            function = cgutils.ir.FunctionType(cgutils.ir.VoidType(), [double, pointer, pointer])
            builder.call(builder.inttoptr(where, function.as_pointer()), [time, *data])
            return context.get_dummy_value()

        return types.void(types.int64, types.float64, inputs, outputs), code
