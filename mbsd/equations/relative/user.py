"""Constraint F(x, y, a) = 0 of the user; mbsd/arrays/user_constraint.py gives its derivatives."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.equations.relative.equation import OWN, PHASE, F, equation
from mbsd.equations.system import ZERO


@equation
def residual(numbers, relative, out):
    """Fill F; numbers: the address of a function of length and relative pose, and the length (m).

    The function fills ``out``.
    """
    call(int(numbers[OWN]), numbers[OWN + 1], relative, out)  # pyright: ignore[reportCallIssue]
    out[F] -= numbers[PHASE] + relative[ZERO]
