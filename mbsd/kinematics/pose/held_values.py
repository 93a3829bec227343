"""Given values of a start that are held: rows W after the joints, first given first held.

    rows of J, then of what is given, are independent        such a value is held as it is
    of a place x, y the joints leave one direction u alone   u . (x, y) is held, the nearest that the body can come

u is what is left of the two rows when those before them are taken off, so it turns with the machine: which axes the
world has does not matter. Velocities of a place go likewise.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

RANK_TOLERANCE = 1e-8
"""A row that adds less than this part of itself to the others repeats them."""
SMALL = 4000
"""Number of entries of J up to which its rank is kept for the next call with the same J."""
ALIGNED = 1e-12
"""Part of u across an axis below which it is that axis."""


def held_values(jac: np.ndarray, given: np.ndarray, places: Sequence[tuple[int, int]]) -> tuple[list[int], np.ndarray]:
    """Return independent rows of ``jac`` (m, n), and W (h, k) for ``given`` (k, n), in sizes and rad.

    ``places``: pairs of given rows that are x and y of one place.
    """
    kept = independent_rows(np.vstack([jac, given]))
    rows, chosen = [k for k in kept if k < len(jac)], [k - len(jac) for k in kept if k >= len(jac)]
    held = np.eye(len(given))[chosen]
    for pair in half_held(chosen, places):
        at = next(n for n, k in enumerate(chosen) if k in pair)
        before = np.vstack([jac[rows], given[[k for k in chosen if k < pair[0]]]])
        held[at, list(pair)] = free_direction(before, given[list(pair)])
    return rows, held


def is_choice(held: np.ndarray) -> bool:
    """Return True if all held values are held as they are given."""
    return bool((held.sum(axis=1) == 1.0).all() and (held.max(axis=1, initial=0.0) == 1.0).all())


def half_held(chosen: Sequence[int], places: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the pairs of which one is among the ``chosen``."""
    return [(x, y) for x, y in places if (x in chosen) != (y in chosen)]


def free_direction(before: np.ndarray, pair: np.ndarray) -> np.ndarray:
    """Return u (..., 2): the direction in rows ``pair`` that other rows leave most free.

    ``pair`` is (..., 2, n), the rows ``before`` are (..., r, n).
    """
    basis = np.linalg.qr(np.swapaxes(before, -1, -2))[0]
    left = pair - (pair @ basis) @ np.swapaxes(basis, -1, -2)
    u = np.linalg.eigh(left @ np.swapaxes(left, -1, -2))[1][..., -1]
    u = np.where(np.abs(u) < ALIGNED, 0.0, u)
    first = np.where(u[..., :1] != 0.0, u[..., :1], u[..., 1:])
    return u * np.sign(first) / np.hypot(u[..., :1], u[..., 1:])


def places_of(coordinates: Sequence[int]) -> list[tuple[int, int]]:
    """Return the pairs x, y among given coordinates, numbers in (3 nb,)."""
    return [(k, k + 1) for k, c in enumerate(coordinates) if c % 3 == 0]


def independent_rows(jac: np.ndarray) -> list[int]:
    """Return rows of ``jac`` (m, n) independent of those before them (Gram-Schmidt, done twice)."""
    if jac.size > SMALL:
        return _independent(jac)
    return list(_kept_independent(jac.tobytes(), jac.shape))


@lru_cache(maxsize=64)
def _kept_independent(numbers: bytes, shape: tuple[int, int]) -> tuple[int, ...]:
    return tuple(_independent(np.frombuffer(numbers).reshape(shape).copy()))


def _independent(jac: np.ndarray) -> list[int]:
    basis = np.zeros((min(jac.shape), jac.shape[1]))
    kept: list[int] = []
    lengths = np.sqrt(np.einsum("rc,rc->r", jac, jac))
    for row in np.flatnonzero(lengths > 0):
        if len(kept) == len(basis):
            break
        rest, before = jac[row] / lengths[row], basis[: len(kept)]
        for _ in range(2):
            rest = rest - (before @ rest) @ before
        length = math.sqrt(rest @ rest)
        if length > RANK_TOLERANCE:
            basis[len(kept)] = rest / length
            kept.append(int(row))
    return kept
