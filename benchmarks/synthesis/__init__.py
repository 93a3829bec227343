"""Path synthesis: a four-bar whose coupler point passes through four points, any pivots and lengths within bounds.

The points are of a known four-bar, so an exact design exists. The error is the largest distance (m) of a point from the
path, taken from a sweep by mbsd of each code's design; times are of the processor, which other programs do not change.
"""

from __future__ import annotations

import numpy as np

PROBLEM = "four-bar through four points, from a known one"
POINTS = np.array(
    [(0.22902721, 0.23877409), (0.23830146, 0.28944367), (0.11430643, 0.25583701), (0.04107749, 0.16811844)]
)
"""m; the first of the start, then each 67.5 degrees of the crank."""
STEPS = 3600
"""Number of steps of the sweep that gives the error."""
