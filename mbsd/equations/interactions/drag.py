"""Drag of air; the law is in forces/drag.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import FX, FY, LAW, OMEGA, OWN, TORQUE, VX, VY, interaction


@interaction
def force(numbers, state, out):
    """Fill the force; numbers: coefficient, coefficient of turning, wind x and y, constant gust.

    The law of time is added to the gust.
    """
    gust = numbers[OWN + 4] + state[LAW]
    x = state[VX] - gust * numbers[OWN + 2]
    y = state[VY] - gust * numbers[OWN + 3]
    against = -numbers[OWN] * math.sqrt(x * x + y * y)
    out[FX] = against * x
    out[FY] = against * y
    out[TORQUE] = -numbers[OWN + 1] * abs(state[OMEGA]) * state[OMEGA]
