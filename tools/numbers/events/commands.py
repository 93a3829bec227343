"""Check runs against their records, record them, and compare them with the compiled loop over many simulations."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

from tools.numbers.events import condition
from tools.numbers.events.case import Case
from tools.numbers.events.difference import Difference, difference
from tools.numbers.events.record import FILE, Outcome, Record, read, run, write
from tools.numbers.events.table import cases

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
    """What is wrong beside a difference, if anything."""

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
    """Compare all runs whose names contain ``only`` with their records; returns 1 where one is beyond its bounds."""
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
    moved = condition.moved(case, outcome)
    name, most = max(moved, key=lambda each: max(each[1].motion, each[1].forces))
    motion, forces = max(each.motion for _, each in moved), max(each.forces for _, each in moved)
    farthest = max(motion, forces)
    if not math.isfinite(farthest):
        return Record(case.name, outcome=outcome), f"{name}: {most.where}"
    within, forces_within = condition.bound(motion), condition.bound(forces)
    reason = f"moving {name} moves it by {farthest:.0e}: {case.kink}" if max(within, forces_within) > 1e-9 else ""
    made = Record(case.name, "", outcome, within, forces_within, float(f"{farthest:.2g}"), reason)
    if farthest > condition.MOST:
        return made, f"it moves by {farthest:.0e}, {name}: {most.where}; shorten it"
    return made, "" if case.kink or not reason else f"it moves by {farthest:.0e}, {name}, and no reason is given"


def quick_cases() -> Sequence[Case]:
    """Return the runs of the quick tests: some of each kind."""
    return [case for case in cases() if case.quick]
