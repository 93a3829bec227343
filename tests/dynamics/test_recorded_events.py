"""Runs with events are as recorded in tools/numbers/events, and small changes of a model are found."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from mbsd import Mechanism
from tools.numbers.events.commands import IN_LOOP, compare, quick_cases, verdict
from tools.numbers.events.difference import MOST
from tools.numbers.events.record import Case, Record, read
from tools.numbers.events.table import cases

RECORDS: dict[str, Record] = read()
QUICK = quick_cases()
GROUP = 20
"""Runs of a slow test."""
ALL = [case for case in cases() if not case.quick]


@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
def test_some_runs_of_each_kind_are_as_recorded(case: Case) -> None:
    compared = verdict(case, RECORDS)
    assert compared.is_good, compared


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, len(ALL), GROUP), ids=lambda first: ALL[first].name)
def test_all_others_are_as_recorded(first: int) -> None:
    verdicts = [verdict(case, RECORDS) for case in ALL[first : first + GROUP]]
    assert not [str(each) for each in verdicts if not each.is_good]


def test_records_are_those_of_the_runs_and_bounds_have_a_reason() -> None:
    assert list(RECORDS) == [case.name for case in cases()]
    assert len(RECORDS) >= 120
    for record in RECORDS.values():
        assert (record.outcome is None) == bool(record.same_as)
        assert record.moved <= MOST
        assert max(record.within, record.forces_within) <= 1e-9 or record.reason


@pytest.mark.slow
def test_rows_of_many_move_as_recorded() -> None:
    """Steps of a fixed length end at outputs, which are others here."""
    verdicts = list(compare(""))
    assert sum(each.way.startswith(IN_LOOP) for each in verdicts) > 480
    fixed = ("alpha", "rattle", "rk4", "symplectic", "baumgarte")
    rows = [each for each in verdicts if each.way.startswith(IN_LOOP) and not each.name.endswith(fixed)]
    assert not [each for each in rows if not each.apart <= each.within]


def _named(name: str) -> Case:
    return next(case for case in cases() if case.name == name)


CHANGES = {
    "ball 0.5 from 1": lambda m: m.change("floor", restitution=0.5 * (1 + 1e-6)),
    "pendulum at a stop 0.5": lambda m: m.change("post lower", restitution=0.5 * (1 + 1e-6)),
    "disc that slides and rolls 0.25": lambda m: m.change("road", friction=0.25 * (1 + 1e-6), static_friction=0.3),
    "lever and ball": lambda m: m.change("rub", coefficient=0.5 * (1 + 1e-6)),
    "geneva of 4, independent": lambda m: m.change("crank", inertia=1e-3 * (1 + 1e-6)),
    "swing": lambda m: m.change("drive", torque=1.5 * (1 + 1e-6)),
    "rope 0": lambda m: m.change("rope", length=1.0 + 1e-6),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_number_that_is_changed_by_a_millionth_is_found(name: str) -> None:
    case = _named(name)

    def changed() -> Mechanism:
        m = case.build()
        CHANGES[name](m)
        return m

    compared = verdict(replace(case, build=changed), RECORDS)
    assert not compared.is_good
    assert compared.difference.motion > compared.within


def test_what_else_happens_is_found_and_said() -> None:
    case = _named("two balls that land at one instant")
    assert "events before" in verdict(replace(case, duration=1.2), RECORDS).difference.where
    assert "outputs before" in verdict(replace(case, steps=11), RECORDS).difference.where
    record = RECORDS[case.name]
    assert record.outcome is not None
    held = [*record.outcome.held[:-1], (record.outcome.held[-1][0] + 1, record.outcome.held[-1][1])]
    other = _with_held(record, held)
    assert "other rows hold" in verdict(case, {case.name: other}).difference.where


def _with_held(record: Record, held: list[tuple[int, str]]) -> Record:
    """A record in which other rows hold."""
    assert record.outcome is not None
    return msgspec.structs.replace(record, outcome=msgspec.structs.replace(record.outcome, held=held))


def test_a_refusal_without_its_words_is_found() -> None:
    case = _named("event without a number")
    compared = verdict(replace(case, refused=("'other event'",)), RECORDS)
    assert not compared.is_good
    assert "does not say" in str(compared)
    moving = replace(case, build=_named("ball 0.5 from 1").build)
    assert not verdict(moving, RECORDS).is_good
