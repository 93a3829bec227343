"""Branches: of its two poses a group takes the one to which the motion since the last pose leads.

    theta = theta_0 + sum B_j (z_j - z_0j) + c tau^2 / 2         tau: time since then

Only groups that are near to where both poses meet ask; the others keep theirs. Where the prediction does not tell
clearly the evaluation is doubted, and the step is taken again with another length.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.kinematics.groups.carrying.columns import BASE, BEND, COS, SIN, THETA, TURNS, VALUE

FLOOR = 1e-6
"""Squared sine of the angle between a group's two links below which no tolerance is met by its closed form."""
WIDE = 0.36
"""Squared sine above which a group keeps its branch through a step."""
MISSED = 0.5
"""Part of the way between the poses by which the prediction may miss."""


@internal
def predicted(base, coordinate, b):
    """Angle of body b (rad)."""
    columns = coordinate.shape[0] - 1
    since = coordinate[columns, VALUE]
    theta = base[b, THETA] + 0.5 * base[b, BEND] * since * since
    for j in range(columns):
        theta += base[b, TURNS + j] * (coordinate[j, VALUE] - coordinate[j, BASE])
    return theta


@internal
def doubted(side, reach):
    """Return True if the predicted distance from the meeting of both poses is far from ``reach`` >= 0."""
    return not abs(abs(side) - reach) <= MISSED * reach


@internal
def angle_of(body, base, coordinate, b):
    """Angle of body b (rad), all its turns counted."""
    guess = predicted(base, coordinate, b)
    angle = math.atan2(body[b, SIN], body[b, COS])
    turns = (guess - angle) / (2.0 * math.pi) + 0.5
    whole = int(turns)
    if whole > turns:
        whole -= 1  # a floor in place, which math.floor calls from afar
    return angle + 2.0 * math.pi * whole
