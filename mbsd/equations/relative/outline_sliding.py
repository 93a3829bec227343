"""Outline sliding constraint: how far two bodies have slid on each other where outlines touch.

F = s + s_run - c, counted from ZERO: arc length of the foot on the outline of body i and that on the run of body j,
which they pass in opposite directions, so that F stands still while they roll; see outline_features.py. Once round a
closed outline F changes by the length of a round, and that of the run where it is a closed loop; F is taken to its
value nearest to zero.
"""

from __future__ import annotations

import math

from mbsd.equations.relative.equation import PHASE, F, equation
from mbsd.equations.relative.outline_features import ROUND, fill_slid
from mbsd.equations.system import ZERO


@equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers as in outline_features.py."""
    fill_slid(numbers, relative, out)
    value = out[F] - numbers[PHASE] - relative[ZERO]
    if numbers[ROUND] > 0.0:
        value -= numbers[ROUND] * math.floor(value / numbers[ROUND] + 0.5)
    out[F] = value
