"""Linear constraint: a sum of the relative coordinates has a fixed value.

F     = g_x x + g_y y + g_a a - c

It serves the rack (x + r a), the height of a disc over a line (y = r) and whatever else is linear.
"""

from __future__ import annotations

from mbsd.equations.relative.equation import FA, FX, FY, OWN, PHASE, A, F, X, Y, clear, equation
from mbsd.equations.system import ZERO


@equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers g_x, g_y, g_a, and b, which counts to c."""
    gx = numbers[OWN]
    gy = numbers[OWN + 1]
    ga = numbers[OWN + 2]
    clear(out)
    out[F] = gx * relative[X] + gy * relative[Y] + ga * relative[A] - numbers[OWN + 3] - numbers[PHASE] - relative[ZERO]
    out[FX] = gx
    out[FY] = gy
    out[FA] = ga
