"""Inertia that joints lend to coordinates without any, and the small part of it by which M is lifted there.

The least kinetic energy with which a coordinate c moves at rate 1, 1/2 m_c, is that of a body of inertia m_c alone:

    m_c = 1 / a_c,     M a + J^T lam = e_c,   J a = 0

M + D with  D_c = LIFT m_c  leaves accelerations that are off by no more than LIFT times the number of such coordinates
while the pose is near this one, whatever else is in the model, and refinement (reference/refinement.py) takes that off.
A coordinate that joints hold still has no m_c; one that nothing holds has m_c = 0. Both are bounded by the mass of
the bodies that joints connect to it.

Source: Featherstone, Rigid Body Dynamics Algorithms, ch. 7 (articulated-body inertia).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.inertias import inertia_of
from mbsd.arrays.packing import Packed
from mbsd.equations.assembly import residual_and_jacobian

LIFT = 1e-7
"""Part of the lent inertia by which M is lifted."""
LEAST, FAINT = 1e-14, 1e-25
"""Parts of what a body weighs, or those that joints connect to it: the lent inertia of a coordinate is at least the
first; the second, given to it while the lent inertia is found, is none."""
DENSE = 150
"""Up to so many unknowns full matrices are solved."""
AT_ONCE = 2_000_000
"""Numbers of solutions that are held at once."""


def lift_inertia(packed: Packed, rows: Sequence[int], q: np.ndarray, time: float, usual: np.ndarray) -> np.ndarray:
    """Return (3 nb,) M lifted where it is zero, by a part of what joints lend there at the pose q (3 nb,).

    ``rows``: independent rows of J; ``time`` (s); ``usual`` (3 nb,) that of :func:`mbsd.arrays.inertias.usual_inertia`.
    """
    inertia = inertia_of(packed)
    if inertia[3:].all():
        return usual
    light = np.flatnonzero(inertia[3:] == 0.0)
    out = np.where(inertia > 0.0, inertia, usual)
    residual_and_jacobian(packed.system, q, packed.drives(np.array([time]))[0], packed.ws)
    lent = _lent(packed, np.asarray(rows, np.int64), inertia[3:], usual[3:], light)
    most = usual[3 + light]
    own = packed.system.mass[1 + light // 3] * np.where(light % 3 == 2, packed.size**2, 1.0)
    least = LEAST * np.where(own > 0.0, own, most)
    out[3 + light] = LIFT * np.clip(np.where(np.isfinite(lent), lent, most), least, most)
    return out


def _lent(packed: Packed, rows: np.ndarray, inertia: np.ndarray, usual: np.ndarray, light: np.ndarray) -> np.ndarray:
    """(k,) lent inertia of the coordinates ``light`` (k,); infinite where joints hold one, rounding where none does."""
    count, total = len(inertia), len(inertia) + len(rows)
    diagonal = inertia.copy()
    diagonal[light] = FAINT * usual[light]
    compact, bodies = packed.ws.jac[rows], packed.system.row_body[rows]
    row, side, c = np.indices((len(rows), 2, 3))
    column = 3 * bodies[row, side] + c
    moving = (column >= 3) & (compact.reshape(-1, 2, 3) != 0.0)
    entry = compact.reshape(-1, 2, 3)[moving]
    row, column = count + row[moving], column[moving] - 3
    if total <= DENSE:
        matrix = np.zeros((total, total))
        matrix[np.arange(count), np.arange(count)] = diagonal
        np.add.at(matrix, (row, column), entry)
        matrix[:count, count:] = matrix[count:, :count].T

        def solve(right: np.ndarray) -> np.ndarray:
            return np.linalg.solve(matrix, right)
    else:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        at = np.arange(count)
        matrix = csc_array(
            (
                np.concatenate([diagonal, entry, entry]),
                (np.concatenate([at, row, column]), np.concatenate([at, column, row])),
            ),
            shape=(total, total),
        )
        solve = splu(matrix).solve
    out = np.empty(len(light))
    step = max(1, AT_ONCE // total)
    for first in range(0, len(light), step):
        part = light[first : first + step]
        right = np.zeros((total, len(part)))
        right[part, np.arange(len(part))] = 1.0
        with np.errstate(divide="ignore"):
            out[first : first + step] = 1.0 / np.abs(solve(right)[part, np.arange(len(part))])
    return out
