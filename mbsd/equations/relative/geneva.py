"""Geneva constraint: a pin on crank i turns the slotted wheel j while in a slot; else it is locked.

In the axes of marker i (centre of the crank, x axis through the pin at radius r) the wheel's centre lies at (x, y):

driven, x > r      F = a - atan2(y, x - r) - pi          a slot of the wheel lies along the line to the pin
dwell              F = a - atan2(y, x) - pi - pi / n     the wheel's lock faces the crank

reduced to the value nearest to zero, as the n slots repeat after 2 pi / n. The x axis of marker j is one of the slots.
For r = c sin(pi / n), c the distance of the centres, the pin enters along the slot: F and the velocity are continuous
and the acceleration jumps, by tan(pi / n) of the crank's omega^2.

Source: Norton, Design of Machinery, ch. 2; Bickford, Mechanisms for Intermittent Motion, 1972, ch. 9.
"""

from __future__ import annotations

import math

from mbsd.equations.relative.equation import FA, FX, FXX, FXY, FY, FYY, OWN, A, F, X, Y, clear, equation


@equation
def residual(numbers, relative, out):
    """Fill F (rad); numbers: n, r, and the x beyond which the pin is in its slot.

    That x is r, or another number that holds it in or out.
    """
    pitch = 2.0 * math.pi / numbers[OWN]
    radius = numbers[OWN + 1]
    x = relative[X]
    y = relative[Y]
    value = relative[A] - math.pi
    if x > numbers[OWN + 2]:
        x -= radius
    else:
        value -= 0.5 * pitch
    value -= math.atan2(y, x)
    square = x * x + y * y
    fourth = square * square
    clear(out)
    out[F] = value - pitch * math.floor(value / pitch + 0.5)
    out[FX] = y / square
    out[FY] = -x / square
    out[FA] = 1.0
    out[FXX] = -2.0 * x * y / fourth
    out[FXY] = (x * x - y * y) / fourth
    out[FYY] = 2.0 * x * y / fourth
