"""How contacts push at a pose: changes of velocities by their impulses, and the impulses that keep gaps from closing.

    0 <= N complementary to  G N + g >= 0,    G = J_g W^-1 J_g^T with joints and drivers holding

by Lemke's method: z >= 0, w = M z + q >= 0, z w = 0. Ties of the ratio test are broken lexicographically, so that it
cannot cycle.

Source: Cottle, Pang, Stone, The Linear Complementarity Problem, ch. 4.4 and 4.9.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import ALONE, NORMAL, ROW, TAKING
from mbsd.dynamics.formulation import along, push, respond

STIFF = 1e-12
"""Compliance of a row, as part of that of its bodies alone, below which nothing gives way."""
TIE = 1e-14
GONE = 1e-13
"""Part of the largest number below which the artificial variable is zero; it may stay where forces share a load."""
SMALL = 1e-11
"""Pivots below this are none; M and q are of order 1."""


@apart
def find_answer(dyn, scratch, contacts, k, lam):
    """Fill answer[k], the change of velocities by a unit impulse of row k, and vector[ALONE] without joints.

    lam (m,) takes the multipliers. Factors and scratch.ws.jac are those of the pose, with all contacts released.
    """
    n3 = dyn.inverse.shape[0]
    force = contacts.force
    row = contacts.place[k, ROW]
    for c in range(n3):
        force[c] = 0.0
    push(dyn, scratch, row, 1.0, force)
    alone = 0.0
    for c in range(3, n3):
        alone += dyn.inverse[c] * force[c] ** 2
    contacts.vector[ALONE, k] = alone if alone > 0.0 else 1.0
    respond(dyn, scratch, force, 0.0, contacts.answer[k], lam)


@internal
def find_compliance(dyn, scratch, contacts, flags):
    """Fill answer and compliance of the contacts in ``flags`` (c,)."""
    count = contacts.place.shape[0]
    for k in range(count):
        if flags[k] != 0:
            find_answer(dyn, scratch, contacts, k, scratch.multipliers)
    read_compliance(dyn, scratch, contacts, flags)


@internal
def read_compliance(dyn, scratch, contacts, flags):
    """Fill compliance of the rows in ``flags`` (c,), whose answers are there."""
    count = contacts.place.shape[0]
    for k in range(count):
        for j in range(count):
            if flags[k] != 0 and flags[j] != 0:
                row = contacts.place[j, ROW]
                contacts.compliance[j, k] = along(dyn, scratch, row, contacts.answer[k])


@apart
def solve_pushes(contacts, rates):
    """Fill vector[NORMAL] with N of the contacts in chosen[TAKING], for the rates (c,) without N; 0 of others.

    Returns False where nothing gives way, or no N is possible.
    """
    taking = contacts.chosen[TAKING]
    alone = contacts.vector[ALONE]
    normal = contacts.vector[NORMAL]
    tableau = contacts.tableau
    places = contacts.basis[1]
    n = 0
    size = 0.0
    fastest = 0.0
    for k in range(taking.shape[0]):
        normal[k] = 0.0
        if taking[k] == 0:
            continue
        if not contacts.compliance[k, k] > STIFF * alone[k]:
            return False
        size = max(size, contacts.compliance[k, k] / alone[k])
        fastest = max(fastest, abs(rates[k]) / math.sqrt(alone[k]))
        places[n] = k
        n += 1
    if fastest == 0.0:
        fastest = 1.0
    for i in range(n):
        unit = 1.0 / math.sqrt(alone[places[i]])
        for j in range(n):
            tableau[i, j] = 1.0 if i == j else 0.0
            other = 1.0 / math.sqrt(alone[places[j]])
            tableau[i, n + j] = -contacts.compliance[places[i], places[j]] * unit * other / size
        tableau[i, 2 * n] = -1.0
        tableau[i, 2 * n + 1] = rates[places[i]] * unit / fastest
    lowest = lowest_row(tableau, n)
    if lowest < 0:
        return True
    if not pivot_to_end(tableau, contacts.basis[0], n, lowest):
        return False
    for i in range(n):
        variable = contacts.basis[0, i]
        if n <= variable < 2 * n:
            k = places[variable - n]
            normal[k] = max(tableau[i, 2 * n + 1], 0.0) * fastest / size / math.sqrt(alone[k])
    return True


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
        pivot = tableau[row, entering]
        for c in range(last + 1):
            tableau[row, c] /= pivot
        for i in range(n):
            part = tableau[i, entering]
            if i != row and part != 0.0:
                for c in range(last + 1):
                    tableau[i, c] -= part * tableau[row, c]
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
