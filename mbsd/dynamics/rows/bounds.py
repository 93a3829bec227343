"""Bounds of rows of joints that repeat others."""

from __future__ import annotations

LOOK = 10
"""Steps between two looks at which rows hold."""
OPENED_BY = 1e-7
"""Residuals (sizes, rad) of rows that do not hold."""
