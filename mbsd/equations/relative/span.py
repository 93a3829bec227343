"""Span constraint: the straight piece of a cable from one wheel to the next, of which neither slips on it.

s_i, s_j   signed radii: positive where the cable, on its way from i to j, turns counter-clockwise about the centre
h          = s_j - s_i:  how far centre j lies to the left of the cable's direction, seen from centre i
L          = sqrt(x^2 + y^2 - h^2):  length of the straight piece
phi        = atan2(y, x) - atan2(h, L):  its direction in the axes of marker i,  t = (cos phi, sin phi),  n = t_perp

P          = L - h phi + s_j a - c:  how much longer the way is than the cable between a mark on each wheel
F          = sigma P      sigma = 1: P = 0, the cable is taut;   sigma = -1: F >= 0 is how slack it hangs

P_x = t_x,  P_y = t_y,  P_a = s_j;   P_xx = n_x n_x / L,  P_xy = n_x n_y / L,  P_yy = n_y n_y / L

A point that carries an end of the cable is a wheel of radius 0. phi is counted over whole turns by the body that
carries both centres, ground where there is none. Where one wheel comes into the other, or to a cable that crosses
between them, there is no straight piece: h^2 >= x^2 + y^2.

Source: geometry of common tangents; Norton, Design of Machinery, ch. 9 (belts), of which this is one strand.
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
    """Fill F (m), not a number where there is no straight piece; own numbers s_i, s_j, sigma."""
    x = relative[X]
    y = relative[Y]
    along = numbers[OWN + 1]
    h = along - numbers[OWN]
    sign = numbers[OWN + 2]
    square = x * x + y * y
    clear(out)
    if square <= h * h:
        out[F] = math.nan
        return
    length = math.sqrt(square - h * h)
    psi = math.atan2(y, x)
    psi += TWO_PI * math.floor((relative[TURN] + numbers[DIRECTION] - psi) / TWO_PI + 0.5)
    tx = (length * x + h * y) / square
    ty = (length * y - h * x) / square
    value = length - h * (psi - math.atan2(h, length)) + along * relative[A]
    out[F] = sign * value - numbers[PHASE] - relative[ZERO]
    out[FX] = sign * tx
    out[FY] = sign * ty
    out[FA] = sign * along
    out[FXX] = sign * ty * ty / length
    out[FXY] = -sign * tx * ty / length
    out[FYY] = sign * tx * tx / length
