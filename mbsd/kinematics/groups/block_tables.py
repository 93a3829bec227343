"""How the bodies of a block hang, and its equations as tables (mbsd/kinematics/groups/blocks.py)."""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.arrays.packing import Packed
from mbsd.equations.constraints.relative import ARM, AT, ROW
from mbsd.kinematics.groups.blocks import ACROSS, ALONG, APART, FREE, PIN, SLIDE, SPECIAL, TURNED, WELD
from mbsd.kinematics.groups.links import Link
from mbsd.kinematics.groups.plan import Plan
from mbsd.kinematics.steps import strides

HANGING = {"W": WELD, "R": PIN, "P": SLIDE}
"""Links that a body may hang by, the best first."""
ONE_ROW = {"slot": ACROSS, "along": ALONG, "distance": APART}


def hanging_tree(plan: Plan, members: set[int]) -> tuple[list[tuple[int, int, Link | None]], set[int]]:
    """Bodies in the order of their placing, how they hang and by what; the joints that they hang by."""
    placed, waiting = set(plan.known), sorted(members)
    tree: list[tuple[int, int, Link | None]] = []
    joints: set[int] = set()
    while waiting:
        found = None
        for kind in HANGING:
            for body in waiting:
                links = [x for x in plan.links[body] if x.kind == kind and x.other in placed]
                if links:
                    found = body, HANGING[kind], links[0]
                    break
            if found:
                break
        body, hangs, link = found or (waiting[0], FREE, None)
        tree.append((body, hangs, link))
        if link is not None:
            joints.add(link.joint)
        waiting.remove(body)
        placed.add(body)
    return tree, joints


def equations_of(
    packed: Packed, rows: Sequence[int], place: dict[int, int]
) -> tuple[list[list[int]], list[list[float]]] | None:
    """The equations as tables; None if one of them is half of a pin."""
    system, stride = packed.system, strides(packed)
    special_at = {int(entry[ROW]): k for k, entry in enumerate(system.special)}
    offset = {int(row[2]): float(system.angle_offset[k]) for k, row in enumerate(system.angle)}
    length = {int(row[2]): float(system.distance_length[k]) for k, row in enumerate(system.distance)}
    kind = {int(row[2]): (TURNED, row) for row in system.angle}
    for name, number in ONE_ROW.items():
        kind |= {int(row[2]): (number, row) for row in getattr(system, name)}
    for row in system.point:
        if int(row[2]) in rows and int(row[2]) + 1 in rows:
            kind |= {int(row[2]): (ALONG, row), int(row[2]) + 1: (ACROSS, row)}
    equations, numbers = [], []
    for row in rows:
        at = arm = address = 0
        if row in special_at:
            k = special_at[row]
            entry = system.special[k]
            equation, (i, j, _, motion) = SPECIAL, entry[:4]
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
