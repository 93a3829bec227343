"""Ways that give way: all that is at rest has come to its limit, and no forces hold it.

Bodies at rest may hold each other by forces that no longer act once they move: pressed with those they could hold as
if they moved, and the other way round. So ways are taken to move as they did in the last try that moved any, with

    T = -s (mu N + L)  of a way that moves with the sign s,   G (N, T) + g = 0  of gaps that push and ways at rest

If what comes out moves just so, they give way. Forces that are not determined are the smallest ones.

Source: Golub and Van Loan, Matrix Computations, sec. 8.6 (singular values by Jacobi's rotations of columns).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.arrays import FORCE, FREE, GIVES, HOLDING, LIMIT, PUSH, RESTING, TAKING
from mbsd.dynamics.events.bounds import AT_LIMIT
from mbsd.dynamics.events.friction.decisions import acceleration_of, left_of
from mbsd.dynamics.events.rows import gaps_of

SWEEPS = 30
"""Sweeps of rotations at most."""
ORTHOGONAL = 1e-15
DEPENDENT = 1e-12
"""Part of the largest singular value below which one is zero."""


@internal
def begin_giving(contacts):
    """Let no way give way yet."""
    for k in range(contacts.place.shape[0]):
        contacts.sticks.vector[GIVES, k] = 0.0


@internal
def may_give(contacts):
    """Return True if a way moved in some try."""
    moves = False
    for k in range(gaps_of(contacts), contacts.place.shape[0]):
        moves = moves or contacts.sticks.vector[GIVES, k] != 0.0
    return moves


@internal
def keep_pushes(contacts):
    """Keep normal forces before they are shared."""
    for k in range(gaps_of(contacts)):
        contacts.vector[PUSH, k] = contacts.sticks.vector[FORCE, k]


@internal
def _limit_of(contacts, k, pushes):
    """Return the limit of friction of a way at rest under normal forces ``pushes`` (c,)."""
    gaps = gaps_of(contacts)
    if contacts.chosen[RESTING, k] != 0:
        return contacts.sticks.vector[LIMIT, k]
    return contacts.friction.number[k - gaps, HOLDING] * pushes[contacts.friction.gap[k - gaps]]


@internal
def note_giving(contacts, rounding):
    """Note which ways move under vector[FORCE], and which gaps push, if any way moves."""
    gaps = gaps_of(contacts)
    gives = contacts.sticks.vector[GIVES]
    force = contacts.sticks.vector[FORCE]
    taking = contacts.chosen[TAKING]
    moves = False
    for k in range(gaps, taking.shape[0]):
        if taking[k] != 0:
            limit = _limit_of(contacts, k, contacts.vector[PUSH])
            moves = moves or left_of(contacts, force, k, limit, rounding) != 0.0
    if not moves:
        return
    for k in range(taking.shape[0]):
        gives[k] = 0.0
        if taking[k] != 0 and k < gaps:
            gives[k] = 1.0 if contacts.vector[PUSH, k] > 0.0 else 0.0
        elif taking[k] != 0:
            left = left_of(contacts, force, k, _limit_of(contacts, k, contacts.vector[PUSH]), rounding)
            gives[k] = math.copysign(1.0, left) if left != 0.0 else 0.0


@lazy(None)
def solve_giving(contacts):
    """Fill vector[FORCE] with N and T where ways give way as GIVES says."""
    gaps = gaps_of(contacts)
    gives = contacts.sticks.vector[GIVES]
    force = contacts.sticks.vector[FORCE]
    limit = contacts.sticks.vector[LIMIT]
    taking = contacts.chosen[TAKING]
    friction = contacts.friction
    compliance = friction.compliance
    table = contacts.tableau
    places = contacts.basis[1]
    n = 0
    for k in range(taking.shape[0]):
        force[k] = 0.0
        if taking[k] == 0:
            continue
        if (k < gaps) == (gives[k] != 0.0):
            places[n] = k
            n += 1
        elif k >= gaps and contacts.chosen[RESTING, k] != 0:
            force[k] = -gives[k] * limit[k]
    last = 2 * n
    for i in range(n):
        row = places[i]
        right = -contacts.vector[FREE, row]
        for k in range(gaps, taking.shape[0]):
            right -= compliance[row, k] * force[k]
        table[i, last] = right
        for j in range(n):
            k = places[j]
            value = compliance[row, k]
            for w in range(friction.gap.shape[0]):
                p = gaps + w
                if friction.gap[w] == k and taking[p] != 0 and gives[p] != 0.0:
                    value -= compliance[row, p] * gives[p] * friction.number[w, HOLDING]
            table[i, j] = value
            table[i, n + j] = 1.0 if i == j else 0.0
    solve_least(table, n)
    for i in range(n):
        force[places[i]] = table[i, last + 1]
    for w in range(friction.gap.shape[0]):
        p = gaps + w
        if taking[p] != 0 and gives[p] != 0.0:
            force[p] = -gives[p] * friction.number[w, HOLDING] * force[friction.gap[w]]


@lazy(None)
def solve_least(table, n):
    """Put the shortest x with least |A x - b| in column 2 n + 1 of a table (n, 2 n + 2) of A, a unit matrix and b."""
    for _ in range(SWEEPS):
        rotated = False
        for p in range(n):
            for q in range(p + 1, n):
                a = 0.0
                b = 0.0
                c = 0.0
                for i in range(n):
                    a += table[i, p] * table[i, p]
                    b += table[i, q] * table[i, q]
                    c += table[i, p] * table[i, q]
                if abs(c) <= ORTHOGONAL * math.sqrt(a * b):
                    continue
                rotated = True
                zeta = (b - a) / (2.0 * c)
                tangent = math.copysign(1.0, zeta) / (abs(zeta) + math.sqrt(1.0 + zeta * zeta))
                cosine = 1.0 / math.sqrt(1.0 + tangent * tangent)
                sine = cosine * tangent
                for i in range(n):
                    for first in range(0, 2 * n, n):
                        left = table[i, first + p]
                        right = table[i, first + q]
                        table[i, first + p] = cosine * left - sine * right
                        table[i, first + q] = sine * left + cosine * right
        if not rotated:
            break
    largest = 0.0
    for j in range(n):
        square = 0.0
        for i in range(n):
            square += table[i, j] * table[i, j]
        largest = max(largest, square)
    for i in range(n):
        table[i, 2 * n + 1] = 0.0
    for j in range(n):
        square = 0.0
        along = 0.0
        for i in range(n):
            square += table[i, j] * table[i, j]
            along += table[i, j] * table[i, 2 * n]
        if square > DEPENDENT**2 * largest:
            for i in range(n):
                table[i, 2 * n + 1] += table[i, n + j] * along / square


@internal
def gives_way(contacts, rounding):
    """Return True if ways under vector[FORCE] move as GIVES says, and contacts push or open."""
    gaps = gaps_of(contacts)
    gives = contacts.sticks.vector[GIVES]
    force = contacts.sticks.vector[FORCE]
    taking = contacts.chosen[TAKING]
    agrees = True
    for k in range(taking.shape[0]):
        if taking[k] == 0:
            continue
        if k < gaps:
            bend = acceleration_of(contacts, contacts.friction.compliance, force, k)[0]
            agrees = agrees and force[k] >= 0.0 and (gives[k] != 0.0 or bend >= 0.0)
            continue
        most = _limit_of(contacts, k, force)
        left = left_of(contacts, force, k, most, rounding)
        sign = math.copysign(1.0, left) if left != 0.0 else 0.0
        agrees = agrees and sign == gives[k] and abs(force[k]) <= most * (1.0 + AT_LIMIT)
    return agrees
