"""Cases of solution of a group, and the needs of its formulas: one formula serves all three.

    PoseAlone      poses of many designs, whose drivers' angles are tabulated          no columns
    AlongLaws      a driven motion: rates in time, then accelerations                  1 column, and the last
    PerCoordinate  rates for each independent coordinate, then convective ones         C columns, and the last

A driven motion is the case of one coordinate, the time, whose speed is 1. The class of the first argument of a kernel
decides which of the functions here it calls when it is compiled (mbsd/compiling/alternatives.py), so the number of
columns of the first two is known then, and nothing is left of what they do not need.

Branches: of its two poses a group takes the one to which the motion since the last pose leads.

    theta = theta_0 + sum B_j (z_j - z_0j) + c tau^2 / 2         tau: time since then

Only groups that are near to where both poses meet ask; the others keep theirs. Where the prediction does not tell
clearly the evaluation is doubted, and the step is taken again with another length.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, internal, lazy, merged
from mbsd.kinematics.groups import carried

FLAT = 1e-12
"""Squared sine at which branches meet: lengths that agree to this part count as equal."""
FLAT_ALONE = 1e-10
"""The same for poses alone, between which nothing else is looked at."""


class PoseAlone(NamedTuple):
    """Poses of one design."""

    group: Any
    """(g, 8) and ``number`` (g, 21): tables.py."""
    number: Any
    body: Any
    """(nb, 7) columns in carried.py."""
    rate: Any
    """Never read."""
    driven: Any
    """(g, 2) cosine and sine of the angle of DRIVEN groups, value of the law of the others."""


class AlongLaws(NamedTuple):
    """All bodies at one time of a driven motion."""

    group: Any
    number: Any
    body: Any
    rate: Any
    """(nb, 6) velocities, accelerations."""
    drive: Any
    """(motions + 1, 3) laws and their rates; the first row is zero."""
    tiny: Any
    """Square of a length that counts as zero (m^2)."""


class PerCoordinate(NamedTuple):
    """All bodies in independent coordinates (mbsd/dynamics/independent/arrays.py)."""

    group: Any
    number: Any
    body: Any
    rate: Any
    """(nb, 3 (C + 1))"""
    base: Any
    coordinate: Any
    drive: Any


def formula(function: Callable[..., Any]) -> Any:
    """Return the kernel of a kind that few mechanisms hold: compiled when one first does.

    The loop over designs takes its code in, for there a call costs as much as the pose.
    """
    called = lazy(int)(function)
    return alternatives({PoseAlone: merged(function), AlongLaws: called, PerCoordinate: called})


@inlined
def _no_columns(case):
    return -1


@inlined
def _time(case):
    return 1


@inlined
def _coordinates(case):
    return case.coordinate.shape[0] - 1


columns_of = alternatives({PoseAlone: _no_columns, AlongLaws: _time, PerCoordinate: _coordinates})
"""C, or -1 where poses alone are solved."""


@inlined
def _unit_speed(case, j):
    return 1.0


@inlined
def _speed(case, j):
    return case.coordinate[j, carried.SPEED]


speed_of = alternatives({PoseAlone: _unit_speed, AlongLaws: _unit_speed, PerCoordinate: _speed})
"""z_j', by which rates in column j count to rates in time."""


@inlined
def _reached_alone(case, n):
    if n[carried.SINE] > FLAT_ALONE:
        return carried.SOLVED
    return carried.OPEN if n[carried.SINE] < -FLAT_ALONE else carried.DOUBTED


@inlined
def _reached_along(case, n):
    if n[carried.SINE] > FLAT:
        return carried.SOLVED
    return carried.OPEN if n[carried.SINE] < -FLAT else carried.MEETING


@inlined
def _reached(case, n):
    return carried.SOLVED if n[carried.SINE] > n[carried.AVOID] else carried.DOUBTED


