"""Takes a mechanism apart where closed forms alone do not serve: groups as in plan.py, and blocks between them.

Where no group can be added, the smallest set of bodies that the equations left fix together is taken as a block: the
irreducible blocks of J tell which bodies depend on which. So a gear train, a cam or a triad costs Newton-Raphson in its
own few unknowns, and what stands on it is closed again. Joints that repeat others are left out, and looked at
afterwards. Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 6 (block triangular form).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.equations.constraints.relative import ARM, ROW
from mbsd.kinematics.groups.block_tables import equations_of, hanging_tree
from mbsd.kinematics.groups.blocks import (
    BLOCK,
    BODIES,
    CARRIES,
    EQUATIONS,
    HANGS,
    LARGEST,
    PIN,
    TRAIN,
    TREE_AT,
    UNKNOWNS,
    WELD,
    Blocks,
    with_scratch,
)
from mbsd.kinematics.groups.groups import Groups
from mbsd.kinematics.groups.kinds.train import CARRIES_ON
from mbsd.kinematics.groups.kinds.welded import welded
from mbsd.kinematics.groups.links import Link
from mbsd.kinematics.groups.plan import Plan, links_of_joints
from mbsd.kinematics.groups.trains import Trains

CLOSED, PINNED, BESIDE, EACH, WHOLE = 0.05, 0.17, 0.1, 0.2, 0.15
"""Measured costs of one time (us): of a closed group, of a block of one pinned body, of another block beside what each
of its unknowns costs, and of a body in Newton-Raphson of the whole."""


class Parts(NamedTuple):
    """A mechanism taken apart."""

    groups: Groups
    blocks: Blocks
    proved: bool
    """Whether joints that repeat others are sure to hold."""


def plan_parts(packed: Packed, q0: np.ndarray, pattern: np.ndarray, kept: np.ndarray) -> Parts | None:
    """Groups and blocks at the closed pose q0 (3 nb,), or None where the mechanism is solved as a whole.

    ``pattern`` (m, n): the entries of J that are not zero; ``kept`` (n,): the rows that fix all coordinates.
    """
    parts = _Parts(packed, q0, pattern, kept)
    while len(parts.plan.known) < len(packed.body_names):
        parts.plan.grow()
        if len(parts.plan.known) < len(packed.body_names) and not parts.add_block():
            return None
    return parts.tables() if parts.cost() < WHOLE * (len(packed.body_names) - 1) else None


class _Parts:
    def __init__(self, packed: Packed, q0: np.ndarray, pattern: np.ndarray, kept: np.ndarray) -> None:
        self.packed, self.pattern, self.rows = packed, pattern, {int(row) for row in kept}
        whole = [
            k
            for k in range(len(packed.joints))
            if self.rows.issuperset(range(packed.first_row[k], packed.first_row[k + 1]))
        ]
        self.plan = Plan(packed, q0.reshape(-1, 3), links_of_joints(packed, whole))
        self.bodies_of = packed.system.row_body
        self.arms = {int(entry[ROW]): int(entry[ARM]) for entry in packed.system.special}
        self.trains = Trains(packed, q0)
        self.train: list[list[int]] = []
        self.shares: list[tuple[int, float]] = []
        self.head: list[list[int]] = []
        self.tree: list[list[int]] = []
        self.frame: list[list[float]] = []
        self.equations: list[list[int]] = []
        self.numbers: list[list[float]] = []
        self.near: list[int] = []
        self._taken_rows: set[int] = set()

    def add_block(self) -> bool:
        """Add the smallest block whose neighbours are known; False if it is too large or cannot be written."""
        left = [row for row in sorted(self.rows) if row not in self._used()]
        members = self._independent(left)
        if members is None:
            return False
        inside = self.plan.known | members
        own = [row for row in left if all(int(body) in inside for body in self.bodies_of[row])]
        tree, joints = hanging_tree(self.plan, members)
        unknowns = sum(UNKNOWNS[hangs] for _, hangs, _ in tree)
        hanging = {
            row for joint in joints for row in range(self.packed.first_row[joint], self.packed.first_row[joint + 1])
        }
        equations = [row for row in own if row not in hanging]
        if not 0 < len(equations) == unknowns <= LARGEST:
            return False
        if self._add_train(tree, equations):
            self._taken_rows = self._taken_rows | set(own)
            return True
        written = equations_of(self.packed, equations, {body: place for place, (body, _, _) in enumerate(tree)})
        if written is None:
            return False
        self._take(tree, *written, own)
        return True

    def _add_train(self, tree: list[tuple[int, int, Link | None]], equations: list[int]) -> bool:
        """Add the bodies as a gear train, if they are one."""
        if any(hangs not in (PIN, WELD) for _, hangs, _ in tree):
            return False
        pinned = [body for body, hangs, _ in tree if hangs == PIN]
        follows: dict[int, int] = {}
        for body, hangs, link in tree:
            if hangs == WELD and link is not None:
                follows[body] = follows.get(link.other, link.other)
        if not self.trains.solve(equations, pinned, follows):
            return False
        for body, hangs, link in tree:
            assert link is not None
            if hangs == WELD:
                self.plan.take(welded(self.plan.places, body, {"W": link}), (body,))
                continue
            sums = self.trains.sums[body]
            numbers = [*self.plan.places.pin(link), sums.constant, 0.0]
            self.plan.take((TRAIN, (body, -1, link.other, 0), len(self.train), numbers), (body,))
            self.train.append([len(self.shares), len(sums.shares)])
            self.shares += sums.shares.items()
        return True

    def _used(self) -> set[int]:
        first = self.packed.first_row
        return {row for joint in self.plan.used for row in range(first[joint], first[joint + 1])} | self._taken_rows

    def _independent(self, left: Sequence[int]) -> set[int] | None:
        """The unknown bodies that the rows left fix first: of those that wait for none, the fewest."""
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import connected_components, maximum_bipartite_matching

        unknown = [body for body in range(1, len(self.packed.body_names)) if body not in self.plan.known]
        columns = np.concatenate([3 * body - 3 + np.arange(3) for body in unknown])
        pattern = self.pattern[np.ix_(left, columns)]
        if pattern.shape[0] != pattern.shape[1]:
            return None
        column_of = maximum_bipartite_matching(csr_array(pattern), perm_type="column")
        if (column_of < 0).any():
            return None
        waits = np.zeros((len(unknown), len(unknown)), bool)
        at = {body: k for k, body in enumerate(unknown)}
        for r, row in enumerate(left):
            fixed = column_of[r] // 3
            waits[fixed, np.flatnonzero(pattern[r]) // 3] = True
            if self.arms.get(row, 0) in at:
                waits[fixed, at[self.arms[row]]] = True
        _, label = connected_components(csr_array(waits), directed=True, connection="strong")
        free = [
            np.flatnonzero(label == part)
            for part in np.unique(label)
            if not waits[np.ix_(label == part, label != part)].any()
        ]
        least = min(free, key=lambda members: (len(members), members[0]))
        return {unknown[k] for k in least}

    def _take(
        self,
        tree: list[tuple[int, int, Link | None]],
        equations: list[list[int]],
        numbers: list[list[float]],
        own: Sequence[int],
    ) -> None:
        members = {body: place for place, (body, _, _) in enumerate(tree)}
        beside = {link.other for _, _, link in tree if link} | {b for row in equations for b in row[1:3]}
        beside = sorted(beside - set(members) - {0})
        self.head.append(
            [len(tree), len(equations), len(beside), 0, len(self.tree), len(self.equations), len(self.near),
             len(self.packed.motions) + 1, len(self.packed.body_names)]
        )  # fmt: skip
        unknown = 0
        for body, hangs, link in tree:
            parent = link.other if link else 0
            self.tree.append([body, members.get(parent, -1), parent, hangs, unknown])
            self.frame.append([0.0] * 7 if link is None else self.plan.places.hanging(link))
            unknown += UNKNOWNS[hangs]
        self.equations += equations
        self.numbers += numbers
        self.near += beside
        self._taken_rows = self._taken_rows | set(own)
        bodies = [body for body, _, _ in tree]
        self.plan.take((BLOCK, (bodies[0], -1, 0, 0), len(self.head) - 1, []), bodies)

    def cost(self) -> float:
        """Of one time (us)."""
        blocks = [
            PINNED if head[BODIES] == 1 and self.tree[head[TREE_AT]][HANGS] == PIN else BESIDE + EACH * head[EQUATIONS]
            for head in self.head
        ]
        return CLOSED * (len(self.plan.taken) - len(blocks)) + sum(blocks)

    def tables(self) -> Parts:
        """As the kernels read them."""
        address = 0
        if self.head:
            from mbsd.kinematics.groups.newton.block import ADDRESS

            address = ADDRESS
        carriers = {int(body) for kind, bodies, _, _ in self.plan.taken if kind < BLOCK for body in bodies[2:]}
        for head in self.head:
            own = {row[0] for row in self.tree[head[TREE_AT] : head[TREE_AT] + head[BODIES]]}
            head[CARRIES] = int(bool(own & carriers))
        for kind, bodies, _, numbers in self.plan.taken:
            if kind == TRAIN:
                numbers[CARRIES_ON] = float(bodies[0] in carriers)
        blocks = with_scratch(
            address, self.head, self.tree, self.equations, self.near, self.frame, self.numbers,
            self.packed.system.numbers, self.train, [body for body, _ in self.shares],
            [share for _, share in self.shares],
        )  # fmt: skip
        left_out = set(range(len(self.packed.ws.phi))) - self.rows
        return Parts(self.plan.groups(), blocks, all(self.trains.proves(row) for row in left_out))
