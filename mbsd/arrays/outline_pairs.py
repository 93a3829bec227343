"""Pairs of outlines along a known motion, which rows kept while they held."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.equations.assembly import tabulate
from mbsd.equations.relative.equation import ROW
from mbsd.equations.relative.outline_features import ROOM
from mbsd.equations.system import LAST

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.joint import Joint

OUTLINE, SLIDING = "outline", "outline_sliding"
SAME_RUNS = ("outline_i", "outline_j", "runs", "arcs")


class OutlineRow(NamedTuple):
    """A row of a contact of outlines."""

    joint: Joint
    gap: int
    """Its row in J."""
    relative: int
    """Its row in Workspace.relative."""
    way: int
    """The row of its way; -1 without friction."""


def outline_rows(packed: Packed) -> list[OutlineRow]:
    """Return the rows of contacts of outlines, in the order of the contacts."""
    names, joints = packed.specials.names, packed.specials.joints
    ways = {joint.name: k for k, (name, joint) in enumerate(zip(names, joints, strict=True)) if name == SLIDING}
    return [
        OutlineRow(joint, int(packed.system.special[k, ROW]), k, ways.get(joint.name, -1))
        for k, (name, joint) in enumerate(zip(names, joints, strict=True))
        if name == OUTLINE
    ]


def siblings(rows: list[OutlineRow]) -> list[int]:
    """Return, for each row, the place of the row with the same runs; -1 where there is none."""
    out = [-1] * len(rows)
    for k, row in enumerate(rows):
        other = rows[k + 1] if k + 1 < len(rows) else None
        if other is None or row.joint.params["second"] or not other.joint.params["second"]:
            continue
        same = all(row.joint.params[key] == other.joint.params[key] for key in SAME_RUNS)
        if same and row.joint.bodies == other.joint.bodies:
            out[k], out[k + 1] = k + 1, k
    return out


def pair_rows(packed: Packed) -> list[int]:
    """Return the rows of Workspace.relative whose LAST has the codes of pairs, of contacts and ways."""
    return [at for row in outline_rows(packed) for at in (row.relative, row.way) if at >= 0]


def tabulate_pairs(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray, phi: np.ndarray, compact: np.ndarray,
    gamma: np.ndarray, pairs: np.ndarray | None,
) -> None:  # fmt: skip
    """Tabulate along a motion q, v (T, 3 nb), each row with the pair that it kept.

    ``pairs`` (T, o); None: none.
    """
    count = len(pair_rows(packed))
    codes = np.full((1, count), math.nan) if pairs is None else np.unique(pairs, axis=0, equal_nan=True)
    for code in codes:
        every = np.ones(len(q), bool) if pairs is None else _alike(pairs, code)
        parts = [np.zeros_like(whole[every]) for whole in (phi, compact, gamma)]
        with kept_pairs(packed, code):
            tabulate(packed.system, drives[every], q[every], v[every], packed.ws, *parts)
        phi[every], compact[every], gamma[every] = parts


@contextmanager
def kept_pairs(packed: Packed, code: np.ndarray | None) -> Iterator[None]:
    """Let rows of outlines keep pairs ``code`` (o,) in what is evaluated within; None: as they are."""
    rows, relative = [] if code is None else pair_rows(packed), packed.ws.relative
    before = relative[rows, LAST].copy()
    relative[rows, LAST] = code if rows else before
    try:
        yield
    finally:
        relative[rows, LAST] = before


def room_at(packed: Packed, t: float, q: np.ndarray, pairs: np.ndarray, gap: int) -> float:
    """Return the way (m) left to a row's pair at a pose q (3 nb,) and t (s).

    ``gap``: its row in J; ``pairs`` (o,): those that rows kept. Infinite for a row of no outlines.
    """
    here = next((row for row in outline_rows(packed) if row.gap == gap), None)
    if here is None:
        return math.inf
    rows = len(packed.ws.phi)
    phi, gamma, compact = np.zeros((1, rows)), np.zeros((1, rows)), np.zeros((1, rows, 6))
    q = np.ascontiguousarray(q)[None]
    tabulate_pairs(packed, packed.drives(np.array([t])), q, np.zeros_like(q), phi, compact, gamma, pairs[None])
    return float(packed.ws.relative[here.relative, ROOM])


def _alike(pairs: np.ndarray, code: np.ndarray) -> np.ndarray:
    """Return (T,) True where ``pairs`` (T, o) are those of ``code`` (o,)."""
    return ((pairs == code) | (np.isnan(pairs) & np.isnan(code))).all(axis=1)
