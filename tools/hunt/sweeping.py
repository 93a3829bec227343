"""Variations of a driven motion: each takes the case and gives its outcome."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.results.solution import Solution
from tools.hunt.agreement import SAME, Words, compare_driven, turned_drivers
from tools.hunt.checks import cannot_be_saved, driven_problems, expected_refusal
from tools.hunt.mixed_rows import designs_beside_sweeps
from tools.hunt.moved_derivatives import beside_its_own
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome, Variations
from tools.hunt.same_bits import changed, pickled, renamed_differs, there_and_back
from tools.random_mechanisms.described import Pose, back, duplicate, on_a_base, restarted, seen_from, turnable
from tools.random_mechanisms.similar import exchanged, in_units, mirrored, renamed, shuffled
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

    def against_first(
        self, name: str, m: Mechanism, times: np.ndarray, words: Words = SAME, pinned: Solution | None = None
    ) -> Outcome:
        """Sweep ``m`` and compare."""
        other, error = attempt(lambda: m.sweep(times=times))
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


def random_pose(rng: np.random.Generator, size: float) -> Pose:
    """Somewhere within some sizes, turned anyhow."""
    x, y = rng.normal(scale=2 * size, size=2)
    return float(x), float(y), float(rng.uniform(-3.1, 3.1))


def random_frames(m: Mechanism, rng: np.random.Generator, size: float, world: bool, bodies: bool) -> dict[str, Pose]:
    """New frames of bodies, and of ground if the world is to be carried off; turned where kinds allow it."""
    free, out = turnable(m), {}
    for name in m.bodies:
        if bodies if name != "ground" else world:
            x, y, angle = random_pose(rng, 0.3 * size if name != "ground" else size)
            out[name] = (x, y, angle if name in free else 0.0)
    return out


def _size(case: Driven) -> float:
    return 1.0 if case.first is None else case.first.packed.size


@variation("world turned and moved")
def _world(case: Driven) -> Outcome:
    frames = random_frames(case.m, case.rng, _size(case), world=True, bodies=False)
    return case.against_first("world turned and moved", seen_from(case.m, frames), case.grid, Words(frames))


@variation("frames of bodies moved")
def _frames(case: Driven) -> Outcome:
    frames = random_frames(case.m, case.rng, _size(case), world=False, bodies=True)
    return case.against_first("frames of bodies moved", seen_from(case.m, frames), case.grid, Words(frames))


@variation("on a welded base")
def _base(case: Driven) -> Outcome:
    name = "on a welded base"
    if "ground" not in turnable(case.m):
        return Outcome(name, UNCLEAR, "a kind measures ground")
    world = random_pose(case.rng, _size(case))
    m = on_a_base(case.m, world, float(case.rng.choice([0.0, 1.0])))
    return case.against_first(name, m, case.grid, Words({"ground": back(world)}))


@variation("another order")
def _order(case: Driven) -> Outcome:
    return case.against_first("another order", shuffled(case.m, case.rng), case.grid, Words({}))


@variation("mirror image")
def _mirror(case: Driven) -> Outcome:
    name, other = "mirror image", mirrored(case.m)
    if other is None:
        return Outcome(name, UNCLEAR, "a kind has a side of its own")
    return case.against_first(name, other, case.grid, Words(mirrored=True))


@variation("other units")
def _units(case: Driven) -> Outcome:
    name, (length, mass) = "other units", 10.0 ** case.rng.uniform(-2.0, 3.0, 2)
    other = in_units(case.m, float(length), float(mass))
    if other is None:
        return Outcome(name, UNCLEAR, "numbers of a kind whose units are not known")
    return case.against_first(name, other, case.grid, Words(length=float(length), mass=float(mass)))


@variation("other names")
def _names(case: Driven) -> Outcome:
    name, other = "other names", renamed(case.m)
    if other is None or case.first is None:
        return Outcome(name, UNCLEAR, "no file could hold the model, or it was refused as built")
    here, _ = attempt(lambda: case.m.sweep(times=case.grid))
    there, error = attempt(lambda: other.sweep(times=case.grid))
    if error is not None:
        return case.refusal(name, error) if here is not None else Outcome(name, REFUSED, "with its own names, too")
    assert here is not None
    assert there is not None
    differs = renamed_differs(here, there)
    return Outcome(name, WRONG, "differs", differs) if differs else Outcome(name, AGREED)


@variation("ends exchanged")
def _ends(case: Driven) -> Outcome:
    m = exchanged(case.m, case.rng)
    return case.against_first("ends exchanged", m, case.grid, Words({}, turned_drivers(case.m, m)))


@variation("all at once")
def _all(case: Driven) -> Outcome:
    frames = random_frames(case.m, case.rng, _size(case), world=True, bodies=True)
    m = shuffled(seen_from(case.m, frames), case.rng)
    per_turn = int(case.rng.choice(STEPS))
    times = np.linspace(0.0, case.subject.duration, max(1, round(per_turn * case.subject.turns)) + 1)
    return case.against_first("all at once", m, times, Words(frames))


def _steps(per_turn: int) -> Callable[[Driven], Outcome]:
    def run(case: Driven) -> Outcome:
        name = f"{per_turn} outputs a turn"
        steps = max(1, round(per_turn * case.subject.turns))
        return case.against_first(name, case.m, np.linspace(0.0, case.subject.duration, steps + 1))

    return run


for _count in STEPS:
    SWEEPS[f"{_count} outputs a turn"] = _steps(_count)


@variation("irregular outputs")
def _irregular(case: Driven) -> Outcome:
    grid = case.grid
    share = float(10 ** case.rng.uniform(-2, 0))
    keep = case.rng.random(len(grid)) < share
    keep[[0, int(case.rng.integers(1, len(grid)))]] = True
    return case.against_first("irregular outputs", case.m, grid[keep])


@variation("one output alone")
def _one(case: Driven) -> Outcome:
    at = float(case.rng.choice(case.grid))
    if case.first is not None and at > 0.0:  # start_near tells the pose at this time
        k = int(np.argmin(np.abs(case.first.t - at)))
        m = _from_here(case, k)
        return _compared_later(case, "one output alone", m, np.array([case.first.t[k]]))
    return case.against_first("one output alone", case.m, np.array([0.0]))


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


@variation("saved and loaded")
def _saved(case: Driven) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.json"
        _, error = attempt(lambda: case.m.save(path))
        if error is not None:
            state = REFUSED if cannot_be_saved(case.m) else WRONG
            return Outcome("saved and loaded", state, f"{type(error).__name__}, a function", str(error))
        return case.against_first("saved and loaded", Mechanism.load(path), case.grid)


@variation("changed and changed back")
def _changed(case: Driven) -> Outcome:
    m = duplicate(case.m)
    times = case.grid[:: max(1, len(case.grid) // 8)]
    if not there_and_back(m, case.rng, lambda: m.sweep(times=times)):
        return Outcome("changed and changed back", UNCLEAR, "nothing to change")
    return case.against_first("changed and changed back", m, case.grid)


@variation("changed equals fresh")
def _changed_to(case: Driven) -> Outcome:
    return changed("changed equals fresh", case.m, case.rng)


@variation("pickled and back")
def _pickled(case: Driven) -> Outcome:
    return pickled("pickled and back", case.first)


@variation("designs at once")
def _designs(case: Driven) -> Outcome:
    return designs_beside_sweeps("designs at once", case.m, case.rng, case.subject.duration, HEALTHY)


@variation("derivatives of the moved machine")
def _derivatives(case: Driven) -> Outcome:
    name = "derivatives of the moved machine"
    if case.first is None or case.doubtful or "jumps" in case.subject.traits:
        return Outcome(name, UNCLEAR, "refused as built, near a singular pose, or accelerations jump")
    return beside_its_own(name, case.m, case.rng, random_pose(case.rng, _size(case)), case.first, is_free=False)


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
