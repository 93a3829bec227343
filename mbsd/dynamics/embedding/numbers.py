"""Tables of groups for the compiled loops in independent coordinates, from those of mbsd/kinematics/groups/groups.py.

Lines of a link are divided by its squared length, so that turning it along a vector of that length is two products;
fixed angles are kept as cosine and sine. Columns are named in each kind's file in mbsd/kinematics/groups/kinds/.
"""

from __future__ import annotations

import numpy as np

from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.carrying.branch import FLOOR
from mbsd.kinematics.groups.carrying.columns import AVOID, NEAR, NUMBERS, SIGN
from mbsd.kinematics.groups.groups import COORDINATE, KIND, LAW, THIRD, Groups
from mbsd.kinematics.groups.kinds.train import BODY_3, embedded
from mbsd.kinematics.groups.registry import BRANCH, KINDS


def group_table(groups: Groups) -> np.ndarray:
    """(g, 8) for Embedding.group: laws are those of drivers, of a block its number."""
    table = np.zeros((len(groups.kind), 8), np.int64)
    table[:, :LAW] = groups.body
    table[:, LAW] = np.maximum(groups.motion, 0)
    table[:, COORDINATE] = np.where(groups.motion < 0, -groups.motion - 1, -1)
    table[:, KIND] = groups.kind
    table[:, THIRD] = np.where(groups.kind == TRAIN, groups.number[:, BODY_3], 0.0)
    return table


def group_numbers(groups: Groups) -> np.ndarray:
    """(g, 20) for Embedding.number."""
    out = np.zeros((len(groups.kind), NUMBERS))
    for row, kind, n in zip(out, groups.kind, groups.number, strict=True):
        made = embedded if kind == TRAIN else _nothing if kind == BLOCK else KINDS[kind].embedded
        numbers = made([float(x) for x in n])
        row[: len(numbers)] = numbers
        row[SIGN] = n[BRANCH[int(kind)]] if int(kind) in BRANCH else 1.0
        row[NEAR] = 0.0
        row[AVOID] = FLOOR
    return out


def _nothing(n: list[float]) -> list[float]:
    """Numbers of a block, which has tables of its own."""
    return []
