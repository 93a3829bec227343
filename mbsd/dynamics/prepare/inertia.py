"""Inertia that joints lend to coordinates without any, and how far apart the masses of connected bodies are.

The least kinetic energy with which a coordinate c moves at rate 1, 1/2 m_c, is that of a body of inertia m_c alone:

    m_c = 1 / a_c,     M a + J^T lam = e_c,   J a = 0

M + D with  D_c = LIFT m_c  leaves accelerations that are off by no more than LIFT times the number of such coordinates
while the pose is near this one, whatever else is in the model, and refinement (reference/refinement.py) takes that off.
A coordinate that joints hold still has no m_c; one that nothing holds has m_c = 0. Both are bounded by the mass of
the bodies that joints connect to it.

A body's part of a row's mobility is J_b M_b^-1 J_b^T (1/kg). Where the parts of connected bodies differ by a ratio r,
a solution of the Schur complement loses the r-th part of its digits; each pass more solves for what the last one left
and gains what one solution has, so that 16 digits take 16 / (15 - log10 r) passes. A light body that hangs at one
other body alone costs none: what moves it is no difference of large numbers. A body that joints hold on ground does not
accelerate, so any inertia serves there: it counts as heavy as the heaviest, as ground would.

Source: Featherstone, Rigid Body Dynamics Algorithms, ch. 7 (articulated-body inertia).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd.arrays.inertias import inertia_of
from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.equations.assembly import residual_and_jacobian, tabulate

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


USUAL = 1e6
"""Ratios up to this cost no digits that matter."""
LARGEST = 1e13
"""Beyond, rounding is larger than what the lighter body feels."""
DIGITS, HELD = 16, 15
ROUNDED = 1e-6
"""Part of a row's largest entry, in sizes, below which an entry is rounding."""


def as_heavy_as_ground(inertia: np.ndarray, still: np.ndarray, per_size: np.ndarray) -> np.ndarray:
    """Inertia (3 nb,) in which coordinates that are ``still`` (3 nb,) weigh as much as the heaviest.

    It is ``inertia`` itself where masses are not far apart.
    """
    if not still[3:].any():
        return inertia
    scaled = np.divide(inertia, per_size**2, out=np.zeros_like(inertia), where=per_size > 0.0)
    moving = scaled[3:][~still[3:] & (inertia[3:] > 0.0)]
    if not len(moving) or moving.max() <= USUAL * scaled[3:][inertia[3:] > 0.0].min():
        return inertia
    return np.where(still, np.maximum(inertia, moving.max() * per_size**2), inertia)


def passes_for(
    packed: Packed, time: float, q: np.ndarray, inertia: np.ndarray, per_size: np.ndarray, still: np.ndarray
) -> int:
    """Passes that the equations of motion take at q, inertia (3 nb,), time (s); ``per_size`` (3 nb,) 1/m and 1/rad.

    Coordinates that are ``still`` (3 nb,) are ground's. Raises ModelError, with the bodies, where masses are too far
    apart.
    """
    usual = inertia[3:] / per_size[3:] ** 2
    usual = usual[usual > 0.0]
    if not len(usual) or usual.max() <= USUAL * usual.min() or not len(packed.ws.phi):
        return 1
    ratio, light, heavy = _farthest_apart(packed, time, q, inertia, per_size, still)
    if ratio <= USUAL:
        return 1
    if ratio > LARGEST:
        names = packed.body_names
        raise ModelError(
            f"{packed.name}: body '{names[light]}' is joined on to '{names[heavy]}', directly or through others, and "
            f"their inertias are {ratio:.1e} times apart: more than {LARGEST:.0e} is lost in rounding. Give "
            f"'{names[light]}' the mass and inertia 0, or hold '{names[heavy]}' by ground"
        )
    return math.ceil(DIGITS / (HELD - math.log10(ratio)))


def _farthest_apart(
    packed: Packed, time: float, q: np.ndarray, inertia: np.ndarray, per_size: np.ndarray, still: np.ndarray
) -> tuple[float, int, int]:
    """The largest ratio of parts within connected bodies, and the bodies with the largest and the least of them."""
    rows = len(packed.ws.phi)
    phi, gamma, compact = np.zeros((1, rows)), np.zeros((1, rows)), np.zeros((1, rows, 6))
    tabulate(
        packed.system, packed.drives(np.array([time])), q[None], np.zeros((1, len(q))), packed.ws, phi, compact, gamma
    )
    bodies = packed.system.row_body
    columns = (3 * bodies[..., None] + np.arange(3)).reshape(rows, 6)
    entry = compact[0]
    plain = np.abs(entry) / np.where(per_size[columns] > 0, per_size[columns], 1.0)
    entry = np.where(plain > ROUNDED * plain.max(axis=1, keepdims=True), entry, 0.0)
    mobility = np.divide(entry**2, inertia[columns], out=np.zeros_like(entry), where=inertia[columns] > 0.0)
    part = mobility.reshape(rows, 2, 3).sum(axis=2)
    bodies = np.where(still[::3][bodies], 0, bodies)
    part[bodies == 0] = 0.0
    most, least = np.zeros(len(packed.body_names)), np.full(len(packed.body_names), np.inf)
    np.maximum.at(most, bodies.ravel(), part.ravel())
    np.minimum.at(least, bodies[part > 0.0], part[part > 0.0])
    best = (1.0, 0, 0)
    for group in _groups(bodies, most):
        inside = np.array([b for b in group if most[b] > 0.0], np.int64)
        if len(inside) > 1:
            light, heavy = int(inside[most[inside].argmax()]), int(inside[least[inside].argmin()])
            best = max(best, (float(most[light] / least[heavy]), light, heavy))
    return best


def _groups(bodies: np.ndarray, most: np.ndarray) -> list[list[int]]:
    """Bodies that rows with ``bodies`` (m, 2) connect, without those that hang at a single heavier one."""
    beside: dict[int, set[int]] = {}
    for i, j in np.unique(bodies, axis=0).tolist():
        beside.setdefault(i, set()).add(j)
        beside.setdefault(j, set()).add(i)
    leaves = list(beside)
    while leaves:
        leaf = leaves.pop()
        if leaf and len(beside[leaf]) == 1:
            (at,) = beside[leaf]
            if most[leaf] >= most[at]:
                beside[leaf].clear()
                beside[at].discard(leaf)
                leaves.append(at)
    out: list[list[int]] = []
    seen = {0}
    for first in beside:
        if first not in seen:
            seen.add(first)
            group = [first]
            for body in group:
                group += beside[body] - seen
                seen |= beside[body]
            out.append(group)
    return out
