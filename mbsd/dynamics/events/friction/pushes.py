"""Normal forces and friction of closed contacts and of joints that stick, as a linear complementarity problem.

In accelerations, or in velocities for impulses; without N and T gaps open with g, ways go on with s:

    0 <= N complementary to g + G_n N + G_nt T >= 0;    |T| <= mu N + L, and the way rests or goes against T

in N, T = T+ - T-, and the slack l of the friction limit:

    w  = G_n N + G_nt T + g                  w+ = G_tn N + G_t T + l + s
    w_l = mu N + L - T+ - T-                 w- = -(G_tn N + G_t T) + l - s

L is the limit of friction of a joint, whose normal force is none of N.

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 5; Stewart, Trinkle 1996, Int. J. Numer.
Meth. Eng. 39.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.dynamics.events.arrays import ALONE, BESIDE, LIMIT, TAKING
from mbsd.dynamics.events.pushes import STIFF, lowest_row, pivot_to_end
from mbsd.dynamics.events.rows import gaps_of


@lazy(bool)
def solve_with_friction(contacts, compliance, rates, coefficient, out):
    """Fill out (c,) with N of the gaps and T of the ways in chosen[TAKING], 0 of others.

    ``compliance`` (c, c) and ``rates`` (c,) are those without N and T; ``coefficient`` is the column of Friction.number
    with mu. L stands in its BESIDE, of joints in LIMIT. Returns False where nothing gives way, or no N and T are
    possible.
    """
    taking = contacts.chosen[TAKING]
    alone = contacts.vector[ALONE]
    tableau = contacts.tableau
    places = contacts.basis[1]
    friction = contacts.friction
    rows = taking.shape[0]
    gaps = gaps_of(contacts)
    joints = rows - contacts.sticks.joint.shape[0]
    both = 0
    first = 0
    size = 0.0
    fastest = 0.0
    for p in range(rows):
        out[p] = 0.0
        if taking[p] == 0:
            continue
        if p < gaps and not compliance[p, p] > STIFF * alone[p]:
            return False
        size = max(size, abs(compliance[p, p]) / alone[p])
        fastest = max(fastest, abs(rates[p]) / math.sqrt(alone[p]))
        places[both] = p
        both += 1
        if p < gaps:
            first = both
    if size == 0.0:
        size = 1.0
    if fastest == 0.0:
        fastest = 1.0
    ways = both - first
    n = first + 3 * ways
    last = 2 * n + 1
    for i in range(n):
        for j in range(last):
            tableau[i, j] = 0.0
        tableau[i, i] = 1.0
        tableau[i, 2 * n] = -1.0
    for i in range(both):
        unit = 1.0 / math.sqrt(alone[places[i]])
        rate = rates[places[i]] * unit / fastest
        tableau[i, last] = rate
        if i >= first:
            tableau[i + ways, last] = -rate
        for j in range(both):
            value = compliance[places[i], places[j]] * unit / math.sqrt(alone[places[j]]) / size
            tableau[i, n + j] = -value
            if j >= first:
                tableau[i, n + j + ways] = value
            if i >= first:
                tableau[i + ways, n + j] = value
                if j >= first:
                    tableau[i + ways, n + j + ways] = -value
    for k in range(ways):
        way = places[first + k]
        unit = 1.0 / math.sqrt(alone[way])
        slack = first + 2 * ways + k
        tableau[first + k, n + slack] = -1.0
        tableau[first + ways + k, n + slack] = -1.0
        tableau[slack, n + first + k] = 1.0
        tableau[slack, n + first + ways + k] = 1.0
        if way >= joints:
            tableau[slack, last] = contacts.sticks.vector[LIMIT, way] / unit * size / fastest
            continue
        number = friction.number[way - gaps]
        tableau[slack, last] = number[BESIDE] / unit * size / fastest
        for j in range(first):
            if places[j] == friction.gap[way - gaps]:
                tableau[slack, n + j] = -number[coefficient] / unit / math.sqrt(alone[places[j]])
    lowest = lowest_row(tableau, n)
    if lowest < 0:
        return True
    if not pivot_to_end(tableau, contacts.basis[0], n, lowest):
        return False
    for i in range(n):
        variable = contacts.basis[0, i] - n
        if not 0 <= variable < first + 2 * ways:
            continue
        value = max(tableau[i, last], 0.0) * fastest / size
        back = variable >= both
        p = places[variable - ways] if back else places[variable]
        out[p] += (-value if back else value) / math.sqrt(alone[p])
    return True
