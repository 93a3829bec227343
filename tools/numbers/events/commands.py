"""Commands on recorded runs: check, record, and compare with one row of the compiled loop."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.measures import final, samples
from tools.numbers.events.difference import MOST, Difference, bound, difference, moved
from tools.numbers.events.record import FILE, TOLERANCE, Case, Outcome, Record, Sizes, read, run, write
from tools.numbers.events.table import cases

# Recorded runs beside one row of the compiled loop over many simulations.


PARTS = ("x", "y", "theta", "vx", "vy", "omega")
IN_LOOP = "loop"


class Beside(NamedTuple):
    """A run beside its row."""

    name: str
    way: str
    """"loop", or why it is simulated by itself."""
    apart: float
    """Largest difference of all bodies' motion, in parts of its sizes."""
    within: float


def compare(only: str) -> Iterator[Beside]:
    """Yield runs whose names contain ``only`` beside one row of the loop each.

    Refused runs have no motion.
    """
    records = read()
    for case in cases():
        record = records[case.name]
        own = records[record.same_as] if record.same_as else record
        if only in case.name and own.outcome is not None:
            yield _compare(case, own.outcome, own.within)


def _compare(case: Case, outcome: Outcome, within: float) -> Beside:
    m, given = case.build(), dict(case.options)
    rows = given.pop("event_rows", False)
    times = [moment.t for moment in outcome.between]
    names = {f"{name}.{part}": (name, part) for name, body in m.bodies.items() if body != m.ground for part in PARTS}
    steps = int(given.pop("steps", case.steps))
    measure = {name: final(name) for name in names} | {"work": final("work")}
    grid = np.linspace(0.0, case.duration, steps + 1)
    if times and outcome.end is not None and outcome.end.t == case.duration:
        grid = np.unique(np.concatenate([grid, times]))
        measure |= {f"{name} between": samples(name, times) for name in names}
    try:
        with warnings.catch_warnings(action="ignore"):
            many = m.simulate_many(
                times=grid, vary=_same(m), measure=measure, threads=1, **{"tolerance": TOLERANCE, **given}
            )
    except MechanismError as error:
        return Beside(case.name, "refused before any row", 0.0 if str(error) == outcome.text else math.inf, within)
    way = many.alone[0] or IN_LOOP
    if rows:
        way += " (without rows beside events)"
    if outcome.error or many.reason[0] is not None:
        same = bool(outcome.error) and many.reason[0] is not None and outcome.text in str(many.reason[0])
        return Beside(case.name, way, 0.0 if same else math.inf, within)
    assert outcome.sizes is not None
    assert outcome.end is not None
    apart = abs(float(many["work"][0]) - outcome.work) / outcome.sizes.energy
    alone = _places(case, times)
    for name, (body, part) in names.items():
        scale = _scale(outcome.sizes, part)
        ends, between = alone[body, part]
        apart = max(apart, abs(float(many[name][0]) - ends) / scale)
        if f"{name} between" in measure:
            apart = max(apart, float(np.abs(many[f"{name} between"][0] - between).max(initial=0.0)) / scale)
    return Beside(case.name, way, apart, within)


def _places(case: Case, times: list[float]) -> dict[tuple[str, str], tuple[float, np.ndarray]]:
    """Parts of bodies' motion at the end and between events, by a single simulation."""
    sol = case.simulate()
    after = sol.at(times) if times else sol
    return {
        (name, part): (float(getattr(sol.body(name), part)[-1]), np.asarray(getattr(after.body(name), part)))
        for name in sol.mechanism.bodies
        for part in PARTS
    }


def _scale(sizes: Sizes, part: str) -> float:
    places, rates = sizes.of_bodies()
    return (places + rates)[PARTS.index(part)]


def _same(m: Mechanism) -> dict[str, dict[str, list[float]]]:
    """A number that varies over one row, as it is: a mass, else a number of a contact."""
    for name, body in m.bodies.items():
        if body.mass:
            return {name: {"mass": [body.mass]}}
    raise ValueError(f"{m.name} has no mass")


def show(only: str) -> None:
    """Print a table of all, a line as soon as it is known."""
    print("| run | way | difference | bound |\n|---|---|--:|--:|")
    for each in compare(only):
        print(f"| {each.name} | {each.way} | {each.apart:.1e} | {each.within:.0e} |", flush=True)


# Check runs against their records, record them, and compare them with the compiled loop over many simulations.


AT_ONCE = 25
"""Runs after which what is recorded is written."""


