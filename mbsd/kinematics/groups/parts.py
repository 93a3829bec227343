"""Decomposition of a mechanism without a plan of closed forms alone: groups, and blocks between them.

Where no group can be added, the smallest set of bodies that the equations left fix together is taken as a block: the
irreducible blocks of J tell which bodies depend on which. So a gear train, a cam or a triad costs Newton-Raphson in its
own few unknowns, and what stands on it is closed again. Joints that repeat others are left out, and looked at
afterwards. The bodies of a block, their connections and their equations become tables (blocks.py).

Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 6 (block triangular form).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.running import Kept
from mbsd.equations.relative.equation import ARM, AT, ROW
from mbsd.kinematics.groups import blocks
from mbsd.kinematics.groups.blocks import Blocks, with_scratch
from mbsd.kinematics.groups.groups import Groups, Link
from mbsd.kinematics.groups.kinds.train import CARRIES_ON
from mbsd.kinematics.groups.kinds.welded import welded
from mbsd.kinematics.groups.plan import Plan, links_of_joints
from mbsd.kinematics.groups.trains import Trains
from mbsd.kinematics.steps import strides

CLOSED, PINNED, BESIDE, EACH, WHOLE = 0.05, 0.22, 0.1, 0.2, 0.15
"""Measured costs of one time (us): of a closed group, of a block of one pinned body, of another block beside what each
of its unknowns costs, and of a body in Newton-Raphson of the whole."""


class Parts(NamedTuple):
    """A mechanism taken apart."""

    groups: Groups
    blocks: Blocks
    proved: bool
    """True if joints that repeat others are sure to hold."""


def plan_parts(packed: Packed, q0: np.ndarray, pattern: np.ndarray, kept: np.ndarray) -> Parts | None:
    """Return groups and blocks at the closed pose q0 (3 nb,); None if the mechanism is solved as a whole.

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
        self._add_block(written, block.rows)
        return True

    def _add_train(self, tree: list[tuple[int, int, Link | None]], equations: list[int]) -> bool:
        """Add the bodies as a gear train, if they are one."""
        if any(hangs not in (blocks.PIN, blocks.WELD) for _, hangs, _ in tree):
            return False
        pinned = [body for body, hangs, _ in tree if hangs == blocks.PIN]
        follows: dict[int, int] = {}
        for body, hangs, link in tree:
            if hangs == blocks.WELD and link is not None:
                follows[body] = follows.get(link.other, link.other)
        if not self.trains.solve(equations, pinned, follows):
            return False
        for body, hangs, link in tree:
            assert link is not None
            if hangs == blocks.WELD:
                self.plan.add_group(welded(self.plan.places, body, {"W": link}), (body,))
                continue
            sums = self.trains.sums[body]
            numbers = [*self.plan.places.pin(link), sums.constant, 0.0]
            self.plan.add_group((blocks.TRAIN, (body, -1, link.other, 0), len(self.train), numbers), (body,))
            self.train.append([len(self.shares), len(sums.shares)])
            self.shares += sums.shares.items()
        return True

    def _used(self) -> set[int]:
        rows_of = self.packed.rows_of
        return {row for joint in self.plan.used for row in rows_of(joint)} | self._taken_rows

    def _add_block(self, block: Tables, rows: Sequence[int]) -> None:
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
        bodies = [line[blocks.BODY] for line in block.tree]
        self.plan.add_group((blocks.BLOCK, (bodies[0], -1, 0, 0), len(self.head) - 1, []), bodies)

    def cost(self) -> float:
        """Return cost of one time (us)."""
        costs = [
            PINNED
            if head[blocks.BODIES] == 1 and self.tree[head[blocks.TREE_AT]][blocks.HANGS] == blocks.PIN
            else BESIDE + EACH * head[blocks.EQUATIONS]
            for head in self.head
        ]
        return CLOSED * (len(self.plan.taken) - len(costs)) + sum(costs)

    def tables(self) -> Parts:
        """Return groups and blocks as the kernels read them."""
        carriers = {int(body) for kind, bodies, _, _ in self.plan.taken if kind < blocks.BLOCK for body in bodies[2:]}
        for head in self.head:
            own = {row[0] for row in self.tree[head[blocks.TREE_AT] : head[blocks.TREE_AT] + head[blocks.BODIES]]}
            head[blocks.CARRIES] = int(bool(own & carriers))
        for kind, bodies, _, numbers in self.plan.taken:
            if kind == blocks.TRAIN:
                numbers[CARRIES_ON] = float(bodies[0] in carriers)
        tables = with_scratch(
            self.head, self.tree, self.equations, self.near, self.frame, self.numbers,
            self.packed.system.numbers, self.train, [body for body, _ in self.shares],
            [share for _, share in self.shares],
        )  # fmt: skip
        left_out = set(range(len(self.packed.ws.phi))) - self.rows
        return Parts(self.plan.groups(), tables, all(self.trains.proves(row) for row in left_out))


