"""Decomposition of a mechanism without a plan of closed forms alone: groups, and blocks between them.

Where no group can be added, the smallest set of bodies that the equations left fix together is taken as a block: the
irreducible blocks of J tell which bodies depend on which. So a gear train, a cam or a triad costs Newton-Raphson in its
own few unknowns, and what stands on it is closed again. Joints that repeat others are left out, and looked at
afterwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.kinematics.groups.block_tables import Tables, fixed_bodies, hanging, tables_of
from mbsd.kinematics.groups.blocks import (
    BLOCK,
    BODIES,
    BODY,
    CARRIES,
    EQUATIONS,
    HANGS,
    PIN,
    TRAIN,
    TREE_AT,
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

CLOSED, PINNED, BESIDE, EACH, WHOLE = 0.05, 0.22, 0.1, 0.2, 0.15
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
        whole = [k for k in range(len(packed.joints)) if self.rows.issuperset(packed.rows_of(k))]
        self.plan = Plan(packed, q0.reshape(-1, 3), links_of_joints(packed, whole))
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
        used = self._used()
        left = [row for row in sorted(self.rows) if row not in used]
        members = fixed_bodies(self.packed, self.plan.known, left, self.pattern)
        block = None if members is None else hanging(self.plan, members, left)
        if block is None:
            return False
        if self._add_train(block.tree, block.equations):
            self._taken_rows = self._taken_rows | set(block.rows)
            return True
        written = tables_of(self.plan, block)
        if written is None:
            return False
        self._take(written, block.rows)
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
        rows_of = self.packed.rows_of
        return {row for joint in self.plan.used for row in rows_of(joint)} | self._taken_rows

    def _take(self, block: Tables, rows: Sequence[int]) -> None:
        self.head.append(
            [len(block.tree), len(block.equations), len(block.near), 0, len(self.tree), len(self.equations),
             len(self.near), len(self.packed.motions) + 1, len(self.packed.body_names)]
        )  # fmt: skip
        self.tree += block.tree
        self.frame += block.frame
        self.equations += block.equations
        self.numbers += block.arms
        self.near += block.near
        self._taken_rows = self._taken_rows | set(rows)
        bodies = [line[BODY] for line in block.tree]
        self.plan.take((BLOCK, (bodies[0], -1, 0, 0), len(self.head) - 1, []), bodies)

    def cost(self) -> float:
        """Cost of one time (us)."""
        blocks = [
            PINNED if head[BODIES] == 1 and self.tree[head[TREE_AT]][HANGS] == PIN else BESIDE + EACH * head[EQUATIONS]
            for head in self.head
        ]
        return CLOSED * (len(self.plan.taken) - len(blocks)) + sum(blocks)

    def tables(self) -> Parts:
        """As the kernels read them."""
        carriers = {int(body) for kind, bodies, _, _ in self.plan.taken if kind < BLOCK for body in bodies[2:]}
        for head in self.head:
            own = {row[0] for row in self.tree[head[TREE_AT] : head[TREE_AT] + head[BODIES]]}
            head[CARRIES] = int(bool(own & carriers))
        for kind, bodies, _, numbers in self.plan.taken:
            if kind == TRAIN:
                numbers[CARRIES_ON] = float(bodies[0] in carriers)
        blocks = with_scratch(
            self.head, self.tree, self.equations, self.near, self.frame, self.numbers,
            self.packed.system.numbers, self.train, [body for body, _ in self.shares],
            [share for _, share in self.shares],
        )  # fmt: skip
        left_out = set(range(len(self.packed.ws.phi))) - self.rows
        return Parts(self.plan.groups(), blocks, all(self.trains.proves(row) for row in left_out))
