"""Normal forces of contacts and friction of joints at rest, by Lemke's method.

    0 <= N complementary to g + G_n N + G_nt T >= 0;    |T| <= L, and the way rests or goes against T

The matrix is that of events/laws/complementarity.py.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.many.contacts.arrays import ALONE, FORCE, FREE, KIND, LIMIT, TAKING, WAY
from mbsd.dynamics.many.contacts.pushes import STIFF, pivot_to_end


@internal
def _listed(contacts):
    """List the rows in chosen[TAKING], gaps first, in basis[1]; returns how many gaps and ways there are."""
    places = contacts.sticks.basis[1]
    gaps = 0
    taken = 0
    for ways in range(2):
        for k in range(contacts.place.shape[0]):
            if contacts.chosen[TAKING, k] != 0 and (contacts.place[k, KIND] == WAY) == (ways == 1):
                places[taken] = k
                taken += 1
        if ways == 0:
            gaps = taken
    return gaps, taken - gaps


@internal
def _put(tableau, i, n, column, value):
    """Put an entry of the matrix into the tableau, which holds its negative."""
    tableau[i, n + column] = -value


@internal
def _fill(contacts, c, k, size, fastest):
    """Fill the tableau; returns its row of the least right-hand side, -1 if none is negative."""
    tableau = contacts.sticks.tableau
    places = contacts.sticks.basis[1]
    alone = contacts.vector[ALONE]
    n = c + 3 * k
    for i in range(n):
        for j in range(2 * n):
            tableau[i, j] = 1.0 if i == j else 0.0
        tableau[i, 2 * n] = -1.0
    for a in range(c + k):
        unit = 1.0 / math.sqrt(alone[places[a]])
        b = contacts.vector[FREE, places[a]] * unit / fastest
        tableau[a, 2 * n + 1] = b
        if a >= c:
            slack = a + 2 * k
            tableau[a + k, 2 * n + 1] = -b
            tableau[slack, 2 * n + 1] = contacts.sticks.vector[LIMIT, places[a]] / unit * size / fastest
            _put(tableau, a, n, slack, 1.0)
            _put(tableau, a + k, n, slack, 1.0)
            _put(tableau, slack, n, a, -1.0)
            _put(tableau, slack, n, a + k, -1.0)
        for other in range(c + k):
            g = contacts.compliance[places[a], places[other]] * unit / math.sqrt(alone[places[other]]) / size
            _put(tableau, a, n, other, g)
            if a >= c:
                _put(tableau, a + k, n, other, -g)
            if other >= c:
                _put(tableau, a, n, other + k, -g)
                if a >= c:
                    _put(tableau, a + k, n, other + k, g)
    lowest = 0
    for i in range(1, n):
        if tableau[i, 2 * n + 1] < tableau[lowest, 2 * n + 1]:
            lowest = i
    return lowest if tableau[lowest, 2 * n + 1] < 0.0 else -1


@apart
def solve_forces(contacts):
    """Fill sticks.vector[FORCE] with N and T of the rows in chosen[TAKING]; vector[FREE]: accelerations without them.

    Returns False where nothing gives way to a contact, or no N and T are possible.
    """
    places = contacts.sticks.basis[1]
    alone = contacts.vector[ALONE]
    force = contacts.sticks.vector[FORCE]
    c, k = _listed(contacts)
    size = 0.0
    fastest = 0.0
    for a in range(c + k):
        row = places[a]
        if a < c and not contacts.compliance[row, row] > STIFF * alone[row]:
            return False
        size = max(size, abs(contacts.compliance[row, row]) / alone[row])
        fastest = max(fastest, abs(contacts.vector[FREE, row]) / math.sqrt(alone[row]))
    if size == 0.0:
        size = 1.0
    if fastest == 0.0:
        fastest = 1.0
    for row in range(force.shape[0]):
        force[row] = 0.0
    if c + k == 0:
        return True
    lowest = _fill(contacts, c, k, size, fastest)
    if lowest < 0:
        return True
    n = c + 3 * k
    tableau = contacts.sticks.tableau
    if not pivot_to_end(tableau, contacts.sticks.basis[0], n, lowest):
        return False
    for i in range(n):
        variable = contacts.sticks.basis[0, i] - n
        if 0 <= variable < c + 2 * k:
            value = max(tableau[i, 2 * n + 1], 0.0) * fastest / size
            row = places[variable if variable < c + k else variable - k]
            force[row] += (value if variable < c + k else -value) / math.sqrt(alone[row])
    return True