HANGING = {"W": blocks.WELD, "R": blocks.PIN, "P": blocks.SLIDE}
"""Links that a body may hang by, the best first."""
ONE_ROW = {"slot": blocks.ACROSS, "along": blocks.ALONG, "distance": blocks.APART}


class Hanging(NamedTuple):
    """The bodies of a block as they hang from known ones and each other."""

    tree: list[tuple[int, int, Link | None]]
    """Body, how it hangs and by what, in the order of placing."""
    rows: list[int]
    """Rows of J: all that hold these bodies."""
    equations: list[int]
    """Equations that hold no body; as many as unknowns."""


def fixed_bodies(packed: Packed, known: Collection[int], left: Sequence[int], pattern: np.ndarray) -> set[int] | None:
    """Return the fewest unknown bodies that rows ``left`` fix on their own; None if there are none.

    ``pattern`` (m, n): the entries of J that are not zero. There may be fewer rows than coordinates.
    """
    if not len(left):
        return None
    arms = {int(entry[ROW]): int(entry[ARM]) for entry in packed.system.special}
    unknown = tuple(body for body in range(1, len(packed.body_names)) if body not in known)
    columns = np.concatenate([3 * body - 3 + np.arange(3) for body in unknown])
    own = pattern[np.ix_(left, columns)]
    key = own.tobytes(), unknown, tuple(arms.get(row, 0) for row in left)
    fixed = _FIXED.get(key, lambda: _fixed(own, unknown, key[2]))
    return None if fixed is None else set(fixed)


_FIXED: Kept[tuple[int, ...] | None] = Kept()
"""Parts by all that they depend on."""


