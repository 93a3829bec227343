"""The order of layers: clauses of a SAT problem, the search for an order, and the search's budget."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from pysat.card import ITotalizer
from pysat.solvers import Solver

from mechanisms.stages.automatic.layout.items import BASE, AnyReach, Ends, Item, PivotReach, Reach

# The rules of the layers as clauses for a satisfiability solver.
#
# A layer is set by the literals "at least k", k = 1, 2, ... (order encoding). Two items that meet in the plane are
# apart where one is below the other: the difference of two layers is at least a number, for all bodies that the items'
# ends depend on. Each such difference is a literal that implies one clause for every layer, so unit propagation alone
# finds every circle of bodies each above the next. (Tamura et al., Compiling finite linear CSP into SAT, Constraints
# 14, 2009.)

METHOD = "glucose4"
TRUE = 1


class Clauses:
    """Variables for choices and for the layers of bodies, below ``count``.

    Bodies that share a layer have those of the first one.

    Ask :meth:`solved`, then read the model by :meth:`layer` and :meth:`chosen`.
    """

    def __init__(self, heads: Mapping[str, str], choices: Sequence[str], count: int) -> None:
        self.heads, self.count = heads, count
        self.solver = Solver(name=METHOD, bootstrap_with=[[TRUE]])
        self.last = TRUE
        self.steps = {head: [self.new() for _ in range(count - 1)] for head in dict.fromkeys(heads.values())}
        for steps in self.steps.values():
            for low, high in pairwise(steps):
                self.add(low, -high)
        self.choices = {choice: self.new() for choice in choices}
        self.keys: dict[Hashable, int] = {}
        """Literals that say of rules with a key that they count."""
        self._differences: dict[tuple[str, str, int], int] = {}
        self._model: set[int] = set()

    def new(self) -> int:
        """Return a new literal."""
        self.last += 1
        return self.last

    def add(self, *literals: int) -> None:
        """At least one of these is true."""
        self.solver.add_clause(literals)

    def at_least(self, body: str, level: int) -> int:
        """Return the literal that a body's layer is ``level`` or higher."""
        if level <= 0:
            return TRUE
        return self.steps[self.heads[body]][level - 1] if level < self.count else -TRUE

    def above(self, low: str | None, high: str | None, by: int) -> int:
        """Return a literal that implies that ``high`` is ``by`` layers above ``low``.

        None is a body on layer 0.
        """
        if low is None or high is None:
            if low is high:
                return TRUE if by <= 0 else -TRUE
            return self.at_least(high, by) if high is not None else -self.at_least(str(low), 1 - by)
        key = self.heads[low], self.heads[high], by
        if key[0] == key[1]:
            return TRUE if by <= 0 else -TRUE
        if key not in self._differences:
            literal = self._differences[key] = self.new()
            for level in range(self.count + 1):
                if level + by > 0:
                    self.add(-literal, -self.at_least(low, level), self.at_least(high, level + by))
        return self._differences[key]

    def between(self, low: str, high: str, runners: Sequence[str]) -> None:
        """One of two bodies is below all ``runners``, the other above them."""
        up = self.new()
        for runner in runners:
            for given, under, over in ((-up, low, high), (up, high, low)):
                self.add(given, self.above(under, runner, 1))
                self.add(given, self.above(runner, over, 1))

    def apart(self, first: AnyReach, second: AnyReach, key: Hashable = None) -> None:
        """Two items share no height; with a ``key`` only where its literal is true."""
        first_below, second_below = self.new(), self.new()
        self._below(first_below, first, second)
        self._below(second_below, second, first)
        if key is None:
            self.add(first_below, second_below)
            return
        if key not in self.keys:
            self.keys[key] = self.new()
        self.add(-self.keys[key], first_below, second_below)

    def _below(self, literal: int, first: AnyReach, second: AnyReach) -> None:
        for mine, (_, high) in self._ends(first):
            for yours, (low, _) in self._ends(second):
                given = [-literal, *mine, *yours]
                if low is None or high is None:
                    self.add(*given)
                    continue
                by = (high - low) // 2 + 1
                for a in self._layered(first) or (None,):
                    for b in self._layered(second) or (None,):
                        self.add(*given, self.above(a, b, by))

    def _ends(self, reach: AnyReach) -> list[tuple[list[int], Ends]]:
        """Return ends of an item, each with literals of which one is true where the choice is another."""
        if reach.choice is None:
            # without bodies an item with a base is on the base
            return [([], reach.ends[0] if self._layered(reach) else (None, BASE))]
        literal = self.choices[reach.choice]
        return [([literal], reach.ends[0]), ([-literal], reach.ends[1])]

    def _layered(self, reach: AnyReach) -> tuple[str, ...]:
        """Return the bodies of an item that have a layer."""
        return tuple(body for body in reach.bodies if body in self.heads)

    def crossings(self, items: Sequence[Item]) -> list[int]:
        """Return literals that are true for every step from a layer to the next that a pin goes through."""
        literals: list[int] = []
        for item in items:
            choice, (low, high) = item.reach.choice, item.reach.ends[0]
            bodies = tuple(dict.fromkeys(self.heads[body] for body in self._layered(item.reach)))
            if low is not None:
                literals += [] if high is None else self._crossed(bodies, bodies, [])
                continue
            given = [] if choice is None else [self.choices[choice]]
            literals += self._crossed((None,), bodies, given)
            if choice is not None:
                literals += self._crossed(bodies, (None,), [-given[0]])
        return literals

    def _crossed(self, lows: Sequence[str | None], highs: Sequence[str | None], given: Sequence[int]) -> list[int]:
        """Return the span from the lowest to the highest of bodies.

        None is what is below, or above, all of them.
        """
        if lows == highs and len(lows) < 2:
            return []
        literals = [self.new() for _ in range(self.count - 1)]
        for level, literal in enumerate(literals, start=1):
            for a in lows:
                for b in highs:
                    if a is None or a != b:
                        below = [] if a is None else [self.at_least(a, level)]
                        above = [] if b is None else [-self.at_least(b, level)]
                        self.add(literal, *below, *above, *given)
        return literals

    def count_of(self, literals: Sequence[int], most: int) -> list[int]:
        """Return literals r[k] that are true if more than k of ``literals`` are, k up to ``most``."""
        if not literals:
            return []
        total = ITotalizer(lits=list(literals), ubound=most, top_id=self.last)
        for clause in total.cnf.clauses:
            self.solver.add_clause(clause)
        self.last = max(self.last, total.top_id)
        return list(total.rhs)

    def solved(self, assumed: Sequence[int] = (), budget: int | None = None) -> bool | None:
        """Return True if there is a model under assumptions; None if ``budget`` conflicts do not decide."""
        if budget is None:
            answer = self.solver.solve(assumptions=assumed)
        else:
            self.solver.conf_budget(budget)
            answer = self.solver.solve_limited(assumptions=assumed)
        if answer:
            self._model = {literal for literal in self.solver.get_model() or () if literal > 0}
        return answer

    @property
    def spent(self) -> int:
        """Conflicts of the solver so far."""
        return (self.solver.accum_stats() or {})["conflicts"]

    def holds(self, literal: int) -> bool:
        """Return True if the literal holds in the solver's model."""
        return (abs(literal) in self._model) == (literal > 0)

    def layer(self, body: str) -> int:
        """Return the layer of a body in the solver's model."""
        return sum(self.holds(step) for step in self.steps[self.heads[body]])

    def close(self) -> None:
        """Free the solver's memory."""
        self.solver.delete()


