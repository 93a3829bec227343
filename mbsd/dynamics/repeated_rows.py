"""Rows of joints that repeat others, exchanged during a run for rows that are further from dependent.

The equations of motion hold r independent rows of J. Which r does not matter to the motion, but rows that are
independent at the start may become dependent on the way: of three equal cranks the two that are kept can lie flat where
the third does not. Multipliers and rounding grow there without bound, although nothing is singular. So now and then the
rows are chosen anew by pivoted QR of all, and taken where their least singular value is clearly the larger.

Pivoted QR of J^T is here the pivoted Cholesky factor of J J^T, which takes the same rows in the same order; the least
singular value of some rows is the root of the least eigenvalue of their products, found by inverse iteration.

Source: Wehage and Haug 1982, J. Mech. Design 104, 247 (choice by factorisation); Golub and Van Loan, Matrix
Computations, sec. 5.4 (pivoted QR).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import apart, inlined, internal, lazy
from mbsd.dynamics.formulation import measure, push
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.integrators.advance import advance_past_jumps
from mbsd.dynamics.reference.projection import OPENED_BY
from mbsd.dynamics.state import PAUSED, TIME

ROW, BLOCK, SIDE = range(3)
"""Columns of Repeated.place: the row in J, its block and its place there in Schur.rows."""
HELD, OPENED, SCALE, UNTIL = range(4)
"""Columns of Repeated.number: 1 where it holds, 0 where others do in its place, GONE; whether it did not hold once, so
that it might open; what makes its residual dimensionless; when (s) an event of the user released its joint, infinite
while none has."""
GONE = -1.0
"""Its joint is released."""
STEPS, BETTER, FOLLOWS = range(3)
"""Entries of Repeated.clock: steps so far; by what factor other rows must be better; what part of itself a row adds at
least to others from which it does not follow."""


class Repeated(NamedTuple):
    """k rows: all of joints and drivers, in order."""

    place: Any
    """(k, 3) int"""
    number: Any
    """(k, 4)"""
    clock: Any
    """(3,)"""
    size: Any
    """(3 nb,) of a unit step of each coordinate; 0 of ground."""
    jac: Any
    """(k, 3 nb) dimensionless."""
    gram: Any
    """(k, k) products of its rows."""
    factor: Any
    """(k, k) Cholesky factor of those of some rows, in their order."""
    whole: Any
    """(k, k) the same of all rows, while some are chosen."""
    left: Any
    """(2, k) squares of what rows chosen before leave of each; a vector."""
    order: Any
    """(2, k) int, rows in the order of a factor."""


LOOK = 10
"""Steps between two looks at which rows hold."""
TURNS = 40
"""Turns of inverse iteration."""


@internal
def hold_independent(dyn, repeated):
    """Let the rows hold that should."""
    for i in range(repeated.place.shape[0]):
        held = repeated.number[i, HELD] > 0.0
        dyn.schur.rows[repeated.place[i, BLOCK], repeated.place[i, SIDE]] = repeated.place[i, ROW] if held else -1


@apart
def find_rows(dyn, scratch, repeated, t, q):
    """Fill jac at q (3 nb,) and t (s)."""
    measure(dyn, scratch, t, q)
    jac = repeated.jac
    size = repeated.size
    for i in range(jac.shape[0]):
        row = repeated.place[i, ROW]
        for c in range(jac.shape[1]):
            jac[i, c] = 0.0
        push(dyn, scratch, row, repeated.number[i, SCALE], jac[i])
        for c in range(jac.shape[1]):
            jac[i, c] *= size[c]


@apart
def _find_products(dyn, scratch, repeated, t, q):
    """Fill jac and gram at q (3 nb,)."""
    find_rows(dyn, scratch, repeated, t, q)
    jac = repeated.jac
    for i in range(jac.shape[0]):
        for j in range(i + 1):
            product = 0.0
            for c in range(jac.shape[1]):
                product += jac[i, c] * jac[j, c]
            repeated.gram[i, j] = product
            repeated.gram[j, i] = product


@internal
def _add_row(repeated, order, n, i):
    """Make row i the n-th of the factor; returns False where it follows from those before."""
    gram = repeated.gram
    factor = repeated.factor
    order[n] = i
    for m in range(n):
        value = gram[i, order[m]]
        for k in range(m):
            value -= factor[n, k] * factor[m, k]
        factor[n, m] = value / factor[m, m]
    own = gram[i, i]
    for m in range(n):
        own -= factor[n, m] ** 2
    if not own > 0.0:
        return False
    factor[n, n] = math.sqrt(own)
    return True


@apart
def _least(repeated, count):
    """The least eigenvalue of the products of the first ``count`` rows of the factor."""
    factor = repeated.factor
    x = repeated.left[1]
    for n in range(count):
        x[n] = 1.0 + 0.1 * math.sin(3.0 * n)
    least = 0.0
    for _ in range(TURNS):
        size = 0.0
        for n in range(count):
            size += x[n] * x[n]
        size = math.sqrt(size)
        for n in range(count):
            x[n] /= size
        for n in range(count):
            for m in range(n):
                x[n] -= factor[n, m] * x[m]
            x[n] /= factor[n, n]
        under = 0.0  # of the unit vector before: x^T A^-1 x
        for n in range(count):
            under += x[n] * x[n]
        for n in range(count - 1, -1, -1):
            for m in range(n + 1, count):
                x[n] -= factor[m, n] * x[m]
            x[n] /= factor[n, n]
        least = 1.0 / under
    return least


@apart
def _choose(repeated, count):
    """Put ``count`` rows furthest from dependent in order[1], with their factor; whether there are so many."""
    order = repeated.order[1]
    left = repeated.left[0]
    whole = repeated.whole
    rows = repeated.place.shape[0]
    for i in range(rows):
        left[i] = repeated.gram[i, i] if repeated.number[i, HELD] != GONE else -1.0
    for n in range(count):
        best = -1
        for i in range(rows):
            if left[i] > 0.0 and (best < 0 or left[i] > left[best]):
                best = i
        if best < 0:
            return False
        order[n] = best
        whole[best, n] = math.sqrt(left[best])
        left[best] = -1.0
        for i in range(rows):
            if left[i] < 0.0:
                continue
            value = repeated.gram[i, best]
            for m in range(n):
                value -= whole[i, m] * whole[best, m]
            whole[i, n] = value / whole[best, n]
            left[i] = max(left[i] - whole[i, n] ** 2, 0.0)
    for n in range(count):
        for m in range(n + 1):
            repeated.factor[n, m] = whole[order[n], m]
    return True


@apart
def _exchange(dyn, scratch, repeated, t, q):
    """Hold other rows at q (3 nb,) and t (s) where they are clearly further from dependent."""
    _find_products(dyn, scratch, repeated, t, q)
    rows = repeated.place.shape[0]
    number = repeated.number
    count = 0
    independent = True
    for i in range(rows):
        if number[i, HELD] > 0.0:
            independent = independent and _add_row(repeated, repeated.order[0], count, i)
            count += 1
    least = _least(repeated, count) if independent else 0.0
    if not _choose(repeated, count) or not _least(repeated, count) > repeated.clock[BETTER] ** 2 * least:
        return
    for i in range(rows):
        if number[i, HELD] > 0.0:
            number[i, HELD] = 0.0
            number[i, OPENED] = 2.0
    for n in range(count):
        i = repeated.order[1, n]
        number[i, HELD] = 1.0
        if number[i, OPENED] == 2.0:
            number[i, OPENED] = 0.0
    for i in range(rows):
        number[i, OPENED] = min(number[i, OPENED], 1.0)
    hold_independent(dyn, repeated)


@internal
def _any_spare(repeated):
    """Return True if a row could hold that does not."""
    spare = False
    for i in range(repeated.place.shape[0]):
        spare = spare or repeated.number[i, HELD] == 0.0
    return spare


@lazy(None)
def look(dyn, scratch, repeated, state, steps):
    """Exchange rows if it is time to and some repeat others, before so many steps are taken."""
    if repeated.clock[STEPS] % LOOK == 0.0 and _any_spare(repeated):
        _exchange(dyn, scratch, repeated, state.clock[TIME], state.y[0])
    repeated.clock[STEPS] += steps


@lazy(bool)
def _opens(dyn, scratch, repeated, out, first, end):
    """Return True if a row that did not hold once is open in one of the outputs ``first`` to ``end`` (left out)."""
    open_now = False
    for k in range(first, end):
        measure(dyn, scratch, out.t[k], out.y[k, 0])
        for i in range(repeated.place.shape[0]):
            if repeated.number[i, OPENED] > 0.0 and out.t[k] <= repeated.number[i, UNTIL]:
                gap = abs(scratch.ws.phi[repeated.place[i, ROW]] * repeated.number[i, SCALE])
                open_now = open_now or not gap <= OPENED_BY
    return open_now


@lazy(int)
def _again(dyn, scratch, state, out, settings, repeated, end, steps, before, after, method):
    """``advance_past_jumps``, with a look at the rows now and then."""
    hold_independent(dyn, repeated)
    status = PAUSED
    taken = 0
    while status == PAUSED and taken < steps:
        some = min(steps - taken, LOOK - int(repeated.clock[STEPS]) % LOOK)
        look(dyn, scratch, repeated, state, some)
        status = advance_past_jumps(dyn, scratch, state, out, settings, end, some, before, after, method)
        taken += some
    return status


@inlined
def _no_row_opens(dyn, scratch, repeated, out, first, end):
    return False


@inlined
def _never(dyn, scratch, state, out, settings, repeated, end, steps, before, after, method):
    return PAUSED


again = alternatives({Embedding: _never}, _again)
"""``advance_past_jumps``, with a look at the rows now and then; never in independent coordinates."""
opens = alternatives({Embedding: _no_row_opens}, _opens)
"""True if a row that did not hold once is open in one of the outputs ``first`` to ``end`` (left out)."""


@internal
def _adds(repeated, i, count):
    """Return True if row i of jac adds to the ``count`` rows of order[0]; it becomes what it adds, of length 1.

    Gram-Schmidt, done twice for rounding.
    """
    jac = repeated.jac
    columns = jac.shape[1]
    for turn in range(3):
        length = 0.0
        for c in range(columns):
            length += jac[i, c] * jac[i, c]
        length = math.sqrt(length)
        if not length > (repeated.clock[FOLLOWS] if turn > 0 else 0.0):
            return False
        if turn != 1:
            for c in range(columns):
                jac[i, c] /= length
        if turn == 2:
            break
        for n in range(count):
            other = repeated.order[0, n]
            part = 0.0
            for c in range(columns):
                part += jac[i, c] * jac[other, c]
            for c in range(columns):
                jac[i, c] -= part * jac[other, c]
    return True


@lazy(None)
def take_over(dyn, scratch, repeated, t, q):
    """Hold the rows at q (3 nb,) and t (s) that do not follow from those that hold; jac is overwritten."""
    find_rows(dyn, scratch, repeated, t, q)
    count = 0
    for spare in range(2):
        for i in range(repeated.place.shape[0]):
            if repeated.number[i, HELD] == 1.0 - spare and _adds(repeated, i, count):
                repeated.order[0, count] = i
                count += 1
                repeated.number[i, HELD] = 2.0
    for i in range(repeated.place.shape[0]):
        if repeated.number[i, HELD] == 2.0:
            repeated.number[i, HELD] = 1.0
    hold_independent(dyn, repeated)