reached = alternatives({PoseAlone: _reached_alone, AlongLaws: _reached_along, PerCoordinate: _reached})
"""SOLVED where a group with this squared sine closes and its two poses are apart, else why not."""


@inlined
def _never_short(case, square):
    return False


@inlined
def _short(case, square):
    return not square > case.tiny


too_short = alternatives({PoseAlone: _never_short, AlongLaws: _short, PerCoordinate: _never_short})
"""True if a squared distance counts as zero."""


@inlined
def _kept(case, n, b, lx, ly, tx, ty, apart):
    return n[carried.SIGN]


@internal
def _predicted_side(case, n, b, lx, ly, tx, ty, apart):
    if n[carried.NEAR] > 0.0:
        theta = predicted(case.base, case.coordinate, b)
        c = math.cos(theta)
        s = math.sin(theta)
        side = (c * lx - s * ly) * tx + (s * lx + c * ly) * ty
        if doubted(side, apart):
            return 0.0
        n[carried.SIGN] = 1.0 if side > 0.0 else -1.0
    return n[carried.SIGN]


branch_of = alternatives({PoseAlone: _kept, AlongLaws: _kept, PerCoordinate: _predicted_side})
"""Sign of the root, or 0 where it is in doubt: near to where both poses meet that to which the motion leads.

Then it is the side to which (lx, ly) of body b points along (tx, ty); ``apart`` >= 0: how far it points there.
"""


@inlined
def _not_noted(case, n, change):
    pass


@inlined
def _noted(case, n, change):
    n[carried.CHANGE] = change


note_change = alternatives({PoseAlone: _not_noted, AlongLaws: _noted, PerCoordinate: _not_noted})
"""Keep the rate of the squared sine (1/s)."""


@inlined
def _value_alone(case, e, law, column):
    return case.driven[e, 0]


@inlined
def _value_along(case, e, law, column):
    return case.drive[law, 0]


@inlined
def _value(case, e, law, column):
    return case.coordinate[column, carried.VALUE] if column >= 0 else case.drive[law, 0]


value_of = alternatives({PoseAlone: _value_alone, AlongLaws: _value_along, PerCoordinate: _value})
"""Value of the law of group e, or of its coordinate where there is one."""


@inlined
def _no_rate(case, law, order):
    return 0.0


@inlined
def _rate_of_law(case, law, order):
    return case.drive[law, order]


law_rate = alternatives({PoseAlone: _no_rate, AlongLaws: _rate_of_law, PerCoordinate: _rate_of_law})
"""First or second rate of a law; zero for law 0."""


FLOOR = 1e-6
"""Squared sine of the angle between a group's two links below which no tolerance is met by its closed form."""
WIDE = 0.36
"""Squared sine above which a group keeps its branch through a step."""
MISSED = 0.5
"""Part of the way between the poses by which the prediction may miss."""


@internal
def predicted(base, coordinate, b):
    """Return angle of body b (rad)."""
    columns = coordinate.shape[0] - 1
    since = coordinate[columns, carried.VALUE]
    theta = base[b, carried.THETA] + 0.5 * base[b, carried.BEND] * since * since
    for j in range(columns):
        theta += base[b, carried.TURNS + j] * (coordinate[j, carried.VALUE] - coordinate[j, carried.BASE])
    return theta


@internal
def doubted(side, reach):
    """Return True if the predicted distance from the meeting of both poses is far from ``reach`` >= 0."""
    return not abs(abs(side) - reach) <= MISSED * reach


@internal
def angle_of(body, base, coordinate, b):
    """Return angle of body b (rad), all its turns counted."""
    guess = predicted(base, coordinate, b)
    angle = math.atan2(body[b, carried.SIN], body[b, carried.COS])
    turns = (guess - angle) / (2.0 * math.pi) + 0.5
    whole = int(turns)
    if whole > turns:
        whole -= 1  # a floor in place, which math.floor calls from afar
    return angle + 2.0 * math.pi * whole
