"""Motion laws for drivers, one file a law.

A law takes times (T,) and returns (T, 3): value, rate, acceleration, in rad or m by seconds.
"""

from __future__ import annotations

from mbsd.motions.constant_rate import constant_rate
from mbsd.motions.cycloidal import cycloidal
from mbsd.motions.function import function
from mbsd.motions.harmonic import harmonic
from mbsd.motions.law import Motion
from mbsd.motions.polynomial import polynomial
from mbsd.motions.recorded import recorded
from mbsd.motions.table import table

__all__ = ["Motion", "constant_rate", "cycloidal", "function", "harmonic", "polynomial", "recorded", "table"]
