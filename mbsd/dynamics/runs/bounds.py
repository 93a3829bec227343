"""Bounds of steps that end at jumps of Genevas, for single simulations and for the compiled loop over many."""

from __future__ import annotations

SHORT = 1e-3
"""Part of the way to the jump that is left, so that Newton's steps do not go beyond it."""
MOST = 60
SIDE = 1e-300
"""A gap (m) that has a sign, and no size."""
NEAR = 3.0
"""Steps from which on a jump is gone for."""
MOST_UNSEEN = 10
"""Steps that are taken before it is asked again how far the next jump is."""
ROUNDING = 8
"""Rounding of the time, in neighbouring numbers: a jump is not found closer than this."""
