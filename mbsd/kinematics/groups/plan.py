"""Decomposition of a mechanism into groups from ground: always the first with known neighbours.

A mechanism with anything that no group covers (a gear, a redundant joint, three bodies rigid only together) has no
such plan; parts.py puts blocks between the groups.
"""

from __future__ import annotations

import copy
import heapq
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.running import Kept
from mbsd.kinematics.groups.blocks import BLOCK, BODIES, BODY, TRAIN, TREE_AT, Blocks
from mbsd.kinematics.groups.groups import NUMBERS, Groups, Link, Made, Places
from mbsd.kinematics.groups.tables import KINDS, NAMES, tables_of
from mbsd.model.joint import Joint

LETTERS = {
    ("point",): "R",
    ("slot", "angle"): "P",
    ("point", "angle"): "W",
    ("slot",): "S",
    ("angle",): "D",
    ("distance",): "L",
    ("along",): "A",
}
"""Letters of joints and drivers in groups, by their constraints: pin, slide, weld, slot, driver of an angle, rod or
actuator, driver along an axis.
"""
DRIVERS = "DA"
"""Letters that only a driver has; a distance is a rod or an actuator."""


def plan_groups(packed: Packed, q0: np.ndarray, redundant_rows: int) -> Groups | None:
    """Return the groups of a mechanism at its closed pose q0 (3 nb,), or None where it has no such plan."""
    if redundant_rows:
        return None
    numbers = packed.numbers()
    if numbers is None:
        return _planned(packed, q0)
    kinds = [(*joint.kind.constraints, joint.kind.driven) for joint in packed.joints]
    groups = _GROUPS.get((*numbers, q0.tobytes(), *kinds), lambda: _planned(packed, q0))
    return None if groups is None else Groups(*[part.copy() for part in groups])


_GROUPS: Kept[Groups | None] = Kept()
"""Plans by all that they depend on."""


def _planned(packed: Packed, q0: np.ndarray) -> Groups | None:
    """Return the groups of a mechanism without a look at those kept; None without such a plan."""
    links = links_of(packed)
    if links is None:
        return None
    plan = Plan(packed, q0.reshape(-1, 3), links)
    plan.grow()
    return plan.groups() if plan.complete else None


def describe(groups: Groups, blocks: Blocks, names: list[str]) -> str:
    """Return the plan in words: ``driven crank; RRR coupler, rocker``."""
    parts = []
    for kind, bodies, motion in zip(groups.kind, groups.body, groups.motion, strict=True):
        if kind == BLOCK:
            head = blocks.head[motion]
            own = blocks.tree[head[TREE_AT] : head[TREE_AT] + head[BODIES], BODY]
            parts.append(f"Newton-Raphson {', '.join(names[b] for b in sorted(own))}")
        elif kind == TRAIN:
            parts.append(f"train {names[bodies[0]]}")
        else:
            parts.append(f"{NAMES[kind]} {', '.join(names[b] for b in bodies[:2] if b >= 0)}")
    return "; ".join(parts)


def links_of(packed: Packed) -> list[list[Link]] | None:
    """Return (nb,) links of each body; None if a joint is of a kind that no group covers."""
    everything = range(len(packed.joints))
    if any(link_kind(packed.joints[number]) is None for number in everything):
        return None
    return links_of_joints(packed, everything)


def link_kind(joint: Joint) -> str | None:
    """Return how groups call a joint or driver; None if none covers it."""
    kind = LETTERS.get(tuple(joint.kind.constraints))
    return None if kind is None or ((kind in DRIVERS) != joint.kind.driven and kind != "L") else kind


def links_of_joints(packed: Packed, numbers: Iterable[int]) -> list[list[Link]]:
    """Return (nb,) links of each body by these joints, as far as groups cover them."""
    system = packed.system
    links: list[list[Link]] = [[] for _ in packed.body_names]
    angle_at = {int(row[2]): k for k, row in enumerate(system.angle)}
    rod_at = {int(row[2]): k for k, row in enumerate(system.distance)}
    for number in numbers:
        kind = link_kind(packed.joints[number])
        if kind is None:
            continue
        i, j = (int(marker) for marker in packed.markers[number])
        offset, motion = 0.0, packed.motion_of(number)
        for row in packed.rows_of(number):
            if row in angle_at:
                offset = float(system.angle_offset[angle_at[row]])
            if row in rod_at:
                offset = float(system.distance_length[rod_at[row]])
        bi, bj = int(system.marker_body[i]), int(system.marker_body[j])
        links[bi].append(Link(number, kind, i, j, True, bj, offset, motion))
        links[bj].append(Link(number, kind, j, i, False, bi, offset, motion))
    return links


class Recipe(NamedTuple):
    """The recipe by which a group was planned."""

    make: Callable[..., Made | None]
    bodies: tuple[int, ...]
    links: tuple[Link, ...]
    by_letter: bool
    """True if ``make`` takes its links by their letters."""

    def build(self, at: Places, links: Sequence[Link]) -> Made | None:
        """Return the group, from links that stand for its own."""
        return self.make(at, *self.bodies, *([{link.kind: link for link in links}] if self.by_letter else links))


