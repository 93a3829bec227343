"""The order of layers: a layer for each body so that nothing collides and no pin goes through a third body.

The rules are pairs of items that meet in the plane: their heights must not. A solver of boolean satisfiability finds
whether there is an order at all, then one with the fewest pivots on bridges, then with the fewest layers, then with the
shortest pins; what is still open then is decided by the lowest layers, the first bodies first. Where all of this is
proven, the layers do not depend on the solver; where its budget ends before, they are what it found, the same each
time: nothing here depends on clocks or chance. Large machines come to an end, too: a :class:`purse.Purse` says how
much the search may cost in all.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field

from mechanisms.stages.automatic.layout.items import Item, PivotReach, Reach
from mechanisms.stages.automatic.layout.order.layer_clauses import Clauses, choices_of
from mechanisms.stages.automatic.layout.order.purse import Purse

BUDGET = 20_000
"""Conflicts of the solver that one question may cost, beside the question whether there is any order."""
PURSE = 60_000
"""Conflicts that the choice of the best of all orders with so many layers may cost."""
MANY = 24
"""With more bodies, few layers are tried before it is asked whether there is any order, with less to spend, and ties
are left open.
"""
LESS = 20
"""So much less to spend."""


@dataclass(frozen=True)
class Problem:
    """Bodies, items, and which of them meet in the plane; ``fixed`` gives bodies their layer."""

    bodies: Sequence[str]
    items: Sequence[Item]
    conflicts: Sequence[tuple[int, int]]
    fixed: Mapping[str, int] = field(default_factory=dict)
    together: Sequence[tuple[str, str]] = ()
    """Pairs that share a layer."""
    hanging: frozenset[str] = frozenset()
    """Choices of those pivots on ground that may hang from a bridge."""

    between: Sequence[tuple[str, str, tuple[str, ...]]] = ()
    """Two of which one is below some others and the other above these."""

    @property
    def heads(self) -> dict[str, str]:
        """The first of the bodies that share a layer, by body."""
        first = {body: body for body in self.bodies}
        for a, b in self.together:
            old, new = first[b], first[a]
            first = {body: new if head == old else head for body, head in first.items()}
        return first

    @property
    def most(self) -> int:
        """So many layers are enough for every order: each a step above the last, as high as items need at most."""
        ends = [pair for item in self.items for both in item.reach.ends.values() for pair in both]
        lowest = min((low for low, _ in ends if low is not None), default=0)
        highest = max((high for _, high in ends if high is not None), default=0)
        step = max((highest - lowest) // 2 + 1, 1)
        fixed = max((level + step for level in self.fixed.values()), default=0)
        return 1 + step * (len(set(self.heads.values())) - 1) + fixed

    def clauses(self, count: int, keys: Sequence[Hashable] = ()) -> Clauses:
        """All rules with ``count`` layers; ``keys`` gives each conflict one, and only those assumed by it count."""
        made = Clauses(self.heads, choices_of(self.items), count)
        for body, level in self.fixed.items():
            made.add(made.at_least(body, level))
            made.add(-made.at_least(body, level + 1))
        for pivot in self._pivots:
            if pivot.choice not in self.hanging:
                made.add(-made.choices[pivot.choice])
        for low, high, runners in self.between:
            made.between(low, high, runners)
        for k, (i, j) in enumerate(self.conflicts):
            made.apart(self.items[i].reach, self.items[j].reach, keys[k] if keys else None)
        return made

    @property
    def _pivots(self) -> list[PivotReach]:
        return [item.reach for item in self.items if isinstance(item.reach, PivotReach)]

    def bridged(self, clauses: Clauses, driven: bool = False) -> list[int]:
        """Literals that are true for pivots (for driven ones) on bridges."""
        pivots = [pivot for pivot in self._pivots if pivot.driven or not driven]
        return [clauses.choices[name] for name in dict.fromkeys(pivot.choice for pivot in pivots)]

    @property
    def clique(self) -> int:
        """So many layers are needed at least: bodies whose plates all meet each other, found greedily."""
        meet: dict[str, set[str]] = {head: set() for head in self.heads.values()}
        for i, j in self.conflicts:
            a, b = self.items[i].reach, self.items[j].reach
            if a == Reach(a.bodies[:1]) and b == Reach(b.bodies[:1]) and a.bodies and b.bodies:
                first, second = self.heads[a.bodies[0]], self.heads[b.bodies[0]]
                if first != second:
                    meet[first].add(second)
                    meet[second].add(first)
        most = 1
        for start in meet:
            clique, left = 1, meet[start]
            while left:
                chosen = max(left, key=lambda body: (len(meet[body] & left), body))
                clique, left = clique + 1, left & meet[chosen]
            most = max(most, clique)
        return most


def find_layers(problem: Problem, purse: Purse | None = None) -> dict[str, int] | None:
    """The layer of each body, from 0 up, and the choices; None where there is no order, with any number of layers.

    Raises Undecided where the purse, a new one if none is given, is empty before that is known.
    """
    purse = purse or Purse()
    least = max([problem.clique, *(level + 1 for level in problem.fixed.values())])
    few, bridges = len(set(problem.heads.values())) <= MANY, 0
    if few or problem.hanging:
        bridges = _fewest_bridges(problem, purse)
        if bridges is None:
            return None
    elif _is_impossible(problem):
        return None
    for count in range(least, problem.most):
        order = _within(problem, count, bridges, BUDGET if few else BUDGET // LESS)
        if order is not None:
            return order
    return _within(problem, problem.most, bridges, purse)


def _is_impossible(problem: Problem) -> bool:
    """Whether it is soon seen that there is no order, of however many layers."""
    clauses = problem.clauses(problem.most)
    answer = clauses.solved(budget=BUDGET)
    clauses.close()
    return answer is False


def _fewest_bridges(problem: Problem, purse: Purse) -> int | None:
    """How many pivots must hang from bridges; None if there is no order."""
    clauses = problem.clauses(problem.most)
    literals = problem.bridged(clauses)
    if not purse.solved(clauses):
        return None
    fewest = sum(map(clauses.holds, literals))
    total = clauses.count_of(literals, len(literals))
    while fewest and purse.solved(clauses, [-total[fewest - 1]]):
        fewest = sum(map(clauses.holds, literals))
    clauses.close()
    return fewest


def _within(problem: Problem, count: int, bridges: int, budget: int | Purse) -> dict[str, int] | None:
    """The best order with ``count`` layers and as many bridges; None if there is none, or none found."""
    clauses = problem.clauses(count)
    literals = problem.bridged(clauses)
    if bridges < len(literals):
        clauses.add(-clauses.count_of(literals, bridges + 1)[bridges])
    if not (budget.solved(clauses) if isinstance(budget, Purse) else clauses.solved(budget=budget)):
        clauses.close()
        return None
    few = len(clauses.steps) <= MANY
    purse = clauses.spent + (PURSE if few else PURSE // LESS)
    crossings = clauses.crossings(problem.items)
    clauses.solved()
    for wish in (
        problem.bridged(clauses, driven=True),
        crossings,
        [clauses.choices[choice] for choice in choices_of(problem.items)],
        [step for steps in clauses.steps.values() for step in steps] if few else [],
    ):
        _lower(clauses, wish, purse)
    if few:
        _settle(clauses, [*_highest_first(clauses.steps), *clauses.choices.values()])
    chosen = {body: clauses.layer(body) for body in problem.bodies}
    chosen |= {choice: int(clauses.holds(literal)) for choice, literal in clauses.choices.items()}
    clauses.close()
    return chosen


def _lower(clauses: Clauses, literals: Sequence[int], purse: int) -> None:
    """Let as few of ``literals`` be true as the solver finds, and keep to that; the model is the best one."""
    count = sum(map(clauses.holds, literals))
    if count == 0:
        for literal in literals:
            clauses.add(-literal)
        return
    total = clauses.count_of(literals, count)
    while count and clauses.spent < purse and clauses.solved([-total[count - 1]], BUDGET):
        count = sum(map(clauses.holds, literals))
    if count < len(total):
        clauses.add(-total[count])
    clauses.solved()


def _settle(clauses: Clauses, literals: Sequence[int]) -> None:
    """Let the first literal be false if it can be, then the next: one model of many is the same everywhere."""
    for literal in literals:
        if not clauses.holds(literal) or clauses.solved([-literal], BUDGET):
            clauses.add(-literal)
        else:
            clauses.solved()


def _highest_first(steps: Mapping[str, Sequence[int]]) -> list[int]:
    """The highest step of each body first."""
    return [step for own in steps.values() for step in reversed(own)]


def blocking[Key: Hashable](problem: Problem, keys: Sequence[Key], purse: Purse | None = None) -> list[Key]:
    """Keys of conflicts that leave no order; without any one of them there would be one. ``keys``: one per conflict.

    Raises Undecided as :func:`find_layers`.
    """
    clauses = problem.clauses(problem.most, keys)
    kept = list(dict.fromkeys(keys))
    literals = {key: clauses.keys[key] for key in kept}
    if (purse or Purse()).solved(clauses, list(literals.values())):
        raise ValueError("there is an order of layers")
    kept = _core(clauses, literals, kept)
    for key in list(kept):
        fewer = [other for other in kept if other != key]
        if key in kept and clauses.solved([literals[other] for other in fewer], BUDGET) is False:
            kept = _core(clauses, literals, fewer)
    clauses.close()
    return kept


def _core[Key: Hashable](clauses: Clauses, literals: Mapping[Key, int], kept: Sequence[Key]) -> list[Key]:
    """Those of ``kept`` that the solver needed to see that there is no order."""
    core = set(clauses.solver.get_core() or ())
    return [key for key in kept if literals[key] in core]
