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

from mbsd.equations.relative import equation
from mbsd.equations.system import ZERO

TWO_PI = 2.0 * math.pi


@equation.equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers r_i, s r_j."""
    x = relative[equation.X]
    y = relative[equation.Y]
    square = x * x + y * y
    psi = math.atan2(y, x)
    both = numbers[equation.OWN] + numbers[equation.OWN + 1]
    if numbers[equation.WRAPS] == 0.0:
        psi += TWO_PI * math.floor((relative[equation.TURN] + numbers[equation.DIRECTION] - psi) / TWO_PI + 0.5)
    value = numbers[equation.OWN + 1] * relative[equation.A] - both * psi - numbers[equation.PHASE] - relative[ZERO]
    period = TWO_PI * abs(both)
    if numbers[equation.WRAPS] != 0.0 and period > 0.0:
        value -= period * math.floor(value / period + 0.5)
    fourth = square * square
    equation.clear(out)
    out[equation.F] = value
    out[equation.FX] = both * y / square
    out[equation.FY] = -both * x / square
    out[equation.FA] = numbers[equation.OWN + 1]
    out[equation.FXX] = -both * 2.0 * x * y / fourth
    out[equation.FXY] = both * (x * x - y * y) / fourth
    out[equation.FYY] = both * 2.0 * x * y / fourth
