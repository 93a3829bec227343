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
        options = [self.fixed[body]] if body in self.fixed else range(2 if body in self.choices else self.count)
        ranked = []
        for level in options:
            levels[body] = level
            if not self._clash(body, levels):
                ranked.append((low + self._growth(body, levels), level))
            del levels[body]
        for cost, level in sorted(ranked):
            if self.left <= 0 or cost >= self.cost:
                return
            self.left -= 1
            levels[body] = level
            self._place(index + 1, levels, cost)
            del levels[body]

    def _clash(self, body: str, levels: dict[str, int]) -> bool:
        spans: dict[int, tuple[int, int] | None] = {}
        for i, j in self.rules[body]:
            for k in (i, j):
                if k not in spans:
                    spans[k] = self.items[k].reach.span(levels)
            if spans_meet(spans[i], spans[j]):
                return True
        return False

    def _growth(self, body: str, levels: dict[str, int]) -> float:
        """How much longer the pins get by placing ``body``, and a little for its own height."""
        total = (0.3 if body in self.choices else 0.01) * levels[body]
        for k in self.pins[body]:
            after = self.items[k].reach.span(levels)
            level = levels.pop(body)
            before = self.items[k].reach.span(levels)
            levels[body] = level
            total += _length(after) - _length(before)
        return total


def _length(span: tuple[int, int] | None) -> int:
    return 0 if span is None or span[1] == TOP else span[1] - span[0]


def find_layers(
    bodies: Sequence[str],
    items: Sequence[Item],
    conflicts: Sequence[tuple[int, int]],
    fixed: Mapping[str, int] | None = None,
    most: int | None = None,
    tries: int = TRIES,
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
    order = _with_choices(_ordered(bodies, items, conflicts), items)
    for count in range(max([1, *(level + 1 for level in fixed.values())]), most + 1):
        search = _Search(order, items, rules, pins, count, fixed, choices, tries)
        search.run()
        if search.best is not None:
            return search.best
    return None


def _scope(item: Item) -> tuple[str, ...]:
    """The bodies and the choice that an item's heights depend on."""
    reach = item.reach
    return (*reach.bodies, reach.choice) if isinstance(reach, PinReach) else reach.bodies


def _with_choices(order: Sequence[str], items: Sequence[Item]) -> list[str]:
    """Each choice right after the last of its bodies."""
    found = list(order)
    for item in items:
        if isinstance(item.reach, PinReach) and item.reach.choice not in found:
            last = max(found.index(body) for body in item.reach.bodies)
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
