"""One-row equations between two bodies, called by address and compiled when a model uses them.

    void f(const double *numbers, const double *relative, double *out)

Whatever depends only on how two bodies stand to each other is a function F(x, y, a) of the relative pose: place (x, y)
of marker j in the axes of marker i (m) and the angle ``a`` of marker j against marker i (rad, never wrapped). The file
of an equation fills, by the indices below, F, its gradient and its second derivatives; constraints/relative.py makes
from them the rows of Phi, J and gamma.

``numbers`` begins with the constants that the start pose decides, then come those of the joint, from ``OWN`` on. What
events change stands in ``relative``: ZERO, which an equation whose sliding is counted takes off like PHASE, and LAST
(mbsd/equations/system.py). Its places 4 to 13 are the equation's scratch.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mbsd.compiling.jit import COMPILED, at_address

X, Y, A, TURN = 0, 1, 2, 3
"""Places in ``relative``. TURN: how far the arm that carries both centres is turned against body i (rad)."""
F, FX, FY, FA, FXX, FXY, FXA, FYY, FYA, FAA = range(10)
"""Places in ``out``."""
OFFSET, PHASE, DIRECTION, WRAPS, OWN = range(5)
"""Places in ``numbers``: angle of marker j less that of marker i in their bodies; F = 0 stands for this much; direction
of the line of centres against the arm; 1 where no arm tells whole turns; the first number of the joint's own."""

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(POINTER, POINTER, POINTER)
_PYTHON: list[Callable] = []
"""Without the compiler an address is a place in this list."""


def equation(function: Callable) -> Any:
    """Decorator: an equation at an address."""
    if COMPILED:
        return at_address(SIGNATURE)(function)
    _PYTHON.append(function)
    return function


def address_of(constraint: str) -> int:
    """Where the equation of the constraint of this name is; compiles it at first."""
    made = importlib.import_module(f"mbsd.equations.relative.{constraint}").residual
    return made.address if COMPILED else _PYTHON.index(made)


if COMPILED:

    def _call(context, builder, where, data):
        pointer = cgutils.ir.DoubleType().as_pointer()
        function = cgutils.ir.FunctionType(cgutils.ir.VoidType(), [pointer] * 3)
        builder.call(builder.inttoptr(where, function.as_pointer()), data)
        return context.get_dummy_value()

    @intrinsic
    def evaluate(typing, address, numbers, relative, out):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Call the equation at ``address`` with three contiguous arrays."""

        def code(context, builder, signature, arguments):
            where, *arrays = arguments
            data = [
                context.make_array(kind)(context, builder, array).data
                for kind, array in zip(signature.args[1:], arrays, strict=True)
            ]
            return _call(context, builder, where, data)

        return types.void(types.int64, numbers, relative, out), code

    @intrinsic
    def evaluate_from(typing, address, numbers, first, relative, out):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """The same with pointers, of the numbers from ``first`` on."""

        def code(context, builder, signature, arguments):
            where, numbers, first, *others = arguments
            return _call(context, builder, where, [builder.gep(numbers, [first]), *others])

        return types.void(types.int64, numbers, types.int64, relative, out), code

else:

    def evaluate(address, numbers, relative, out):
        """Call the equation at ``address`` with three contiguous arrays."""
        _PYTHON[address](numbers, relative, out)

    def evaluate_from(address, numbers, first, relative, out):
        """The same, of the numbers from ``first`` on."""
        _PYTHON[address](numbers[first:], relative, out)
