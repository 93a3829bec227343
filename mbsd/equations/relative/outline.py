"""Outline constraint: the gap of a run of body j's outline from the outline of body i.

F = gap of the nearest pair of the run and a feature; see outline_features.py, which has its equations.
"""

from __future__ import annotations

from mbsd.equations.relative.equation import equation
from mbsd.equations.relative.outline_features import fill_gap


@equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers as in outline_features.py."""
    fill_gap(numbers, relative, out)
