"""Motion laws for drivers: formulas, splines, curves, functions of the user.

A law takes times (T,) and returns (T, 3): value, rate, acceleration, in rad or m by seconds.
"""

from __future__ import annotations

from mbsd.model.laws.formulas import constant_rate, cycloidal, harmonic, polynomial
from mbsd.model.laws.function import function
from mbsd.model.laws.law import Motion
from mbsd.model.laws.splines import recorded, table

__all__ = ["Motion", "constant_rate", "cycloidal", "function", "harmonic", "polynomial", "recorded", "table"]
