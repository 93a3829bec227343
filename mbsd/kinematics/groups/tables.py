"""Tables of groups for the compiled loops, from what the plan says of each.

Lines of a link are divided by its squared length, so that turning it along a vector of that length is two products;
constant angles are kept as cosine and sine. Columns are named in each kind's file in kinds/.

A new kind is its file in kinds/, its code (groups.py), a line in KINDS here, and one in solve.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.carried import AVOID, SIGN, SINE
from mbsd.kinematics.groups.carried import NUMBERS as WIDTH
from mbsd.kinematics.groups.cases import FLOOR
from mbsd.kinematics.groups.groups import COORDINATE, KIND, LAW, NUMBERS, THIRD, WATCHED, Groups, Made
from mbsd.kinematics.groups.kinds import driven, prp, rod, rpr, rrp, rrr, slide, welded, yoke
from mbsd.kinematics.groups.kinds.train import BODY_3

KINDS = (driven.KIND, welded.KIND, rrr.KIND, rrp.KIND, rpr.KIND, yoke.KIND, prp.KIND, rod.KIND, slide.KIND)
NAMES = tuple(kind.name for kind in KINDS)
BRANCH = {kind.code: kind.branch for kind in KINDS if kind.branch is not None}
"""Index of the sign of the assembly."""


def tables_of(taken: Sequence[Made]) -> Groups:
    """Return the groups of a plan, in the order of their solution."""
    kind = np.array([code for code, _, _, _ in taken], np.int64)
    body = np.array([bodies for _, bodies, _, _ in taken], np.int64).reshape(-1, 4)
    motion = np.array([law for _, _, law, _ in taken], np.int64)
    number = np.array([[*numbers, *[0.0] * (NUMBERS - len(numbers))] for _, _, _, numbers in taken], float)
    number = number.reshape(-1, NUMBERS)
    group = np.zeros((len(kind), 8), np.int64)
    group[:, :LAW] = body
    group[:, LAW] = np.maximum(motion, 0)
    group[:, COORDINATE] = np.where(motion < 0, -motion - 1, -1)
    group[:, KIND] = kind
    group[:, THIRD] = np.where(kind == TRAIN, number[:, BODY_3], 0.0)
    angle, turning = np.zeros((len(kind), 2)), np.full((len(kind), 3), -1, np.int64)
    turning[:, WATCHED] = 0
    for e, code in enumerate(kind):
        if code < BLOCK:
            turning[e, WATCHED] = KINDS[code].watched
            for side, column, leader in KINDS[code].follows:
                angle[e, side], turning[e, side] = number[e, column], body[e, leader]
    return Groups(kind, body, motion, number, group, rows_of(kind, number), angle, turning)


def rows_of(kind: np.ndarray, number: np.ndarray) -> np.ndarray:
    """Return (..., g, 21) of Groups.row, from (..., g, 14) numbers of groups of these kinds."""
    out = np.zeros((*number.shape[:-1], WIDTH))
    for e, code in enumerate(kind):
        n = np.moveaxis(number[..., e, :], -1, 0)
        row = [] if code == BLOCK else n[:BODY_3] if code == TRAIN else KINDS[code].row(n)
        for column, values in enumerate(row):
            out[..., e, column] = values
        out[..., e, SIGN] = n[BRANCH[int(code)]] if int(code) in BRANCH else 1.0
    out[..., SINE] = 1.0
    out[..., AVOID] = FLOOR
    return out
