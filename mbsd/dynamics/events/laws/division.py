"""The division of friction among joints at rest that loads none of them more than it must.

Joints p of a basis, as many as there are freedoms, move as they like, and the others with them, at rates

    rate_k = sum_p R_pk rate_p

so that forces T with the same  b_p = T_p + sum_k R_pk T_k  of each p move nothing differently: R are rows of the
compliance G, reduced by rows, and  R d = 0  where  G d = 0, also where G is not symmetric. For parts T_k / s

    largest t   with   T_p / s + sum_k R_pk T_k / s = t b_p,   |T_k| / s <= L_k;      s = 1 / t

by the simplex method with bounds. At its end t stands in one row of R, the motion that gives way first; joints that it
moves carry s L_k, each against its rate, so that by the virtual work of that motion

    s = |b_p| / sum_k |R_pk| L_k

What they carry is settled. Joints which that motion leaves at rest divide what is left of the loads b among them
likewise, with a smaller s, and so on: of all divisions this one has the smallest largest part, then the smallest second
largest part. It is unique, and what decouples is divided by itself.

Source: Chvatal, Linear Programming, ch. 8, with Bland's rule; Prager, An Introduction to Plasticity, for motions
that give way first; Schmeidler 1969, SIAM J. Appl. Math. 17, for what is unique.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import internal, kernel

SINGULAR = 1e-9
"""Eigenvalues and pivots of a compliance, scaled to a diagonal of ones, below this are zero."""
CLEARLY = 2.0
"""An entry off the diagonal is the pivot where it is so many times as large: none is where G is symmetric."""
RESTS = 1e-9
"""Part of the largest rate of a motion below which a joint rests."""
LEAST = 1e-12
"""Part of the largest limit that every joint has at least."""
TINY = 1e-200
UNIT, BOUND, GIVEN, VALUE, LOAD = range(5)
"""Rows of Division.number: the square root of the rate by a unit force; times that, limits, forces that are still to
divide, and forces; b."""
PLACE, OWNER, AT, SETTLED = range(4)
"""Rows of Division.place: the joint; the one that a row of R is of, -1 of none; the bound at which it is, 1, -1 or 0;
whether its force is settled."""


class Division(NamedTuple):
    """Return scratch for n joints."""

    table: Any
    """(n, n)"""
    number: Any
    """(5, n)"""
    place: Any
    """(4, n) int"""


def division_of(n: int) -> Division:
    """Scratch for n joints."""
    return Division(np.zeros((n, n)), np.zeros((LOAD + 1, n)), np.zeros((SETTLED + 1, n), np.int64))


@internal
def _begin(compliance, flags, force, limit, work):
    """List the joints and scale their forces and limits; returns how many."""
    number = work.number
    joint = work.place[PLACE]
    n = 0
    largest = 0.0
    for k in range(flags.shape[0]):
        if flags[k] != 0:
            joint[n] = k
            largest = max(largest, abs(limit[k]))
            n += 1
    for i in range(n):
        k = joint[i]
        number[UNIT, i] = math.sqrt(max(compliance[k, k], 1e-300))
        number[BOUND, i] = max(limit[k], LEAST * largest + TINY) * number[UNIT, i]
        number[GIVEN, i] = force[k] * number[UNIT, i]
        number[VALUE, i] = 0.0
        work.place[SETTLED, i] = 0
    return n


@internal
def _exchange(table, owner, n, row, k):
    """Let joint k be of ``row``, and take it out of all other rows that are of a joint."""
    pivot = table[row, k]
    for j in range(n):
        table[row, j] /= pivot
    for i in range(n):
        part = table[i, k]
        if i != row and owner[i] >= 0 and part != 0.0:
            for j in range(n):
                table[i, j] -= part * table[row, j]
            table[i, k] = 0.0
    owner[row] = k


@internal
def _find_pivot(table, taken, n):
    """Return row and column of a large entry in rows not ``taken`` (n,), -1: none; on the diagonal of a symmetric G."""
    row = -1
    column = -1
    largest = SINGULAR
    for i in range(n):
        if taken[i] == 0 and abs(table[i, i]) >= largest and (row < 0 or abs(table[i, i]) > largest):
            largest = abs(table[i, i])
            row = i
            column = i
    for i in range(n):
        for k in range(n):
            if taken[i] == 0 and abs(table[i, k]) > CLEARLY * largest:
                largest = abs(table[i, k]) / CLEARLY
                row = i
                column = k
    return row, column


@internal
def _find_basis(compliance, work, n):
    """Fill the table with R and find b of what is to divide, by pivots of the compliance; returns how many freedoms."""
    table = work.table
    number = work.number
    joint = work.place[PLACE]
    owner = work.place[OWNER]
    taken = work.place[AT]
    for i in range(n):
        owner[i] = i  # all rows are eliminated
        taken[i] = 0
        for j in range(n):
            table[i, j] = compliance[joint[i], joint[j]] / (number[UNIT, i] * number[UNIT, j])
    rank = 0
    for _ in range(n):
        row, column = _find_pivot(table, taken, n)
        if row < 0:
            break
        _exchange(table, owner, n, row, column)
        taken[row] = 1
        rank += 1
    for i in range(n):
        number[LOAD, i] = 0.0
        if taken[i] == 0:
            owner[i] = -1
            continue
        for k in range(n):
            number[LOAD, i] += table[i, k] * number[GIVEN, k]
    return rank


@internal
def _first(work, n):
    """Raise t from zero to the first limit; returns the row in which it then stands, -1 where nothing loads a joint."""
    table = work.table
    number = work.number
    owner = work.place[OWNER]
    first = -1
    most = 0.0
    for i in range(n):
        if owner[i] >= 0 and abs(number[LOAD, i]) / number[BOUND, owner[i]] > most:
            most = abs(number[LOAD, i]) / number[BOUND, owner[i]]
            first = i
    if first < 0:
        return first
    for k in range(n):
        work.place[AT, k] = 0
        if work.place[SETTLED, k] == 0:
            number[VALUE, k] = 0.0
    leaving = owner[first]
    work.place[AT, leaving] = 1 if number[LOAD, first] > 0.0 else -1
    number[VALUE, leaving] = work.place[AT, leaving] * number[BOUND, leaving]
    owner[first] = -1
    for i in range(n):
        if owner[i] >= 0:
            number[VALUE, owner[i]] = number[LOAD, i] / most
            part = number[LOAD, i] / number[LOAD, first]
            for k in range(n):
                table[i, k] -= part * table[first, k]
    return first


@internal
def _fastest(work, n, first):
    """Return the largest rate of the motion in row ``first``."""
    fastest = 0.0
    for k in range(n):
        if work.place[SETTLED, k] == 0:
            fastest = max(fastest, abs(work.table[first, k]))
    return fastest


@internal
def _against(work, k, first):
    """Return the direction in which the force of joint k raises t."""
    return 1 if work.table[first, k] * work.number[LOAD, first] > 0.0 else -1


@internal
def _entering(work, n, first):
    """Return the first joint whose force raises t further, -1 if there is none."""
    fastest = _fastest(work, n, first)
    for k in range(n):
        moves = work.place[SETTLED, k] == 0 and abs(work.table[first, k]) > RESTS * fastest
        if moves and work.place[AT, k] != _against(work, k, first):
            return k
    return -1


@internal
def _raise(work, n, first, k):
    """Raise the force of joint k until it or another one is at its limit."""
    table = work.table
    number = work.number
    owner = work.place[OWNER]
    way = _against(work, k, first)
    step = number[BOUND, k] - way * number[VALUE, k]
    row = -1
    for i in range(n):
        if owner[i] < 0 or abs(table[i, k]) <= RESTS:
            continue
        slope = -table[i, k] * way
        room = number[BOUND, owner[i]] - math.copysign(1.0, slope) * number[VALUE, owner[i]]
        room = max(room, 0.0) / abs(slope)
        if room < step or (row >= 0 and room == step and owner[i] < owner[row]):
            step = room
            row = i
    for i in range(n):
        if owner[i] >= 0:
            number[VALUE, owner[i]] -= table[i, k] * way * step
    if row < 0:
        work.place[AT, k] = way
        number[VALUE, k] = way * number[BOUND, k]
        return
    number[VALUE, k] += way * step
    work.place[AT, k] = 0
    leaving = owner[row]
    work.place[AT, leaving] = 1 if table[row, k] * way < 0.0 else -1
    number[VALUE, leaving] = work.place[AT, leaving] * number[BOUND, leaving]
    _exchange(table, owner, n, row, k)
    part = table[first, k]
    for j in range(n):
        table[first, j] -= part * table[row, j]
    table[first, k] = 0.0


@internal
def _settle(work, n, first):
    """Settle the forces of the joints that the motion in row ``first`` moves, and what loads the others; returns s."""
    table = work.table
    number = work.number
    settled = work.place[SETTLED]
    fastest = _fastest(work, n, first)
    whole = 0.0
    for k in range(n):
        if settled[k] == 0 and abs(table[first, k]) > RESTS * fastest:
            whole += abs(table[first, k]) * number[BOUND, k]
    part = abs(number[LOAD, first]) / whole
    for i in range(n):
        number[LOAD, i] = 0.0 if i != first else number[LOAD, i]
    for k in range(n):
        if settled[k] != 0 or abs(table[first, k]) <= RESTS * fastest:
            continue
        settled[k] = 1
        number[VALUE, k] = part * _against(work, k, first) * number[BOUND, k]
        for i in range(n):
            if work.place[OWNER, i] >= 0:
                number[LOAD, i] -= table[i, k] * number[VALUE, k]
    return part


@kernel
def divide(compliance, flags, force, limit, work):
    """Divide the friction ``force`` (c,) of the joints in ``flags`` (c,); returns the largest part s of their limits.

    ``compliance`` (c, c): rates by forces, its diagonal positive; ``limit`` (c,); what is not in ``flags`` stays as it
    is. s above 1: they cannot hold.
    """
    number = work.number
    n = _begin(compliance, flags, force, limit, work)
    part = 0.0
    for _ in range(_find_basis(compliance, work, n)):
        first = _first(work, n)
        if first < 0:
            break
        for _ in range(50 * (n + 1)):
            k = _entering(work, n, first)
            if k < 0:
                break
            _raise(work, n, first, k)
        part = max(part, _settle(work, n, first))
    for k in range(n):
        if work.place[SETTLED, k] == 0:
            number[VALUE, k] = 0.0
        number[GIVEN, k] -= number[VALUE, k]
    _find_basis(compliance, work, n)
    for i in range(n):  # what rates below RESTS have left out
        if work.place[OWNER, i] >= 0:
            number[VALUE, work.place[OWNER, i]] += number[LOAD, i]
    for k in range(n):
        force[work.place[PLACE, k]] = number[VALUE, k] / number[UNIT, k]
    return part