def choices_of(items: Sequence[Item]) -> list[str]:
    """Return the choices of items, without repeats."""
    return list(dict.fromkeys(c for item in items if (c := item.reach.choice) is not None))


# The budget of the search for layers, in conflicts of the solver: no clock, so it ends the same everywhere.

ALL = 500_000
"""Conflicts that the whole search for the parts of one mechanism may cost: some hundred times what it takes."""


class Undecided(Exception):
    """The purse is empty, and whether there is an order of layers is not known."""


@dataclass
class Purse:
    """Conflicts of the solver that are left for questions which have no budget of their own."""

    left: int = ALL

    def solved(self, clauses: Clauses, assumed: Sequence[int] = ()) -> bool:
        """Return True if there is a model. Raises Undecided where the purse does not last."""
        before = clauses.spent
        answer = clauses.solved(assumed, max(self.left, 1))
        self.left -= clauses.spent - before
        if answer is None:
            raise Undecided
        return answer


# The order of layers: a layer for each body so that nothing collides and no pin goes through a third body.
#
# The rules are pairs of items that meet in the plane: their heights must not. A solver of boolean satisfiability finds
# whether there is an order at all, then one with the fewest pivots on bridges, then with the fewest layers, then with
# the shortest pins; what is still open then is decided by the lowest layers, the first bodies first. Where all of this
# is proven, the layers do not depend on the solver; where its budget ends before, they are what it found, the same each
# time: nothing here depends on clocks or chance. Large machines come to an end, too: a :class:`purse.Purse` says how
# much the search may cost in all.

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
        """So many layers are enough: each a step above the last, as high as items need at most."""
        ends = [pair for item in self.items for pair in item.reach.ends]
        lowest = min((low for low, _ in ends if low is not None), default=0)
        highest = max((high for _, high in ends if high is not None), default=0)
        step = max((highest - lowest) // 2 + 1, 1)
        fixed = max((level + step for level in self.fixed.values()), default=0)
        return 1 + step * (len(set(self.heads.values())) - 1) + fixed

    def clauses(self, count: int, keys: Sequence[Hashable] = ()) -> Clauses:
        """Return all rules with ``count`` layers.

        ``keys`` gives each conflict one, and only those assumed by it count.
        """
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
        """Return literals that are true for pivots (for driven ones) on bridges."""
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
    """Return the layer of each body, from 0 up, and the choices.

    None where there is no order, with any number of layers.

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
    """Return True if it is soon seen that there is no order, of however many layers."""
    clauses = problem.clauses(problem.most)
    answer = clauses.solved(budget=BUDGET)
    clauses.close()
    return answer is False


def _fewest_bridges(problem: Problem, purse: Purse) -> int | None:
    """Return how many pivots must hang from bridges; None if there is no order."""
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
    """Return the best order with ``count`` layers and as many bridges.

    None if there is none, or none found.
    """
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
        highest_first = [step for steps in clauses.steps.values() for step in reversed(steps)]
        _settle(clauses, [*highest_first, *clauses.choices.values()])
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
    """Let the first literal be false if it can be, then the next.

    So one model of many is the same everywhere.
    """
    for literal in literals:
        if not clauses.holds(literal) or clauses.solved([-literal], BUDGET):
            clauses.add(-literal)
        else:
            clauses.solved()


def blocking[Key: Hashable](problem: Problem, keys: Sequence[Key], purse: Purse | None = None) -> list[Key]:
    """Return keys of conflicts that leave no order; without any one of them there would be one.

    ``keys``: one per conflict.

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
    """Return the keys of ``kept`` that the solver needed to prove that no order exists."""
    core = set(clauses.solver.get_core() or ())
    return [key for key in kept if literals[key] in core]
