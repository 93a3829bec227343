"""Blocks of a plan in independent coordinates as arrays: bodies that only Newton-Raphson places (block.py).

Their tables are those of mbsd/kinematics/groups/blocks.py one after the other, in one array of integers and one of
numbers, and all scratch is one array: an integrator's loop hands over what has few parts. ``block`` begins with where
each begins.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.dynamics.independent.places import (
    ARMS,
    BODIES,
    DETERMINANT_AT,
    EQUATIONS,
    FIRST,
    FRAME,
    HEAD,
    HEADS,
    KEPT_Q,
    KEPT_SIZE,
    NEAR,
    NEAR_AT,
    ROWS,
    SEEN_AT,
    TREE,
    TURN_AT,
    UNKNOWN_AT,
    WORK,
)
from mbsd.kinematics.groups.block_tables import Tables
from mbsd.kinematics.groups.blocks import ARM, LARGEST


def block_arrays(blocks: Sequence[Tables], bodies: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """``block`` and ``block_number`` of Embedding; ``columns``: of B."""
    unknowns = sum(len(tables.equations) for tables in blocks)
    most = max((len(tables.tree) for tables in blocks), default=0)
    kept = 3 * bodies + (columns + 2) * unknowns + len(blocks) if blocks else 0
    start = np.zeros(WORK + 1, np.int64)
    start[HEADS], start[KEPT_SIZE] = WORK + 1, kept
    start[KEPT_Q] = kept
    start[UNKNOWN_AT], start[DETERMINANT_AT] = 3 * bodies, 3 * bodies + (columns + 2) * unknowns
    sizes = [
        (columns + 1) * len(blocks),
        3 * bodies,
        3 * bodies,
        2 * bodies,
        3 * LARGEST,
        6 * LARGEST,
        10 * LARGEST,
        2 * LARGEST,
        32,
    ]
    sizes.append(LARGEST * LARGEST + 3 * LARGEST * most + 16)
    start[SEEN_AT : WORK + 1] = 2 * kept + np.cumsum([0, *sizes])
    if not blocks:
        start[WORK] = 0
    integers, numbers = [*start], list[float]()
    heads = np.zeros((len(blocks), HEAD), np.int64)
    integers += [0] * heads.size
    first = 0
    for head, tables in zip(heads, blocks, strict=True):
        near = sorted(set(tables.near) | _arms(tables))
        head[[BODIES, EQUATIONS, NEAR, FIRST]] = len(tables.tree), len(tables.equations), len(near), first
        first += len(tables.equations)
        for entry, lines in ((TREE, tables.tree), (ROWS, tables.equations)):
            head[entry] = len(integers)
            integers += [value for line in lines for value in line]
        head[NEAR_AT] = len(integers)
        integers += near
        for entry, lines in ((FRAME, tables.frame), (ARMS, tables.arms)):
            head[entry] = len(numbers)
            numbers += [value for line in lines for value in line]
    block = np.array(integers, np.int64)
    block[WORK + 1 : WORK + 1 + heads.size] = heads.ravel()
    return block, np.array(numbers, float)


def block_work(block: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The scratch of one run that begins at q (3 nb,)."""
    work = np.zeros(int(block[WORK]))
    if block[KEPT_SIZE]:
        work[block[KEPT_Q] : block[KEPT_Q] + len(q)] = q
        work[block[TURN_AT]] = 1.0
    return work


def _arms(tables: Tables) -> set[int]:
    """Known bodies whose turns an equation counts."""
    return {line[ARM] for line in tables.equations} - {line[0] for line in tables.tree} - {0}
