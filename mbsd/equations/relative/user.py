"""A constraint F(x, y, a) = 0 that the user wrote; mbsd/arrays/user_constraint.py gives its derivatives."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.equations.relative.equation import OWN, PHASE, F, equation
from mbsd.equations.system import ZERO


@equation
def residual(numbers, relative, out):
    """F; own number: the address of a function of the relative pose that fills ``out``."""
    call(int(numbers[OWN]), 0.0, relative, out)  # pyright: ignore[reportCallIssue]
    out[F] -= numbers[PHASE] + relative[ZERO]