class Plan:
    """Growing plan: ``known`` bodies have places in ``taken`` groups, ``used`` joints hold them.

    Only bodies near to which something has become known are looked at again.
    """

    def __init__(self, packed: Packed, pose: np.ndarray, links: list[list[Link]]) -> None:
        self.packed, self.links, self.places = packed, links, Places(packed.system, pose)
        self.known, self.used = {0}, set[int]()
        self.taken: list[Made] = []
        self.recipes: list[Recipe | None] = []
        self.singles = list(range(1, len(links)))
        self.pairs = list(self.singles)

    def copy(self) -> Plan:
        """Return a plan of its own to go on with."""
        out = copy.copy(self)
        out.links = list(self.links)
        out.known, out.used, out.taken = set(self.known), set(self.used), list(self.taken)
        out.recipes = list(self.recipes)
        out.singles, out.pairs = list(self.singles), list(self.pairs)
        return out

    @property
    def complete(self) -> bool:
        """True if all bodies are known and all joints used."""
        return len(self.known) == len(self.links) and self.used.issuperset(range(len(self.packed.joints)))

    def grow(self) -> None:
        """Add groups until there is none to add."""
        while len(self.known) < len(self.links) and (self.add_single() or self.add_pair()):
            pass

    def hold(self, body: int, links: list[Link]) -> None:
        """Add links of an unknown body, e.g. one that drives it."""
        self.links[body] = [*self.links[body], *links]
        heapq.heappush(self.singles, body)

    def groups(self) -> Groups:
        """Return the groups as tables."""
        return tables_of(self.taken)

    def add_single(self) -> bool:
        """Add a group of one body, if there is one."""
        while self.singles:
            body = heapq.heappop(self.singles)
            if body in self.known:
                continue
            links = [link for link in self.links[body] if link.other in self.known]
            kinds = "".join(sorted(link.kind for link in links))
            by_kind = {link.kind: link for link in links}
            for kind in KINDS:
                made = kind.of_one(self.places, body, by_kind) if kinds in kind.one and kind.of_one else None
                if made is not None:
                    assert kind.of_one is not None
                    self._use(made, Recipe(kind.of_one, (body,), tuple(links), by_letter=True))
                    return True
        return False

    def add_pair(self) -> bool:
        """Add a group of two bodies, if there is one."""
        while self.pairs:
            a = heapq.heappop(self.pairs)
            if a in self.known:
                continue
            outer_a = [link for link in self.links[a] if link.other in self.known]
            if len(outer_a) != 1:
                continue
            for inner in self.links[a]:
                b = inner.other
                if b in self.known or b == a:
                    continue
                outer_b = [link for link in self.links[b] if link.other in self.known]
                between = [link for link in self.links[a] if link.other == b]
                if len(outer_b) != 1 or len(between) != 1:
                    continue
                links = (outer_a[0], inner, outer_b[0])
                kinds = "".join(link.kind for link in links)
                for kind in KINDS:
                    made = kind.of_two(self.places, a, b, *links) if kinds in kind.two and kind.of_two else None
                    if made is not None:
                        assert kind.of_two is not None
                        self._use(made, Recipe(kind.of_two, (a, b), links, by_letter=False))
                        return True
        return False

    def numbers(self) -> np.ndarray:
        """Return (g, 14) numbers of the groups."""
        out = np.zeros((len(self.taken), NUMBERS))
        for row, (_, _, _, numbers) in zip(out, self.taken, strict=True):
            row[: len(numbers)] = numbers
        return out

    def remade(self, packed: Packed) -> np.ndarray | None:
        """Return (g, 14) numbers of these groups for other numbers; None if a group is not of links.

        Signs of roots are those of the pose of this plan.
        """
        at, joints, links = Places(packed.system, self.places.pose), len(packed.joints), None
        if not self._same_offsets(packed):
            links = {(link.joint, link.first): link for own in links_of_joints(packed, range(joints)) for link in own}
        out = np.zeros((len(self.taken), NUMBERS))
        for row, recipe, (code, bodies, _, _) in zip(out, self.recipes, self.taken, strict=True):
            if recipe is None:
                return None
            own = recipe.links
            if links is not None:
                own = [link if link.joint >= joints else links[link.joint, link.first] for link in own]
            made = recipe.build(at, own)
            if made is None or made[:2] != (code, bodies):
                return None
            row[: len(made[3])] = made[3]
        return out

    def _same_offsets(self, packed: Packed) -> bool:
        """Return True if angles between bodies and rod lengths are those of this plan, so links are too."""
        pairs = [(getattr(part.system, name) for part in (packed, self.packed))
                 for name in ("angle_offset", "distance_length")]  # fmt: skip
        return all(a.tobytes() == b.tobytes() for a, b in pairs)

    def _use(self, made: Made, recipe: Recipe) -> None:
        self.used.update(link.joint for link in recipe.links)
        self.add_group(made, recipe.bodies, recipe)

    def add_group(self, made: Made, bodies: Sequence[int], recipe: Recipe | None = None) -> None:
        """Add a group, whose bodies are then known."""
        self.taken.append(made)
        self.recipes.append(recipe)
        self.known.update(bodies)
        near = {link.other for body in bodies for link in self.links[body]} - self.known
        for body in near:
            heapq.heappush(self.singles, body)
        beside = {link.other for body in near for link in self.links[body]} - self.known
        for body in near | beside:
            heapq.heappush(self.pairs, body)
