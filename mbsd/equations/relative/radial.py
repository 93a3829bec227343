"""Radial constraint of the relative pose: how far two points are apart, less or more than a length.

F   = s (l - c),   l = sqrt(x^2 + y^2)
F_x = s x / l,  F_y = s y / l;   F_xx = s y^2 / l^3,  F_xy = -s x y / l^3,  F_yy = s x^2 / l^3

s = 1: outside of each other; s = -1: a rope, or one disc inside another. l = 0 has no direction.
"""

from __future__ import annotations

import math

from mbsd.equations.relative import equation
from mbsd.equations.system import ZERO


@equation.equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers s, c."""
    x = relative[equation.X]
    y = relative[equation.Y]
    s = numbers[equation.OWN]
    length = math.sqrt(x * x + y * y)
    cube = length * length * length
    equation.clear(out)
    out[equation.F] = s * (length - numbers[equation.OWN + 1]) - numbers[equation.PHASE] - relative[ZERO]
    if length > 0.0:
        out[equation.FX] = s * x / length
        out[equation.FY] = s * y / length
        out[equation.FXX] = s * y * y / cube
        out[equation.FXY] = -s * x * y / cube
        out[equation.FYY] = s * x * x / cube
