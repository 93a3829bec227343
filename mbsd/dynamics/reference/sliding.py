"""Coulomb friction of sliding contacts: forces in proportion to normal forces that they change themselves.

    friction on the way s_k:  T_k = -f_k N_k,   f_k = mu_k sign(s_k'),   N_k = -lam of the gap's row

Without friction the motion is (a, lam); the friction of N_k = 1 alone gives (a_k, lam_k). Everything is linear:

    N_j = -lam[j] - sum_k lam_k[j] N_k          a += sum_k a_k N_k,   lam += sum_k lam_k N_k

so a small system, one row a sliding contact, gives the exact forces without iteration. The multiplier of the way's row
is set to f_k N_k: J^T lam then holds the friction too. Where friction of joints changes lam, it is done again, with
what is already in (a, lam) taken off.

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 4 and 5.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import lazy
from mbsd.dynamics.reference.projection import along, push
from mbsd.dynamics.reference.refinement import respond
from mbsd.equations.products import eliminate


class Sliding(NamedTuple):
    """Contacts with friction; arrays of one thread. Two, because handing over many costs time in every evaluation."""

    rows: Any
    """(c, 2) rows of gap and way in J."""
    table: Any
    """(c, 1 + 6 nb + m + c + 2) f_k, which is 0 while the contact does not slide; then scratch: force and a_k (3 nb
    each), lam_k (m), a row of the small system (c + 1), the N_k whose friction (a, lam) hold."""


def sliding_for(rows: np.ndarray, coordinates: int, multipliers: int) -> Sliding:
    """Contacts with friction by their rows (c, 2), none of them sliding."""
    count = len(rows)
    width = 1 + 2 * coordinates + multipliers + count + 2
    return Sliding(np.asarray(rows, np.int64).reshape(-1, 2), np.zeros((count, width)))


@lazy(None)
def begin_sliding(dyn, scratch):
    """Find (a_k, lam_k) of every sliding contact at the pose of the factors; the friction of none is applied yet."""
    table = dyn.sliding.table
    n3 = dyn.inertia.shape[0]
    at_a = 1 + n3
    at_lam = at_a + n3
    at_matrix = table.shape[1] - table.shape[0] - 2
    for k in range(table.shape[0]):
        table[k, table.shape[1] - 1] = 0.0
        if table[k, 0] == 0.0:
            continue
        force = table[k, 1:at_a]
        own_a = table[k, at_a:at_lam]
        own_lam = table[k, at_lam:at_matrix]
        way = dyn.sliding.rows[k, 1]
        for c in range(n3):
            force[c] = 0.0
        push(dyn, scratch, way, -table[k, 0], force)
        respond(dyn, scratch, force, 0.0, own_a, own_lam)


@lazy(float)
def slide(dyn, scratch, v, a, lam):
    """Add the friction to a (3 nb,), lam (m,) and what is left of Q, after begin_sliding; returns its power (W)."""
    rows = dyn.sliding.rows
    table = dyn.sliding.table
    n3 = a.shape[0]
    count = rows.shape[0]
    at_a = 1 + n3
    at_lam = at_a + n3
    at_matrix = at_lam + lam.shape[0]
    applied = table.shape[1] - 1
    matrix = table[:, at_matrix:applied]
    for j in range(count):
        gap = rows[j, 0]
        matrix[j, count] = -lam[gap]
        for k in range(count):
            matrix[j, k] = 1.0 if j == k else 0.0
            if table[k, 0] != 0.0:
                matrix[j, k] += table[k, at_lam + gap]
                matrix[j, count] += table[k, at_lam + gap] * table[k, applied]
    eliminate(matrix[:, :count], matrix[:, count:])
    power = 0.0
    for k in range(count):
        if table[k, 0] == 0.0:
            continue
        normal = matrix[k, count]
        more = normal - table[k, applied]
        table[k, applied] = normal
        way = rows[k, 1]
        for c in range(3, n3):
            a[c] += table[k, at_a + c] * more
            scratch.force[c] += table[k, 1 + c] * more
        for r in range(lam.shape[0]):
            lam[r] += table[k, at_lam + r] * more
        power -= table[k, 0] * more * along(dyn, scratch, way, v)
    for k in range(count):
        if table[k, 0] != 0.0:
            lam[rows[k, 1]] = table[k, 0] * matrix[k, count]
    return power
