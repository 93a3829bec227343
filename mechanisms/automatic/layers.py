"""The order of layers: a layer for each body so that nothing collides and no pin goes through a third body.

A search that goes back (branch and bound) over the bodies, first with one layer, then with more. Its rules are pairs
of items that meet in the plane: their heights must not. A pin's heights are known in part as soon as one of its
bodies is placed, so most wrong choices are seen at once. Same model, same layers: nothing here depends on time or
chance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mechanisms.automatic.items import TOP, Item, PinReach, spans_meet

TRIES = 60_000
"""Choices that are tried with a given number of layers before more layers are taken."""


@dataclass
class _Search:
    order: list[str]
    items: Sequence[Item]
    rules: dict[str, list[tuple[int, int]]]
    """By body, the conflicts that may come up when it is placed."""
    pins: dict[str, list[int]]
    count: int
    fixed: Mapping[str, int]
    choices: Sequence[str]
    groups: Mapping[str, Sequence[str]]
    """By the first of bodies that share a layer, all of them."""
    left: int
    best: dict[str, int] | None = None
    cost: float = float("inf")

    def run(self) -> None:
        self._place(0, {}, 0.0)

    def _place(self, index: int, levels: dict[str, int], low: float) -> None:
        if index == len(self.order):
            self.best, self.cost = dict(levels), low
            return
        body = self.order[index]
        group = self.groups.get(body, (body,))
        wished = {self.fixed[member] for member in group if member in self.fixed}
        options: Sequence[int] = sorted(wished)[:1] if wished else range(2 if body in self.choices else self.count)
        ranked: list[tuple[float, int]] = []
        for level in options:
            levels.update(dict.fromkeys(group, level))
            if not any(self._clash(member, levels) for member in group):
                ranked.append((low + self._growth(group, levels), level))
            _remove(levels, group)
        for cost, level in sorted(ranked):
            if self.left <= 0 or cost >= self.cost:
                return
            self.left -= 1
            levels.update(dict.fromkeys(group, level))
            self._place(index + 1, levels, cost)
            _remove(levels, group)

    def _clash(self, body: str, levels: dict[str, int]) -> bool:
        spans: dict[int, tuple[int, int] | None] = {}
        for i, j in self.rules[body]:
            for k in (i, j):
                if k not in spans:
                    spans[k] = self.items[k].reach.span(levels)
            if spans_meet(spans[i], spans[j]):
                return True
        return False

    def _growth(self, group: Sequence[str], levels: dict[str, int]) -> float:
        """How much longer the pins get by placing a group of bodies, and a little for its own height."""
        level = levels[group[0]]
        total = (0.3 if group[0] in self.choices else 0.01) * level
        pins = {k for body in group for k in self.pins[body]}
        total += sum(_length(self.items[k].reach.span(levels)) for k in pins)
        _remove(levels, group)
        total -= sum(_length(self.items[k].reach.span(levels)) for k in pins)
        levels.update(dict.fromkeys(group, level))
        return total


def _remove(levels: dict[str, int], group: Sequence[str]) -> None:
    for body in group:
        del levels[body]


def _length(span: tuple[int, int] | None) -> int:
    return 0 if span is None or span[1] == TOP else span[1] - span[0]


def find_layers(
    bodies: Sequence[str],
    items: Sequence[Item],
    conflicts: Sequence[tuple[int, int]],
    fixed: Mapping[str, int] | None = None,
    most: int | None = None,
    tries: int = TRIES,
    together: Sequence[tuple[str, str]] = (),
) -> dict[str, int] | None:
    """The layer of each body, from 0 up, and the choices; None where no order was found with up to ``most`` layers.

    ``conflicts`` are indices of items that meet in the plane; ``fixed`` gives bodies their layer. The fewest layers
    that do, and with these the shortest pins.
    """
    fixed = fixed or {}
    most = most or len(bodies) + 1
    choices = list(dict.fromkeys(item.reach.choice for item in items if isinstance(item.reach, PinReach)))
    rules: dict[str, list[tuple[int, int]]] = {name: [] for name in (*bodies, *choices)}
    for i, j in conflicts:
        for name in {*_scope(items[i]), *_scope(items[j])} & rules.keys():
            rules[name].append((i, j))
    pins = {name: [k for k, item in enumerate(items) if name in _scope(item)] for name in rules}
    groups = _groups(bodies, together)
    order = _with_choices(_ordered(bodies, items, conflicts), items, groups)
    for count in range(max([1, *(level + 1 for level in fixed.values())]), most + 1):
        search = _Search(order, items, rules, pins, count, fixed, choices, groups, tries)
        search.run()
        if search.best is not None:
            return search.best
    return None


def _scope(item: Item) -> tuple[str, ...]:
    """The bodies and the choice that an item's heights depend on."""
    reach = item.reach
    return (*reach.bodies, reach.choice) if isinstance(reach, PinReach) else reach.bodies


def _groups(bodies: Sequence[str], together: Sequence[tuple[str, str]]) -> dict[str, list[str]]:
    """Bodies that share a layer, by their first one."""
    first = {body: body for body in bodies}
    for a, b in together:
        old, new = first[b], first[a]
        first = {body: new if head == old else head for body, head in first.items()}
    found: dict[str, list[str]] = {}
    for body in bodies:
        found.setdefault(first[body], []).append(body)
    return {members[0]: members for members in found.values()}


def _with_choices(order: Sequence[str], items: Sequence[Item], groups: Mapping[str, Sequence[str]]) -> list[str]:
    """Bodies that share a layer once, where the first of them is; each choice right after the last of its bodies."""
    head = {member: members[0] for members in groups.values() for member in members}
    found = list(dict.fromkeys(head[body] for body in order))
    for item in items:
        if isinstance(item.reach, PinReach) and item.reach.choice not in found:
            last = max(found.index(head[body]) for body in item.reach.bodies)
            found.insert(last + 1, item.reach.choice)
    return found


def _ordered(bodies: Sequence[str], items: Sequence[Item], conflicts: Sequence[tuple[int, int]]) -> list[str]:
    """Bodies so that each has many rules with those before it."""
    shared: dict[str, dict[str, int]] = {body: {} for body in bodies}
    for i, j in conflicts:
        scope = [body for body in {*items[i].reach.bodies, *items[j].reach.bodies} if body in shared]
        for a in scope:
            for b in scope:
                if a != b:
                    shared[a][b] = shared[a].get(b, 0) + 1
    order: list[str] = []
    waiting = list(bodies)
    while waiting:
        chosen = max(
            waiting,
            key=lambda body: (
                sum(shared[body].get(done, 0) for done in order),
                sum(shared[body].values()),
                -bodies.index(body),
            ),
        )
        order.append(chosen)
        waiting.remove(chosen)
    return order
