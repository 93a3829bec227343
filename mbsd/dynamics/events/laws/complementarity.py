"""Linear complementarity problems, as of contacts that push so that their gaps do not close:

    w = M z + q >= 0,   z >= 0,   w z = 0            of contacts: z impulses, w rates,  M = J W^-1 J^T

by Lemke's method. Ties of the ratio test are broken lexicographically, so that it cannot cycle.

Source: Cottle, Pang, Stone, The Linear Complementarity Problem, ch. 4.4 and 4.9.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal

TIE = 1e-14
GONE = 1e-13
"""Part of the largest number below which the artificial variable is zero; it may stay where forces share a load."""
SMALL = 1e-11
"""Pivots below this are none; M and q are of order 1."""


@internal
def pivot(table, rows, last, row, column):
    """Divide a row of a table by its entry in a column, and take it off the other ``rows`` there, up to column last."""
    factor = table[row, column]
    for j in range(last + 1):
        table[row, j] /= factor
    for i in range(rows):
        part = table[i, column]
        if i != row and part != 0.0:
            for j in range(last + 1):
                table[i, j] -= part * table[row, j]
            table[i, column] = 0.0


@internal
def lowest_row(tableau, n):
    """Return the row of a tableau (n, 2 n + 2) with the lowest right-hand side; -1 where none is negative."""
    lowest = -1
    least = 0.0
    for i in range(n):
        if tableau[i, 2 * n + 1] < least:
            least = tableau[i, 2 * n + 1]
            lowest = i
    return lowest


@internal
def pivot_to_end(tableau, basis, n, row):
    """Pivot a tableau (n, 2 n + 2) to the end, the artificial variable entering at ``row``; True if it leaves."""
    last = 2 * n + 1
    entering = 2 * n
    for i in range(n):
        basis[i] = i
    for _ in range(50 * (n + 1)):
        pivot(tableau, n, last, row, entering)
        leaving = basis[row]
        basis[row] = entering
        largest = 0.0
        artificial = 0.0
        for i in range(n):
            largest = max(largest, abs(tableau[i, last]))
            if basis[i] == 2 * n:
                artificial = tableau[i, last]
        if leaving == 2 * n or artificial <= GONE * largest:
            return True
        entering = leaving + n if leaving < n else leaving - n
        row = _leaving_row(tableau, basis, n, entering)
        if row < 0:
            return False
    return False


@internal
def _leaving_row(tableau, basis, n, entering):
    """Return the row of the least ratio, ties broken lexicographically; -1 if there is none."""
    left = 0
    chosen = -1
    for i in range(n):
        if tableau[i, entering] > SMALL:
            left += 1
            chosen = i
    if left <= 1:
        return chosen
    # rows out of the race are marked by their basis, shifted beyond all variables
    shift = 4 * n
    for i in range(n):
        if not tableau[i, entering] > SMALL:
            basis[i] += shift
    for step in range(n + 1):
        column = 2 * n + 1 if step == 0 else step - 1
        least = math.inf
        for i in range(n):
            if basis[i] < shift:
                least = min(least, tableau[i, column] / tableau[i, entering])
        left = 0
        artificial = -1
        for i in range(n):
            if basis[i] >= shift:
                continue
            if tableau[i, column] / tableau[i, entering] <= least + TIE * max(1.0, abs(least)):
                left += 1
                if basis[i] == 2 * n:
                    artificial = i
            else:
                basis[i] += shift
        if left == 1 or (step == 0 and artificial >= 0):
            break
    chosen = -1
    for i in range(n):
        if basis[i] < shift:
            if chosen < 0 or basis[i] == 2 * n:
                chosen = i
        else:
            basis[i] -= shift
    return chosen
