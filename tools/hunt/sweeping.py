"""Variations of a driven motion: each takes the case and gives its outcome."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.results.solution import Solution
from tools.hunt.agreement import SAME, Words, compare_driven
from tools.hunt.checks import driven_problems, expected_refusal
from tools.hunt.mixed_rows import designs_beside_sweeps
from tools.hunt.moved_derivatives import beside_its_own
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome, Variations
from tools.hunt.rewordings import IN_OTHER_WORDS, KEPT_AND_CHANGED, random_frames, random_pose, size_of
from tools.random_mechanisms.described import duplicate, restarted, seen_from
from tools.random_mechanisms.similar import shuffled
from tools.random_mechanisms.subject import Subject, attempt

A_TURN = 360
STEPS = (1, 2, 3, 5, 8, 12, 18, 36, 90, 1440)
HEALTHY = 0.02
"""Where the least singularity margin is above this, nothing gives reason to refuse."""


@dataclass
class Driven:
    """A case under way."""

    subject: Subject
    rng: np.random.Generator
    first: Solution | None = None
    refused: MechanismError | None = None

    @property
    def m(self) -> Mechanism:
        """As built."""
        return self.subject.m

    @property
    def grid(self) -> np.ndarray:
        """(T,) 360 outputs a turn."""
        return np.linspace(0.0, self.subject.duration, round(A_TURN * self.subject.turns) + 1)

    @property
    def doubtful(self) -> bool:
        """True if the motion comes near a singular pose, as far as the first solution saw."""
        seen = 0.0 if self.first is None else float(self.first.singularity_margin.min())
        return min(seen, self.subject.distance) < HEALTHY

    def run(self, m: Mechanism, **options: Any) -> tuple[Solution | None, MechanismError | None]:
        """Sweep over the case's outputs, unless said otherwise."""
        options = {"times": self.grid} | options
        return attempt(lambda: m.sweep(**options))

    def look(self, m: Mechanism) -> Solution:
        """Sweep at a few outputs. Raises MechanismError where that fails."""
        return m.sweep(times=self.grid[:: max(1, len(self.grid) // 8)])

    def compared(self, name: str, m: Mechanism, words: Words = SAME, **options: Any) -> Outcome:
        """Sweep ``m`` and compare."""
        other, error = self.run(m, **options)
        if error is not None:
            return self.refusal(name, error)
        assert other is not None
        return self.agreement(name, other, words)

    def agreement(self, name: str, other: Solution, words: Words = SAME, loosened: float = 0.0) -> Outcome:
        """A solution against the first one, or against what is known without it."""
        if words is SAME:
            problems = driven_problems(other, self.subject)
            if problems:
                return Outcome(name, WRONG, "against its own equations or closed form", "; ".join(problems))
        if self.first is None:
            return self._solved_though_refused(name, other)
        verdict = compare_driven(self.first, other, words, loosened)
        if not verdict.agrees:
            return Outcome(name, WRONG, "differs", verdict.words)
        if not verdict.compared:
            return Outcome(name, UNCLEAR, "no instant away from singular poses")
        return Outcome(name, AGREED)

    def _solved_though_refused(self, name: str, other: Solution) -> Outcome:
        if other.t[-1] < self.grid[-1]:
            return Outcome(name, UNCLEAR, "ends before what was refused as built, perhaps")
        margin = float(other.singularity_margin.min())
        if margin < HEALTHY or self.subject.distance < HEALTHY:
            return Outcome(name, AGREED, "proved what was refused as built, near a singular pose")
        return Outcome(
            name, WRONG, "solved, but refused as built", f"least margin {margin:.3g}; refused with: {self.refused}"
        )

    def refusal(self, name: str, error: MechanismError) -> Outcome:
        """A refusal where the first solution was solved, or was refused too."""
        kind = type(error).__name__
        if self.first is None:
            return Outcome(name, REFUSED, f"{kind}, as built too", str(error))
        if expected_refusal(error):
            return Outcome(name, REFUSED, f"{kind}, expected", str(error))
        if self.doubtful:
            return Outcome(name, REFUSED, f"{kind} near a singular pose, solved as built", str(error))
        return Outcome(name, WRONG, f"refused ({kind}), solved as built", str(error))


SWEEPS: Variations[Driven] = Variations()
variation = SWEEPS.enter


SWEEPS.update(IN_OTHER_WORDS)


@variation("all at once")
def _all(case: Driven) -> Outcome:
    frames = random_frames(case.m, case.rng, size_of(case), world=True, bodies=True)
    m = shuffled(seen_from(case.m, frames), case.rng)
    per_turn = int(case.rng.choice(STEPS))
    times = np.linspace(0.0, case.subject.duration, max(1, round(per_turn * case.subject.turns)) + 1)
    return case.compared("all at once", m, Words(frames), times=times)


def _steps(per_turn: int) -> Callable[[Driven], Outcome]:
    def run(case: Driven) -> Outcome:
        name = f"{per_turn} outputs a turn"
        steps = max(1, round(per_turn * case.subject.turns))
        return case.compared(name, case.m, times=np.linspace(0.0, case.subject.duration, steps + 1))

    return run


for _count in STEPS:
    SWEEPS[f"{_count} outputs a turn"] = _steps(_count)


@variation("irregular outputs")
def _irregular(case: Driven) -> Outcome:
    grid = case.grid
    share = float(10 ** case.rng.uniform(-2, 0))
    keep = case.rng.random(len(grid)) < share
    keep[[0, int(case.rng.integers(1, len(grid)))]] = True
    return case.compared("irregular outputs", case.m, times=grid[keep])


@variation("one output alone")
def _one(case: Driven) -> Outcome:
    at = float(case.rng.choice(case.grid))
    if case.first is not None and at > 0.0:  # start_near tells the pose at this time
        k = int(np.argmin(np.abs(case.first.t - at)))
        m = _from_here(case, k)
        return _compared_later(case, "one output alone", m, np.array([case.first.t[k]]))
    return case.compared("one output alone", case.m, times=np.array([0.0]))


def _from_here(case: Driven, k: int) -> Mechanism:
    assert case.first is not None
    return restarted(duplicate(case.m), case.first, k)


def _compared_later(case: Driven, name: str, m: Mechanism, times: np.ndarray) -> Outcome:
    """A motion that begins on the way against the first one; potential energy is counted from its start."""
    other, error = attempt(lambda: m.sweep(times=times))
    if error is not None:
        return case.refusal(name, error)
    assert other is not None
    assert case.first is not None
    verdict = compare_driven(case.first, other)
    if not verdict.agrees and not verdict.words.startswith("energies"):
        return Outcome(name, WRONG, "differs", verdict.words)
    return Outcome(name, AGREED)


@variation("from the middle on")
def _middle(case: Driven) -> Outcome:
    if case.first is None:
        return Outcome("from the middle on", UNCLEAR, "refused as built")
    k = int(case.rng.integers(1, len(case.grid) - 1))
    if case.first.singularity_margin[k] < 1e-3:
        return Outcome("from the middle on", UNCLEAR, "the middle is singular")
    return _compared_later(case, "from the middle on", _from_here(case, k), case.grid[k:])


SWEEPS.update(KEPT_AND_CHANGED)


@variation("designs at once")
def _designs(case: Driven) -> Outcome:
    return designs_beside_sweeps("designs at once", case.m, case.rng, case.subject.duration, HEALTHY)


@variation("derivatives of the moved machine")
def _derivatives(case: Driven) -> Outcome:
    name = "derivatives of the moved machine"
    if case.first is None or case.doubtful or "jumps" in case.subject.traits:
        return Outcome(name, UNCLEAR, "refused as built, near a singular pose, or accelerations jump")
    return beside_its_own(name, case.m, case.rng, random_pose(case.rng, size_of(case)), case.first, is_free=False)


@variation("simulated with its drivers")
def _simulated(case: Driven) -> Outcome:
    name = "simulated with its drivers"
    if case.first is None or case.doubtful or "jumps" in case.subject.traits:
        return Outcome(name, UNCLEAR, "refused as built, near a singular pose, or accelerations jump")
    tolerance = float(10 ** case.rng.uniform(-9, -7))
    formulation = str(case.rng.choice(["auto", "reference"]))
    duration = case.subject.duration * (60 / A_TURN if case.subject.turns > 0.2 else 1.0)
    times = case.grid[case.grid <= duration]
    first = case.first
    m = restarted(duplicate(case.m), first, 0)
    other, error = attempt(lambda: m.simulate(times=times, tolerance=tolerance, formulation=formulation))
    if error is not None:
        return case.refusal(name, error)
    assert other is not None
    return case.agreement(name, other, Words({}), loosened=100 * tolerance)
