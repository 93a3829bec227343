"""Pairs of outlines along a known motion: which of two rows of the same runs has which of two places.

A row that held has the nearest place, and its sibling the next one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.equations.assembly import tabulate
from mbsd.equations.relative.equation import ROW
from mbsd.equations.relative.outline_features import CODES, PLACE
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


def tabulate_pairs(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray, phi: np.ndarray, compact: np.ndarray,
    gamma: np.ndarray, held: np.ndarray | None,
) -> None:  # fmt: skip
    """Tabulate along a motion q, v (T, 3 nb), each row with its place, where rows ``held`` (T, m)."""
    rows, relative = outline_rows(packed), packed.ws.relative
    touched = [at for row in rows for at in (row.relative, row.way) if at >= 0]
    kept = relative[touched, LAST].copy()
    relative[touched, LAST] = math.nan
    tabulate(packed.system, drives, q, v, packed.ws, phi, compact, gamma)
    pairs = [(rows[k], rows[j]) for k, j in enumerate(siblings(rows)) if j > k]
    swapped = (
        []
        if held is None
        else np.flatnonzero(sum((~held[:, a.gap] & held[:, b.gap] for a, b in pairs), np.zeros(len(q), bool)))
    )
    for k in swapped:
        at = slice(k, k + 1)
        args = packed.system, drives[at], q[at], v[at], packed.ws, phi[at], compact[at], gamma[at]
        tabulate(*args)
        for first, second in pairs:
            if held is not None and held[k, second.gap] and not held[k, first.gap]:
                place = relative[first.relative, PLACE]
                for row, code in ((second, place), (first, CODES * place)):
                    relative[[row.relative] if row.way < 0 else [row.relative, row.way], LAST] = code
        tabulate(*args)
        relative[touched, LAST] = math.nan
    relative[touched, LAST] = kept
