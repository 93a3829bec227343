"""Points carried by bodies and bodies hung on points, places alone; place (nb, 4): x, y, cosine, sine."""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.kinematics.groups.carrying.rates import DOUBTED, OPEN

FLAT = 1e-10
"""Discriminant over squared lengths at which branches meet."""


@inlined
def point_of(place, b, x, y, out):
    """World place of the point with arm (x, y) of body b."""
    out[0] = place[b, 0] + place[b, 2] * x - place[b, 3] * y
    out[1] = place[b, 1] + place[b, 3] * x + place[b, 2] * y


@inlined
def put_on(place, b, px, py, x, y):
    """Place body b, whose direction is known, so that its point with arm (x, y) is (px, py)."""
    place[b, 0] = px - place[b, 2] * x + place[b, 3] * y
    place[b, 1] = py - place[b, 3] * x - place[b, 2] * y


@inlined
def point_along(place, b, x, y, lx, ly):
    """Turn body b so that its direction (lx, ly) points along (x, y)."""
    scale = 1.0 / math.sqrt((x * x + y * y) * (lx * lx + ly * ly))
    place[b, 2] = (x * lx + y * ly) * scale
    place[b, 3] = (y * lx - x * ly) * scale


@inlined
def turn_with(place, b, leader, turn):
    """Turn body b as its leader, further by the angle of cosine and sine ``turn`` (2,)."""
    place[b, 2] = place[leader, 2] * turn[0] - place[leader, 3] * turn[1]
    place[b, 3] = place[leader, 3] * turn[0] + place[leader, 2] * turn[1]


@inlined
def root_of(left):
    """Root of a discriminant over squared lengths; -OPEN, or -DOUBTED where it says that branches meet."""
    return -float(OPEN) if left < -FLAT else (math.sqrt(left) if left > FLAT else -float(DOUBTED))
