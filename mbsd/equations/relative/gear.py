"""Gear constraint: two circles roll on each other, wherever the line of their centres points.

psi   = atan2(y, x): direction of the line of centres in the axes of marker i; phi = theta_i + psi in the world
F     = r_i (theta_i - phi) + s r_j (theta_j - phi) - c = s r_j a - (r_i + s r_j) psi - c

s = 1: the circles turn against each other (external gears, crossed belt); s = -1: they turn the same way (ring gear i
around gear j, open belt). psi counts whole turns by the arm that carries both centres; where there is no arm, F is
reduced to its value nearest to zero, as it repeats after (r_i + s r_j) 2 pi.

Source: Willis, (theta_i - phi) / (theta_j - phi) = -+ r_j / r_i; Norton, Design of Machinery, ch. 9.
"""

from __future__ import annotations

import math

from mbsd.equations.relative.equation import (
    DIRECTION,
    FA,
    FX,
    FXX,
    FXY,
    FY,
    FYY,
    OWN,
    PHASE,
    TURN,
    WRAPS,
    A,
    F,
    X,
    Y,
    clear,
    equation,
)
from mbsd.equations.system import ZERO

TWO_PI = 2.0 * math.pi


@equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers r_i, s r_j."""
    x = relative[X]
    y = relative[Y]
    square = x * x + y * y
    psi = math.atan2(y, x)
    both = numbers[OWN] + numbers[OWN + 1]
    if numbers[WRAPS] == 0.0:
        psi += TWO_PI * math.floor((relative[TURN] + numbers[DIRECTION] - psi) / TWO_PI + 0.5)
    value = numbers[OWN + 1] * relative[A] - both * psi - numbers[PHASE] - relative[ZERO]
    period = TWO_PI * abs(both)
    if numbers[WRAPS] != 0.0 and period > 0.0:
        value -= period * math.floor(value / period + 0.5)
    fourth = square * square
    clear(out)
    out[F] = value
    out[FX] = both * y / square
    out[FY] = -both * x / square
    out[FA] = numbers[OWN + 1]
    out[FXX] = -both * 2.0 * x * y / fourth
    out[FXY] = both * (x * x - y * y) / fourth
    out[FYY] = both * 2.0 * x * y / fourth
