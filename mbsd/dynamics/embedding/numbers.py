"""The numbers of each kind of group for the compiled loops, from those of mbsd/kinematics/groups/groups.py.

Lines of a link are divided by its squared length, so that turning it along a vector of that length is two products;
fixed angles are kept as cosine and sine.

    DRIVEN   P on K1, P on A, offset, sense
    WELDED   P on K1, P on A, turn of A
    RRR      P on K1, P on A, l / l^2, Q on K2, Q on B, m / m^2, l^2, l^2 - m^2, 1 / (l^2 m^2)
    RRP      P on K1, P on A, l / l^2, C on K2, axis, turn of B, C on B, l^2, 1 / l^2
    RPR      P on K1, P on A, axis on A, offset, Q on K2, turn of B, Q on B
    YOKE     as there, the angle as turn
    PRP      C on K1, axis, turn, C on A, and the same of K2 and B
    ROD      P on K1, P on A, l / l^2, Q on K2, length, l^2
    SLIDE    as there, the angle as turn
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.dynamics.embedding.arrays import AVOID, NEAR, NUMBERS, SIGN
from mbsd.dynamics.embedding.groups.branch import FLOOR
from mbsd.kinematics.groups.groups import BRANCH, DRIVEN, PRP, ROD, RPR, RRP, RRR, WELDED, YOKE, Groups


def group_table(groups: Groups) -> np.ndarray:
    """(g, 7) for Embedding.group: laws above zero are those of drivers, below zero coordinates (-1: the first)."""
    count = len(groups.kind)
    table = np.zeros((count, 7), np.int64)
    table[:, 0] = groups.kind
    table[:, 1:5] = groups.body
    table[:, 5] = np.maximum(groups.motion, 0)
    table[:, 6] = np.where(groups.motion < 0, -groups.motion - 1, -1)
    welded = table[:, 0] == WELDED
    table[welded, 4] = table[welded, 3]
    return table


def group_numbers(groups: Groups) -> np.ndarray:
    """(g, 20) for Embedding.number."""
    out = np.zeros((len(groups.kind), NUMBERS))
    for row, kind, n in zip(out, groups.kind, groups.number, strict=True):
        numbers = _numbers(int(kind), [float(x) for x in n])
        row[: len(numbers)] = numbers
        row[SIGN] = n[BRANCH[int(kind)]] if int(kind) in BRANCH else 1.0
        row[NEAR] = 0.0
        row[AVOID] = FLOOR
    return out


def _numbers(kind: int, n: list[float]) -> list[float]:
    if kind == DRIVEN:
        return n[:6]
    if kind == WELDED:
        return [*n[:4], *_turn(n[4])]
    if kind == RRR:
        line, first = _line(n[4] - n[2], n[5] - n[3])
        other, second = _line(n[10] - n[8], n[11] - n[9])
        return [*n[:4], *line, *n[6:10], *other, first, first - second, 1.0 / (first * second)]
    if kind == RRP:
        line, first = _line(n[4] - n[2], n[5] - n[3])
        return [*n[:4], *line, *n[6:10], *_turn(n[10]), *n[11:13], first, 1.0 / first]
    if kind == RPR:
        return [*n[:9], *_turn(n[9]), *n[10:12]]
    if kind == YOKE:
        return [*n[:8], *_turn(n[8]), *n[9:11]]
    if kind == PRP:
        return [*n[:4], *_turn(n[4]), *n[5:7], *n[7:11], *_turn(n[11]), *n[12:14]]
    if kind == ROD:
        line, first = _line(n[4] - n[2], n[5] - n[3])
        return [*n[:4], *line, *n[6:9], first]
    return [*n[:4], *_turn(n[4]), *n[5:7]]


def _turn(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)


def _line(x: float, y: float) -> tuple[tuple[float, float], float]:
    square = x * x + y * y
    return (x / square, y / square), square
