"""Arguments and scratch of the compiled equations of differentiated.py for a mechanism."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.arrays.laws import pack_laws
from mbsd.arrays.loads import pack_loads
from mbsd.derivatives.free.differentiated import Made, Nodes, Own, Scratch, differentiate

if TYPE_CHECKING:
    from mbsd.derivatives.numbers.terms import Terms


def differentiated(
    terms: Terms, nodes: Nodes, own: Own, per_size: np.ndarray, per_speed: float, reach: np.ndarray, asked: np.ndarray
) -> Made:
    """Return what ``differentiate`` makes; ``asked`` (R,) are the nodes of which everything is wanted."""
    packed, (count, n, f), numbers = terms.packed, nodes.free.shape, len(own.load)
    rows, width = nodes.lam.shape[1], nodes.q.shape[1]
    ways, first = 2 * f + len(own.moving), f + len(own.moving)
    scratch = Scratch(
        np.zeros(width), np.zeros(ways), np.zeros((ways + 1, width)), np.zeros((ways + 1, width)),
        np.zeros((ways + 1, width)), np.zeros((ways + 1, rows)), np.zeros(rows), np.zeros(n),
        np.zeros((f + 1, max(1, f))), np.zeros((f, len(nodes.rows))), np.zeros((2 * first, width)),
        np.zeros((2 * ways, width)),
        np.zeros((2 * ways, width)), np.zeros((2 * ways, width)), np.zeros(2 * ways), np.zeros(2 * ways),
        np.zeros((2 * ways, *nodes.drives.shape[1:])), np.zeros((2 * ways, rows)), np.zeros((2 * ways, rows)),
        np.zeros((2 * ways, rows, 6)),
    )  # fmt: skip
    all_ways = 2 * f + numbers
    made = Made(
        np.zeros((count, f, 2 * f)), np.zeros((count, f, numbers)),
        *(np.zeros((all_ways, len(asked), size)) for size in (width, width, width, rows)),
    )  # fmt: skip
    slots = np.full(count, -1)
    slots[asked] = np.arange(len(asked))
    loads = pack_loads(packed) if terms.loads is None else terms.loads
    laws = pack_laws(()) if terms.laws is None else terms.laws
    differentiate(
        packed.system, loads, laws, packed.ws, nodes, own, terms.inertia[3:], per_size, per_speed, reach, slots,
        scratch, made,
    )  # fmt: skip
    packed.specials.check()
    return made


def can_differentiate(terms: Terms) -> bool:
    """Return True if ``differentiate`` knows the mechanism: no friction in joints, and no curve that crosses itself."""
    return not terms.rough and not CurveBranches(terms.packed)
