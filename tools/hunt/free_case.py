"""A free motion under way: its first solution, the growth of errors, and comparisons with others."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError, SimulationError
from mbsd.results.solution import Solution
from tools.hunt.agreement import NUDGE, SAME, SLACK, Growth, Verdict, Words, compare_free, valves
from tools.hunt.checks import closed, expected_refusal, finite
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome
from tools.hunt.sweeping import HEALTHY
from tools.random_mechanisms.described import duplicate
from tools.random_mechanisms.subject import TOLERANCE, Subject, attempt

OUTPUTS = 60


@dataclass
class Free:
    """A case under way."""

    subject: Subject
    rng: np.random.Generator
    first: Solution | None = None
    refused: MechanismError | None = None
    growth: Growth | None = None
    notes: list[str] = field(default_factory=list)
    built: Mechanism = field(init=False)
    """As built."""

    def __post_init__(self) -> None:
        self.built = self.subject.m

    @property
    def m(self) -> Mechanism:
        """As built, but that it starts at the closed pose and consistent velocities of the first solution."""
        return self.subject.m

    @property
    def grid(self) -> np.ndarray:
        """(T,) outputs."""
        return np.linspace(0.0, self.subject.duration, OUTPUTS + 1)

    @property
    def margin(self) -> float:
        """Least singularity margin seen."""
        return 0.0 if self.first is None else float(self.first.singularity_margin.min())

    def touches(self) -> bool:
        """True if events decide the motion."""
        return "contacts" in self.subject.traits

    def remembers(self, k: int) -> bool:
        """Return True if a contact acts at output k whose damping depends on its first speed.

        No start has that speed.
        """
        first = self.first
        if first is None or first.approached is None:
            return False
        damped = [name for name, force in self.m.forces.items() if force.params.get("restitution") is not None]
        efforts = [first.force(name).effort for name in damped]
        return any(effort is not None and effort[k] != 0.0 for effort in efforts)

    def run(self, m: Mechanism, **options: Any) -> tuple[Solution | None, MechanismError | None]:
        """Simulate over the case's outputs, with its tolerance, unless said otherwise."""
        options = {"times": self.grid, "tolerance": TOLERANCE} | options
        return attempt(lambda: m.simulate(**options))

    def look(self, m: Mechanism) -> Solution:
        """Simulate to a few outputs. Raises MechanismError where that fails."""
        return m.simulate(times=self.grid[:3])

    def compared(self, name: str, m: Mechanism, words: Words = SAME, **options: Any) -> Outcome:
        """Simulate ``m`` and compare."""
        other, error = self.run(m, **options)
        if error is not None:
            return self.refusal(name, error)
        assert other is not None
        tolerance = float(options.get("tolerance", TOLERANCE))
        outcome = self.agreement(name, other, words, tolerance)
        if outcome.reason == "differs" and self.first is not None and self._falls(m, other, words, options):
            return Outcome(name, UNCLEAR, "errors above the bound that fall with the tolerance", outcome.detail)
        return outcome

    def _falls(self, m: Mechanism, other: Solution, words: Words, options: dict[str, Any]) -> bool:
        """Return True if tolerances a hundred times less make a difference ten times less, or end steps there.

        A nudge at the start does not tell how errors made on the way grow, as in a close encounter of two masses; where
        steps then shrink to rounding, no tolerance tells more.
        """
        tolerance = float(options.get("tolerance", TOLERANCE))
        first, refused = self.run(self.m, tolerance=TOLERANCE / 100)
        finer, also = self.run(m, **(options | {"tolerance": tolerance / 100}))
        if first is None or finer is None or self.growth is None:
            return any(isinstance(error, SimulationError) for error in (refused, also))
        before = self.verdict(other, words, tolerance).worst
        return compare_free(first, finer, self.growth, TOLERANCE + tolerance, words).worst < 0.1 * before

    def agreement(self, name: str, other: Solution, words: Words, tolerance: float) -> Outcome:
        """A solution against the first one."""
        problems = finite(other) or closed(other)
        if problems:
            return Outcome(name, WRONG, "against its own equations", "; ".join(problems))
        if self.first is None or self.growth is None:
            margin = float(other.singularity_margin.min())
            if "jumps there" in str(self.refused):
                return Outcome(name, UNCLEAR, "a force jumps, which steps meet or miss by chance")
            if margin < HEALTHY or {"stiff", "contacts"} & self.subject.traits:
                return Outcome(name, AGREED, "proved what was refused as built")
            return Outcome(name, WRONG, "solved, but refused as built", f"margin {margin:.3g}; {self.refused}")
        verdict = self.verdict(other, words, tolerance)
        if verdict.agrees:
            return Outcome(name, AGREED) if verdict.compared else Outcome(name, UNCLEAR, "too sensitive")
        if self.less_sure():
            verdict = self.verdict(other, words, tolerance)
            if verdict.agrees:
                return Outcome(name, AGREED if verdict.compared else UNCLEAR, "sensitive")
        return Outcome(name, WRONG, "differs", verdict.words)

    def verdict(self, other: Solution, words: Words, tolerance: float, slack: float = SLACK) -> Verdict:
        """Outcome of a comparison with the first solution."""
        assert self.first is not None
        assert self.growth is not None
        return compare_free(self.first, other, self.growth, TOLERANCE + tolerance, words, slack * valves(self.first))

    def less_sure(self) -> bool:
        """Measure the growth of errors by further nudges; False if there is nothing new to learn."""
        if self.notes or self.first is None or self.growth is None:
            return False
        self.notes.append("nudged again")
        for size in (-1.0, 10.0, 0.1):
            other, _ = self.run(nudged(self.m, size))
            if other is not None:
                self.growth = self.growth.larger(Growth.between(self.first, other))
        return True

    def refusal(self, name: str, error: MechanismError) -> Outcome:
        """A refusal where the first solution was solved, or was refused too."""
        kind = type(error).__name__
        if self.first is None:
            return Outcome(name, REFUSED, f"{kind}, as built too", str(error))
        if expected_refusal(error):
            return Outcome(name, REFUSED, f"{kind}, what a method is not made for", str(error))
        singular = self.margin < HEALTHY or "bifurcates" in self.subject.traits  # change points lie between outputs
        if singular and isinstance(error, SimulationError):
            return Outcome(name, REFUSED, f"{kind} near a singular pose, solved as built", str(error))
        return Outcome(name, WRONG, f"refused ({kind}), solved as built", str(error))


def nudged(m: Mechanism, size: float = 1.0) -> Mechanism:
    """Velocities and gravity changed by ``size`` NUDGE of themselves and of 1 m/s and 10 m/s^2."""
    out, by = duplicate(m), size * NUDGE
    gx, gy = out.gravity or (0.0, 0.0)
    out.gravity = gx * (1 + by) + 10 * by, gy * (1 + by) + 7 * by
    for k, (name, old) in enumerate(out.velocities.items()):
        turn = by * (1.0 + abs(old.omega)) * (1.0 if k % 2 else -0.7)
        out.velocities[name] = replace(old, omega=old.omega + turn)
    return out
