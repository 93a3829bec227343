"""Motion laws for drivers, one file a law.

A law takes times (T,) and returns (T, 3): value, rate, acceleration, in rad or m by seconds.
"""

from __future__ import annotations

from mbsd.model.laws.constant_rate import constant_rate
from mbsd.model.laws.cycloidal import cycloidal
from mbsd.model.laws.function import function
from mbsd.model.laws.harmonic import harmonic
from mbsd.model.laws.law import Motion
from mbsd.model.laws.polynomial import polynomial
from mbsd.model.laws.recorded import recorded
from mbsd.model.laws.table import table

__all__ = ["Motion", "constant_rate", "cycloidal", "function", "harmonic", "polynomial", "recorded", "table"]
