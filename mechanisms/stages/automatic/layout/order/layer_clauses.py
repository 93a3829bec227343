"""The rules of the layers as clauses for a satisfiability solver.

A layer is set by the literals "at least k", k = 1, 2, ... (order encoding). Two items that meet in the plane are apart
where one is below the other: the difference of two layers is at least a number, for all bodies that the items' ends
depend on. Each such difference is a literal that implies one clause for every layer, so unit propagation alone finds
every circle of bodies each above the next. (Tamura et al., Compiling finite linear CSP into SAT, Constraints 14, 2009.)
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from itertools import pairwise

from pysat.card import ITotalizer
from pysat.solvers import Solver

from mechanisms.stages.automatic.layout.items import BASE, AnyReach, Ends, Item, choice_of

METHOD = "glucose4"
TRUE = 1


class Clauses:
    """Variables for the layers (below ``count``) of bodies, by the first one where several share a layer; for choices.

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
        """A literal."""
        self.last += 1
        return self.last

    def add(self, *literals: int) -> None:
        """At least one of these is true."""
        self.solver.add_clause(literals)

    def at_least(self, body: str, level: int) -> int:
        """That a body's layer is ``level`` or higher."""
        if level <= 0:
            return TRUE
        return self.steps[self.heads[body]][level - 1] if level < self.count else -TRUE

    def above(self, low: str | None, high: str | None, by: int) -> int:
        """A literal that implies that ``high`` is ``by`` layers above ``low``; None is a body on layer 0."""
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
        """Ends of an item, each with literals of which one is true where the choice is another."""
        ((choice, ends),) = reach.ends.items()
        if choice is None:
            # without bodies an item with a base is on the base
            return [([], ends[0] if self._layered(reach) else (None, BASE))]
        literal = self.choices[choice]
        return [([literal], ends[0]), ([-literal], ends[1])]

    def _layered(self, reach: AnyReach) -> tuple[str, ...]:
        """Those of an item's bodies that have a layer."""
        return tuple(body for body in reach.bodies if body in self.heads)

    def crossings(self, items: Sequence[Item]) -> list[int]:
        """Literals that are true for every step from a layer to the next that a pin goes through."""
        literals: list[int] = []
        for item in items:
            ((choice, ends),) = item.reach.ends.items()
            bodies = tuple(dict.fromkeys(self.heads[body] for body in self._layered(item.reach)))
            if ends[0][0] is not None:
                literals += [] if ends[0][1] is None else self._crossed(bodies, bodies, [])
                continue
            given = [] if choice is None else [self.choices[choice]]
            literals += self._crossed((None,), bodies, given)
            if choice is not None:
                literals += self._crossed(bodies, (None,), [-given[0]])
        return literals

    def _crossed(self, lows: Sequence[str | None], highs: Sequence[str | None], given: Sequence[int]) -> list[int]:
        """From the lowest to the highest of bodies; None is what is below, or above, all of them."""
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
        """Literals r[k] that are true if more than k of ``literals`` are, k up to ``most``."""
        if not literals:
            return []
        total = ITotalizer(lits=list(literals), ubound=most, top_id=self.last)
        for clause in total.cnf.clauses:
            self.solver.add_clause(clause)
        self.last = max(self.last, total.top_id)
        return list(total.rhs)

    def solved(self, assumed: Sequence[int] = (), budget: int | None = None) -> bool | None:
        """Whether there is a model under assumptions; None if ``budget`` conflicts of the solver do not decide."""
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
        """In the model."""
        return (abs(literal) in self._model) == (literal > 0)

    def layer(self, body: str) -> int:
        """In the model."""
        return sum(self.holds(step) for step in self.steps[self.heads[body]])

    def close(self) -> None:
        """Free the solver's memory."""
        self.solver.delete()


def choices_of(items: Sequence[Item]) -> list[str]:
    """Without repeats."""
    return list(dict.fromkeys(c for item in items if (c := choice_of(item.reach)) is not None))
