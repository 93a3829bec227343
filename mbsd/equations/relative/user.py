"""A constraint F(x, y, a) = 0 that the user wrote; mbsd/arrays/user_constraint.py gives its derivatives."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.equations.relative.equation import OWN, PHASE, F, equation
from mbsd.equations.system import ZERO


@equation
def residual(numbers, relative, out):
    """F; own numbers: the address of a function of length and relative pose that fills ``out``; the length (m)."""
    call(int(numbers[OWN]), numbers[OWN + 1], relative, out)  # pyright: ignore[reportCallIssue]
    out[F] -= numbers[PHASE] + relative[ZERO]
