"""Rows of cut joints in a tree: their Schur complement, and which of those that repeat each other are in use.

Rows are chosen by pivoted Gram-Schmidt on D^-1/2 Y: next is the one of which most is left, compared with its length if
its bodies were free. So units do not matter, no row in use depends on others more than it must, and none is one that
the tree holds. They are looked at again where a pivot is a small part of its row, or of what it was when they were
chosen: then the row turns away from the freedoms that are left.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.spatial.dynamics.envelope import decompose, solve
from mbsd.spatial.dynamics.tree.arrays import COUNT, FIRST_Z, INVERSE, LEFT
from mbsd.spatial.dynamics.tree.bodies import spread_row
from mbsd.spatial.equations.forces import along_row

NOTHING = 1e-20
"""Square of the part of its freedom that a row must have in the tree; below, it is one that the tree holds."""


@internal
def factor_rows(dyn, ws):
    """Factor S of the rows in use; returns the least part of a row that is its own, or of its first pivot."""
    env = dyn.envelope
    tree = dyn.tree
    low = dyn.factors.low
    spread = dyn.work.spread
    column = dyn.work.column
    for r in range(env.rows.shape[0]):
        row = env.rows[r]
        spread_row(tree, dyn.work, dyn.system, ws, row)
        for c in range(env.first[r], r + 1):
            other = env.rows[c]
            total = 0.0
            for n in range(tree.begin[row], tree.begin[row + 1]):
                b = tree.path[n]
                k = tree.index[b, FIRST_Z] - 3
                for j in range(k, k + tree.index[b, COUNT]):
                    total += spread[row, j] * column[j, INVERSE] * spread[other, j]
            low[r, c] = total
    margin = decompose(env, dyn.factors)
    for r in range(env.rows.shape[0]):
        part = dyn.factors.pivot[r] / dyn.chosen[r]
        if not part >= margin:
            margin = part
    return margin


@internal
def _order_rows(tree, env):
    """Fill where each row in use begins to meet those before it: with a body of the tree in common."""
    for r in range(env.rows.shape[0]):
        row = env.rows[r]
        env.first[r] = r
        for c in range(r - 1, -1, -1):
            other = env.rows[c]
            for n in range(tree.begin[row], tree.begin[row + 1]):
                for i in range(tree.begin[other], tree.begin[other + 1]):
                    if tree.path[n] == tree.path[i]:
                        env.first[r] = c


@internal
def measure_rates(dyn, ws, v, nu, out):
    """Fill out (m,) with J v - nu at rates v (3 + nz,), whose velocities in the world are known."""
    for r in range(out.shape[0]):
        out[r] = along_row(dyn.system, ws, r, dyn.work.rate) - nu[r]
    for n in range(dyn.tree.linear.shape[0]):
        out[dyn.tree.linear[n, 0]] += dyn.tree.factor[n] * v[dyn.tree.linear[n, 1]]


@internal
def answer_rows(dyn, side, lam):
    """Solve S lam = dyn.factors.side, and take Y lam from what is left in columns; lam (m,) takes it."""
    env = dyn.envelope
    column = dyn.work.column
    right = dyn.factors.side
    for r in range(env.rows.shape[0]):
        row = env.rows[r]
        value = right[side, r]
        lam[row] = value
        for k in range(column.shape[0]):
            column[k, LEFT + side] -= value * dyn.work.spread[row, k]


@internal
def hold_rows(dyn, ws, gamma, lam):
    """Fill lam (m,) of the rows in use, and take their pull from what is left in columns.

    gamma (m,) and the velocities in the world of this pose are known, and so are factors.
    """
    env = dyn.envelope
    work = dyn.work
    right = dyn.factors.side
    for r in range(lam.shape[0]):
        lam[r] = 0.0
    for r in range(env.rows.shape[0]):
        row = env.rows[r]
        total = along_row(dyn.system, ws, row, work.bend) - gamma[row]
        for k in range(work.column.shape[0]):
            total += work.spread[row, k] * work.column[k, INVERSE] * work.column[k, LEFT]
        right[0, r] = total
    solve(env, dyn.factors, 1)
    answer_rows(dyn, 0, lam)


@internal
def _free_square(system, ws, row):
    """Return the square of a row, at least, if its bodies were free."""
    total = 0.0
    for side in range(system.row_body.shape[1]):
        b = system.row_body[row, side]
        if b > 0:
            f = ws.jac[row, 6 * side : 6 * side + 6]
            moment = max(system.inertia[b, 0], system.inertia[b, 1], system.inertia[b, 2])
            total += (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) / system.mass[b]
            total += (f[3] * f[3] + f[4] * f[4] + f[5] * f[5]) / moment
    return total


@internal
def choose_rows(dyn, ws):
    """Choose the rows in use at a pose whose columns are factored; returns whether they are other ones than before."""
    work = dyn.work
    own = work.own
    y = work.spread
    used = dyn.envelope.rows
    held = dyn.system.held
    for r in range(held):
        spread_row(dyn.tree, work, dyn.system, ws, r)
        square = 0.0
        for k in range(y.shape[1]):
            y[r, k] *= math.sqrt(work.column[k, INVERSE])
            square += y[r, k] * y[r, k]
        free = max(square, _free_square(dyn.system, ws, r))
        own[0, r] = free if square > NOTHING * free else 0.0
        own[1, r] = square
    for _ in range(used.shape[0]):
        best = -1
        most = 0.0
        for r in range(held):
            if own[0, r] > 0.0 and own[1, r] > most * own[0, r]:
                most = own[1, r] / own[0, r]
                best = r
        if best < 0:
            return False
        size = 0.0
        for k in range(y.shape[1]):
            size += y[best, k] * y[best, k]
        own[0, best] = -1.0
        for r in range(held):
            if own[0, r] > 0.0:
                part = 0.0
                for k in range(y.shape[1]):
                    part += y[r, k] * y[best, k]
                part /= size
                own[1, r] = 0.0
                for k in range(y.shape[1]):
                    y[r, k] -= part * y[best, k]
                    own[1, r] += y[r, k] * y[r, k]
    changed = False
    n = 0
    for r in range(held):
        if own[0, r] < 0.0:
            if used[n] != r:
                changed = True
                used[n] = r
            n += 1
    _order_rows(dyn.tree, dyn.envelope)
    return changed


@lazy(bool)
def renew_rows(dyn, ws):
    """Choose rows at a pose whose columns are factored, and keep their pivots; returns whether they are other ones."""
    changed = choose_rows(dyn, ws)
    factor_rows(dyn, ws)
    for r in range(dyn.chosen.shape[0]):
        dyn.chosen[r] = dyn.factors.pivot[r]
    return changed