def _fixed(own: np.ndarray, unknown: Sequence[int], arms: Sequence[int]) -> tuple[int, ...] | None:
    """Return the fixed bodies from the entries of rows and bodies, and the arm of each row or 0."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components, maximum_bipartite_matching

    if own.shape[0] > own.shape[1]:
        return None
    column_of = maximum_bipartite_matching(csr_array(own), perm_type="column")
    if (column_of < 0).any():
        return None
    loose = np.ones(own.shape[1], bool)
    loose[column_of] = False
    waits = np.zeros((len(unknown), len(unknown)), bool)
    at = {body: k for k, body in enumerate(unknown)}
    for r, arm in enumerate(arms):
        fixed = column_of[r] // 3
        waits[fixed, np.flatnonzero(own[r]) // 3] = True
        if arm in at:
            waits[fixed, at[arm]] = True
    _, label = connected_components(csr_array(waits), directed=True, connection="strong")
    free = [
        np.flatnonzero(label == part)
        for part in np.unique(label)
        if not waits[np.ix_(label == part, label != part)].any() and not loose.reshape(-1, 3)[label == part].any()
    ]
    least = min(free, key=lambda members: (len(members), members[0]), default=None)
    return None if least is None else tuple(unknown[int(k)] for k in least)


def hanging(plan: Plan, members: set[int], left: Sequence[int]) -> Hanging | None:
    """Return the block of ``members`` with the rows of ``left`` that hold it; None if it is too large."""
    packed, inside = plan.packed, plan.known | members
    rows = [row for row in left if all(int(body) in inside for body in packed.system.row_body[row])]
    tree, joints = hanging_tree(plan, members)
    unknowns = sum(blocks.UNKNOWNS[hangs] for _, hangs, _ in tree)
    first = packed.first_row
    held = {row for joint in joints for row in range(first[joint], first[joint + 1])}
    equations = [row for row in rows if row not in held]
    return Hanging(tree, rows, equations) if 0 < len(equations) == unknowns <= blocks.LARGEST else None


def hanging_tree(plan: Plan, members: set[int]) -> tuple[list[tuple[int, int, Link | None]], set[int]]:
    """Return bodies in the order of placing, how they hang and by what; the joints they hang by."""
    placed, waiting = set(plan.known), sorted(members)
    tree: list[tuple[int, int, Link | None]] = []
    joints: set[int] = set()
    while waiting:
        hanging = None
        for kind in HANGING:
            for body in waiting:
                links = [x for x in plan.links[body] if x.kind == kind and x.other in placed]
                if links:
                    hanging = body, HANGING[kind], links[0]
                    break
            if hanging:
                break
        body, hangs, link = hanging or (waiting[0], blocks.FREE, None)
        tree.append((body, hangs, link))
        if link is not None:
            joints.add(link.joint)
        waiting.remove(body)
        placed.add(body)
    return tree, joints


class Tables(NamedTuple):
    """Lines of one block in the tables of blocks.py."""

    tree: list[list[int]]
    frame: list[list[float]]
    equations: list[list[int]]
    arms: list[list[float]]
    near: list[int]


def tables_of(plan: Plan, block: Hanging) -> Tables | None:
    """Return the tables of a block; None if an equation is half of a pin."""
    members = {body: place for place, (body, _, _) in enumerate(block.tree)}
    written = equations_of(plan.packed, block.equations, members)
    if written is None:
        return None
    beside = {link.other for _, _, link in block.tree if link} | {b for row in written[0] for b in row[1:3]}
    tree, frame, unknown = [], [], 0
    for body, hangs, link in block.tree:
        parent = link.other if link else 0
        tree.append([body, members.get(parent, -1), parent, hangs, unknown])
        frame.append([0.0] * 7 if link is None else plan.places.hanging(link))
        unknown += blocks.UNKNOWNS[hangs]
    return Tables(tree, frame, *written, sorted(beside - set(members) - {0}))


def equations_of(
    packed: Packed, rows: Sequence[int], place: dict[int, int]
) -> tuple[list[list[int]], list[list[float]]] | None:
    """Return the equations as tables; None if one of them is half of a pin."""
    system, stride = packed.system, strides(packed)
    special_at = {int(entry[ROW]): k for k, entry in enumerate(system.special)}
    offset = {int(row[2]): float(system.angle_offset[k]) for k, row in enumerate(system.angle)}
    length = {int(row[2]): float(system.distance_length[k]) for k, row in enumerate(system.distance)}
    kind = {int(row[2]): (blocks.TURNED, row) for row in system.angle}
    for name, number in ONE_ROW.items():
        kind |= {int(row[2]): (number, row) for row in getattr(system, name)}
    for row in system.point:
        if int(row[2]) in rows and int(row[2]) + 1 in rows:
            kind |= {int(row[2]): (blocks.ALONG, row), int(row[2]) + 1: (blocks.ACROSS, row)}
    equations, numbers = [], []
    for row in rows:
        at = arm = address = 0
        if row in special_at:
            k = special_at[row]
            entry = system.special[k]
            equation, (i, j, _, motion) = blocks.SPECIAL, entry[:4]
            at, arm, address = int(entry[AT]), int(entry[ARM]), int(system.address[k])
        elif row in kind:
            equation, (i, j, _, motion) = kind[row]
        else:
            return None
        bi, bj = int(system.marker_body[i]), int(system.marker_body[j])
        equations.append(
            [equation, bi, bj, place.get(bi, -1), place.get(bj, -1), int(motion), at, arm, address]
        )  # fmt: skip
        constant = offset.get(row, length.get(row, 0.0))
        limit = float(stride[motion]) if motion else 0.0
        parts = (*system.marker_arm[i], *system.marker_axis[i], *system.marker_arm[j])
        numbers.append([*(float(x) for x in parts), constant, limit, packed.size])
    return equations, numbers
