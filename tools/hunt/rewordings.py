"""Variations that driven and free motions share: the same mechanism in other words, kept or changed."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.results.solution import Solution
from tools.hunt.agreement import SAME, Words, turned_drivers
from tools.hunt.checks import cannot_be_saved
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome, Variations
from tools.hunt.same_bits import changed, pickled, renamed_differs, there_and_back
from tools.random_mechanisms.described import Pose, back, duplicate, on_a_base, seen_from, turnable
from tools.random_mechanisms.similar import exchanged, in_units, mirrored, renamed, shuffled
from tools.random_mechanisms.subject import attempt


class Case(Protocol):
    """A case under way, driven or free."""

    rng: np.random.Generator
    first: Solution | None

    @property
    def m(self) -> Mechanism:
        """Mechanism as built."""
        ...

    def run(self, m: Mechanism, **options: Any) -> tuple[Solution | None, MechanismError | None]:
        """Solve over the case's outputs, unless said otherwise."""
        ...

    def look(self, m: Mechanism) -> Solution:
        """Solve at a few outputs. Raises MechanismError where that fails."""
        ...

    def compared(self, name: str, m: Mechanism, words: Words = SAME, **options: Any) -> Outcome:
        """Solve ``m`` and compare it with the first solution."""
        ...

    def refusal(self, name: str, error: MechanismError) -> Outcome:
        """Judge a refusal."""
        ...


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


def size_of(case: Case) -> float:
    """Return the size of the mechanism (m), as far as the first solution knows."""
    return 1.0 if case.first is None else case.first.packed.size


IN_OTHER_WORDS: Variations[Case] = Variations()
KEPT_AND_CHANGED: Variations[Case] = Variations()


@IN_OTHER_WORDS.enter("world turned and moved")
def _world(case: Case) -> Outcome:
    frames = random_frames(case.m, case.rng, size_of(case), world=True, bodies=False)
    return case.compared("world turned and moved", seen_from(case.m, frames), Words(frames))


@IN_OTHER_WORDS.enter("frames of bodies moved")
def _frames(case: Case) -> Outcome:
    frames = random_frames(case.m, case.rng, size_of(case), world=False, bodies=True)
    return case.compared("frames of bodies moved", seen_from(case.m, frames), Words(frames))


@IN_OTHER_WORDS.enter("on a welded base")
def _base(case: Case) -> Outcome:
    name = "on a welded base"
    if "ground" not in turnable(case.m):
        return Outcome(name, UNCLEAR, "a kind measures ground")
    world = random_pose(case.rng, size_of(case))
    m = on_a_base(case.m, world, float(case.rng.choice([0.0, 1.0])))
    return case.compared(name, m, Words({"ground": back(world)}))


@IN_OTHER_WORDS.enter("another order")
def _order(case: Case) -> Outcome:
    return case.compared("another order", shuffled(case.m, case.rng), Words({}))


@IN_OTHER_WORDS.enter("mirror image")
def _mirror(case: Case) -> Outcome:
    name, other = "mirror image", mirrored(case.m)
    if other is None:
        return Outcome(name, UNCLEAR, "a kind has a side of its own")
    return case.compared(name, other, Words(mirrored=True))


@IN_OTHER_WORDS.enter("other units")
def _units(case: Case) -> Outcome:
    name, (length, mass) = "other units", 10.0 ** case.rng.uniform(-2.0, 3.0, 2)
    other = in_units(case.m, float(length), float(mass))
    if other is None:
        return Outcome(name, UNCLEAR, "numbers of a kind whose units are not known")
    return case.compared(name, other, Words(length=float(length), mass=float(mass)))


@IN_OTHER_WORDS.enter("other names")
def _names(case: Case) -> Outcome:
    name, other = "other names", renamed(case.m)
    if other is None or case.first is None:
        return Outcome(name, UNCLEAR, "no file could hold the model, or it was refused as built")
    here, _ = case.run(case.m)
    there, error = case.run(other)
    if error is not None:
        return case.refusal(name, error) if here is not None else Outcome(name, REFUSED, "with its own names, too")
    assert here is not None
    assert there is not None
    differs = renamed_differs(here, there)
    return Outcome(name, WRONG, "differs", differs) if differs else Outcome(name, AGREED)


@IN_OTHER_WORDS.enter("ends exchanged")
def _ends(case: Case) -> Outcome:
    m = exchanged(case.m, case.rng)
    return case.compared("ends exchanged", m, Words({}, turned_drivers(case.m, m)))


@KEPT_AND_CHANGED.enter("saved and loaded")
def _saved(case: Case) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.json"
        _, error = attempt(lambda: case.m.save(path))
        if error is not None:
            state = REFUSED if cannot_be_saved(case.m) else WRONG
            return Outcome("saved and loaded", state, f"{type(error).__name__}, a function", str(error))
        return case.compared("saved and loaded", Mechanism.load(path))


@KEPT_AND_CHANGED.enter("changed and changed back")
def _changed(case: Case) -> Outcome:
    name, m = "changed and changed back", duplicate(case.m)
    if not there_and_back(m, case.rng, lambda: case.look(m)):
        return Outcome(name, UNCLEAR, "nothing to change")
    return case.compared(name, m)


@KEPT_AND_CHANGED.enter("changed equals fresh")
def _changed_to(case: Case) -> Outcome:
    return changed("changed equals fresh", case.m, case.rng)


@KEPT_AND_CHANGED.enter("pickled and back")
def _pickled(case: Case) -> Outcome:
    return pickled("pickled and back", case.first)