@dataclass(frozen=True)
class Verdict:
    """How far a run is from its record."""

    case: Case
    difference: Difference
    within: float
    forces_within: float
    fault: str = ""
    """A fault beside a difference, if any."""

    @property
    def is_good(self) -> bool:
        """True if the run is within its bounds."""
        near = self.difference.motion <= self.within and self.difference.forces <= self.forces_within
        return near and not self.fault

    def __str__(self) -> str:
        apart = self.difference
        return self.fault or (
            f"{self.case.name}: {apart.motion:.1e} of the motion (within {self.within:.0e}), {apart.forces:.1e} of the "
            f"forces (within {self.forces_within:.0e}), farthest in {apart.where}"
        )


def verdict(case: Case, records: dict[str, Record], outcome: Outcome | None = None) -> Verdict:
    """Run a case and compare it with its record; ``outcome``: what came of it, if it was run already."""
    record = records.get(case.name)
    if record is None:
        return Verdict(case, Difference(0.0, 0.0, ""), 0.0, 0.0, f"{case.name}: is not recorded")
    own = records[record.same_as] if record.same_as else record
    before = own.outcome
    assert before is not None
    now = outcome or run(case, [moment.t for moment in before.between])
    unsaid = [word for word in case.refused if word not in now.text]
    fault = f"{case.name}: the error does not say {unsaid}: {now.text or 'there is none'}" if unsaid else ""
    return Verdict(case, difference(before, now), own.within, own.forces_within, fault)


def check(only: str) -> int:
    """Compare runs whose names contain ``only`` with their records.

    Returns 1 where one is beyond its bounds.
    """
    records, started = read(), time.perf_counter()
    chosen = [case for case in cases() if only in case.name]
    bad = [each for each in (verdict(case, records) for case in chosen) if not each.is_good]
    for each in bad:
        print(f"events: {each}")
    gone = sorted(name for name in records.keys() - {case.name for case in cases()} if only in name)
    for name in gone:
        print(f"events: {name}: is recorded and is no run any more")
    print(f"events: {len(bad)} of {len(chosen)} runs differ, in {time.perf_counter() - started:.0f} s")
    return 1 if bad or gone or not chosen else 0


def record(only: str) -> int:
    """Record runs anew, all or those whose names contain ``only``; returns 1 where one is not fit for it."""
    known = read() if FILE.exists() else {}
    kept: dict[str, Record] = {}
    unfit = 0
    for case in cases():
        if only in case.name or case.name not in known:
            made, why = _record(case, kept)
            if why:
                unfit += 1
                print(f"events: {case.name}: {why}", flush=True)
            kept[case.name] = made
            if len(kept) % AT_ONCE == 0:
                write([*(known | kept).values()])
        else:
            kept[case.name] = known[case.name]
    write(list(kept.values()))
    print(f"events: {len(kept)} runs recorded in {FILE}, {FILE.stat().st_size // 1000} kB; {unfit} of them not fit")
    return 1 if unfit else 0


def _record(case: Case, known: dict[str, Record]) -> tuple[Record, str]:
    """The record of a run, and why it is not fit for one, if so."""
    twin = known.get(case.name.rpartition(", ")[0])
    if twin is not None and twin.outcome is not None and case.options.get("formulation"):
        outcome = run(case, [moment.t for moment in twin.outcome.between])
        if verdict(case, {case.name: Record(case.name, same_as=twin.name), twin.name: twin}, outcome).is_good:
            return Record(case.name, same_as=twin.name), ""
    outcome = run(case)
    if outcome.error or case.refused:
        unsaid = [word for word in case.refused if word not in outcome.text]
        return Record(case.name, outcome=outcome), f"it says {outcome.text!r}" if unsaid or not case.refused else ""
    nudged = moved(case, outcome)
    name, most = max(nudged, key=lambda each: max(each[1].motion, each[1].forces))
    motion, forces = max(each.motion for _, each in nudged), max(each.forces for _, each in nudged)
    farthest = max(motion, forces)
    if not math.isfinite(farthest):
        return Record(case.name, outcome=outcome), f"{name}: {most.where}"
    within, forces_within = bound(motion), bound(forces)
    reason = f"moving {name} moves it by {farthest:.0e}: {case.kink}" if max(within, forces_within) > 1e-9 else ""
    made = Record(case.name, "", outcome, within, forces_within, float(f"{farthest:.2g}"), reason)
    if farthest > MOST:
        return made, f"it moves by {farthest:.0e}, {name}: {most.where}; shorten it"
    return made, "" if case.kink or not reason else f"it moves by {farthest:.0e}, {name}, and no reason is given"


def quick_cases() -> Sequence[Case]:
    """Return the runs of the quick tests: some of each kind."""
    return [case for case in cases() if case.quick]
