"""One case: a random mechanism as built, then again in other words. The seed decides all of it."""

from __future__ import annotations

import math
import time
import warnings
import zlib

import numpy as np

from mbsd.arrays.starts import started_at
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from tools.hunt.agreement import Growth
from tools.hunt.checks import closed, driven_problems, finite
from tools.hunt.free_case import Free, nudged
from tools.hunt.outcome import AGREED, BASE, REFUSED, WRONG, CaseResult, Outcome
from tools.hunt.simulating import RUNS
from tools.hunt.sweeping import HEALTHY, SWEEPS, Driven
from tools.random_mechanisms.described import restarted
from tools.random_mechanisms.families import all_families
from tools.random_mechanisms.subject import Family, Raw, Subject, attempt

VARIATIONS = 4
"""Number of variations of each mechanism, drawn at random."""
EXAMPLES = 0.2
"""Share of the registries' examples, however many there are."""


def drawn(seed: int, name: str | None = None, skipped: int = 0) -> tuple[Family, Subject, np.random.Generator]:
    """The mechanism of a seed; of one family if ``name`` says so.

    ``skipped`` random numbers are left out before it is built: two for cases on record from when these drew the family.
    """
    rng = np.random.default_rng([seed, 71])
    rng.random(skipped)
    family = all_families()[_family(seed) if name is None else name]
    return family, family.build(rng), rng


def _family(seed: int) -> str:
    """A family drawn by weight; a new one takes cases from all others and leaves the rest as they were.

    Each family draws u^(1 / weight), and the largest wins. Source: Efraimidis, Spirakis, Weighted random sampling with
    a reservoir, Information Processing Letters 97 (2006).
    """
    families = all_families().values()
    examples = sum(family.example for family in families)
    others = sum(family.weight for family in families if not family.example)

    def lot(family: Family) -> float:
        share = EXAMPLES / examples if family.example else (1.0 - EXAMPLES) * family.weight / others
        return math.log(np.random.default_rng([seed, zlib.crc32(family.name.encode())]).random()) / share

    return max(families, key=lot).name


def run(seed: int, name: str | None = None, every: bool = False) -> CaseResult:
    """Solve the case; ``every``: with all variations instead of a few."""
    began = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        family, subject, rng = drawn(seed, name)
        result = CaseResult(seed, family.name)
        try:
            (_driven if subject.driven else _free)(subject, rng, result, every)
        except Raw as error:
            result.outcomes.append(Outcome(BASE, WRONG, "raw traceback", str(error)))
    result.seconds = time.perf_counter() - began
    return result


def _several(rng: np.random.Generator, table: dict, result: CaseResult, case, every: bool) -> None:
    names = list(table)
    for name in names if every else [names[k] for k in rng.choice(len(names), VARIATIONS, replace=False)]:
        case.rng = np.random.default_rng([result.seed, 5, names.index(name)])
        try:
            result.outcomes.append(table[name](case))
        except Raw as error:
            result.outcomes.append(Outcome(name, WRONG, "raw traceback", str(error)))


def _driven(subject: Subject, rng: np.random.Generator, result: CaseResult, every: bool) -> None:
    case = Driven(subject, rng)
    case.first, case.refused = attempt(lambda: subject.m.sweep(times=case.grid))
    if case.first is not None:
        problems = driven_problems(case.first, subject)
        if not problems and subject.possible is False:
            problems = ["solved, though closed forms say that the links cannot follow"]
        result.outcomes.append(
            Outcome(BASE, WRONG, "against its own equations or closed form", "; ".join(problems))
            if problems
            else Outcome(BASE, AGREED)
        )
        if problems:
            return
        subject.m = restarted(subject.m, case.first, 0)
    else:
        error = case.refused
        kind = type(error).__name__
        if subject.possible and subject.distance > HEALTHY:
            result.outcomes.append(Outcome(BASE, WRONG, f"refused ({kind}), though it can move", str(error)))
        else:
            why = {True: "near a change point", False: "cannot follow", None: "not known better"}[subject.possible]
            result.outcomes.append(Outcome(BASE, REFUSED, f"{kind}, {why}", str(error)))
    _several(rng, SWEEPS, result, case, every)


def _free(subject: Subject, rng: np.random.Generator, result: CaseResult, every: bool) -> None:
    case = Free(subject, rng)
    start, case.refused = attempt(lambda: prepare_dynamics(subject.m, 0.0, subject.duration, contacts=True))
    if start is not None:  # which of given velocities are kept depends on the axes: all variations start alike
        subject.m = started_at(subject.m, start.packed, start.initial.q, start.initial.v)
        case.first, case.refused = case.run(subject.m)
    if case.first is None:
        result.outcomes.append(Outcome(BASE, REFUSED, type(case.refused).__name__, str(case.refused)))
    else:
        problems = finite(case.first) or closed(case.first)
        if not problems and subject.truth is not None:
            problems = subject.truth(case.first)
        result.outcomes.append(
            Outcome(BASE, WRONG, "against its own equations", "; ".join(problems))
            if problems
            else Outcome(BASE, AGREED)
        )
        other, _ = case.run(nudged(subject.m))
        if problems or other is None:
            return
        case.growth = Growth.between(case.first, other)
    _several(rng, RUNS, result, case, every)
