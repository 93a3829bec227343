"""A study whose workers lie, hang, end or go: the others give the same table, and a sentence says what happened."""

from __future__ import annotations

import json
import math
import threading
import time
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from pandas.testing import assert_frame_equal

import mbsd
from mbsd import Mechanism, ModelError
from mbsd.dealing import deal
from mbsd.dealing.report import Report, WrongAnswer, encoded, read_report
from mbsd.dependencies.inputs import Inputs
from mbsd.studies import orders, work
from mbsd.studies.orders import answer_of, reader
from mbsd.studies.work import Order
from tests.studies.fake_cluster import Acts, FakeClient

GRID = {"length": [0.1 * n for n in range(1, 13)]}
NO_INPUTS = Inputs().states()
Numbered = Sequence[tuple[int, Any]]


def build(length: float) -> Mechanism:
    m = Mechanism("bar")
    m.bar("bar", length, mass=1.0)
    return m


def measured(m: Mechanism) -> dict[str, float]:
    time.sleep(0.02)
    length = float(m.bodies["bar"].length or 0.0)
    return {"double": 2.0 * length, "nothing": math.nan, "whole": int(1e20)}


def told(points: Numbered, results: Sequence[Any], seconds: float = 0.01, inputs: Any = NO_INPUTS) -> bytes:
    done = [(number, json.dumps(result).encode()) for (number, _), result in zip(points, results, strict=False)]
    return encoded(Report(done=done, seconds=seconds, note=json.dumps(inputs).encode()))


def each(result: Any) -> Acts:
    """Answers with this for each point."""
    return lambda f, p, _: told(p, [result for _ in p])


def fine(points: Sequence[Any]) -> list[Any]:
    return [[{"double": 1.0}, None, False] for _ in points]


LIES: dict[str, Acts] = {
    "None": lambda f, p, _: None,
    "a list of results": lambda f, p, _: fine(p),
    "text": lambda f, p, _: b"all done",
    "cut short": lambda f, p, s: answer_of(f, p, s)[:-1],
    "other points": lambda f, p, _: told([(number + 100, point) for number, point in p], fine(p)),
    "too few": lambda f, p, _: told(p, fine(p)[1:]),
    "too many": lambda f, p, _: told([*p, *p], fine(p) * 2),
    "a mapping": each({"0": 1.0}),
    "numbers alone": each(1.0),
    "text as a number": each([{"double": "1.0"}, None, False]),
    "a list as a number": each([{"double": [1.0]}, None, False]),
    "a column of the points": each([{"length": 1.0}, None, False]),
    "numbers and a reason": each([{"double": 1.0}, "no", False]),
    "neither numbers nor a reason": each([None, None, False]),
    "a time that is none": lambda f, p, _: told(p, fine(p), math.nan),
    "time that ran backwards": lambda f, p, _: told(p, fine(p), -1.0),
    "inputs of no kind": lambda f, p, _: told(p, fine(p), inputs={"files": {}}),
    "inputs without states": lambda f, p, _: told(p, fine(p), inputs=NO_INPUTS | {"files": ["data.txt"]}),
    "nested without end": lambda f, p, _: (90_000).to_bytes(4, "big") + b"[" * 90_000,
    "a number without end": lambda f, p, _: (90_000).to_bytes(4, "big") + b"9" * 90_000,
    "endless data": lambda f, p, _: bytes(5_000_000 + 2_000_000 * len(p)),
    "an error": lambda f, p, _: (_ for _ in ()).throw(RuntimeError("no")),
    "functions that it cannot load": lambda f, p, s: answer_of(f._replace(functions=b"rubbish"), p, s),
}


def study(client: Any, **more: Any) -> Any:
    return mbsd.study(build, GRID, measured, client, **{"progress": False, "folder": None} | more)


@pytest.fixture(scope="module")
def alone() -> Any:
    return study(None, processes=1)


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    still = SimpleNamespace(catch_warnings=nullcontext, simplefilter=lambda _: None)
    monkeypatch.setattr(work, "warnings", still)  # workers are threads here, and would silence ours
    monkeypatch.setattr(deal, "SURVEY", 0.05)
    monkeypatch.setattr(deal, "TICK", 0.01)


@pytest.mark.parametrize("kind", LIES)
def test_a_worker_that_lies_is_left_out(kind: str, alone: Any) -> None:
    client = FakeClient({"another-liar": LIES[kind], "honest": answer_of} | {"liar": LIES[kind]})
    with pytest.warns(UserWarning, match=r"study: worker .*liar is left out: .*; others do its work"):
        assert_frame_equal(study(client), alone)
    assert client.asked.count("liar") <= 2  # what it had before it was found out


@pytest.mark.filterwarnings("ignore:study")
@pytest.mark.parametrize("after", ["grace", "unknown"])
def test_a_worker_that_never_answers_keeps_nothing_back(
    after: str, monkeypatch: pytest.MonkeyPatch, alone: Any
) -> None:
    monkeypatch.setattr(orders, "FAR", replace(orders.FAR, **{after: 0.3}))

    def hangs(*_: Any) -> None:
        threading.Event().wait(60.0)

    assert_frame_equal(study(FakeClient({"a": hangs, "b": answer_of, "silent": answer_of})), alone)


@pytest.mark.filterwarnings("ignore:study")
def test_points_that_take_longer_than_all_patience_are_waited_for(monkeypatch: pytest.MonkeyPatch, alone: Any) -> None:
    """A worker that is silent may be at work on a long point: a study ends for no such reason."""
    monkeypatch.setattr(orders, "FAR", replace(orders.FAR, unknown=0.05, patience=0.05, times=0.1))
    monkeypatch.setattr(deal, "WAIT", 0.1)

    def slow(order: Order, points: Numbered, sent: Any) -> bytes:
        time.sleep(0.4)
        return answer_of(order, points, sent)

    assert_frame_equal(study(FakeClient({"a": slow, "b": slow})), alone)


def test_the_first_answer_counts_and_a_late_one_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orders, "FAR", replace(orders.FAR, unknown=0.1))
    wakes, came = threading.Event(), threading.Event()

    def late(_: Any, points: Numbered, __: Any) -> bytes:
        client.workers["b"] = soon
        wakes.wait(10.0)
        came.set()
        return told(points, [[{"by": 1.0}, None, False] for _ in points])

    def soon(_: Any, points: Numbered, __: Any) -> bytes:
        if len(client.asked) == 2:
            wakes.set()
            came.wait(10.0)
        return told(points, [[{"by": 2.0}, None, False] for _ in points])

    client = FakeClient({"a": late})
    with pytest.warns(UserWarning, match="worker a has been silent for 0 s; what it had"):
        table = study(client)
    assert client.asked[:2] == ["a", "b"]
    assert came.is_set()
    assert len(table) == len(GRID["length"])
    assert table["by"].isin([1.0, 2.0]).all()


@pytest.mark.filterwarnings("ignore:study")
def test_a_worker_that_ends_each_time_is_not_the_points_fault(alone: Any) -> None:
    """Whoever keeps it starts it again under another name, and it ends again."""
    client = FakeClient({"0": answer_of})

    def ends(*_: Any) -> None:
        name = next(name for name in client.workers if name != "0")
        del client.workers[name]
        client.workers[f"{int(name) + 1}"] = ends
        threading.Event().wait(60.0)

    client.workers["1"] = ends
    assert_frame_equal(study(client), alone)


def test_a_scheduler_that_goes_is_a_sentence_and_what_is_computed_is_kept(tmp_path: Path, alone: Any) -> None:
    client = FakeClient({})

    def goes(order: Order, points: Numbered, sent: Any) -> bytes:
        if len(client.asked) > 3:  # two are under way at a time, so two have come
            client.status = "connecting"
            threading.Event().wait(60.0)
        return answer_of(order, points, sent)

    client.workers["a"] = goes
    with pytest.raises(ModelError, match=r"the scheduler tcp://scheduler:8786 has gone; start it again .* goes on"):
        study(client, folder=tmp_path)
    known = sum(len(file.read_text().splitlines()) - 1 for file in tmp_path.glob("*/*.jsonl"))
    assert known >= 3
    again = FakeClient({"a": answer_of})
    assert_frame_equal(study(again, folder=tmp_path), alone)
    assert len(again.asked) <= len(GRID["length"]) - known


@pytest.mark.parametrize("error", [OSError("in <closed>"), RuntimeError("IOLoop is closed")])
def test_an_error_of_the_connection_is_a_sentence(error: Exception) -> None:
    client = FakeClient({"a": answer_of})

    def fails(**_: Any) -> None:
        raise error

    client.scheduler.identity = fails
    with pytest.raises(ModelError, match="has gone; start it again"):
        study(client)


def test_the_reason_for_waiting_is_reported_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deal, "SOON", 0.1)
    monkeypatch.setattr(deal, "WAIT", 0.5)
    with (
        pytest.warns(UserWarning, match=r"has no worker that can compute it; silent: it does not answer; one is given"),
        pytest.raises(ModelError, match="silent: it does not answer"),
    ):
        study(FakeClient({"silent": answer_of}))


def test_where_all_are_refused_nobody_waits() -> None:
    began = time.monotonic()
    with (
        pytest.warns(UserWarning, match=r"worker other is refused: numpy 0\.1"),
        pytest.raises(ModelError, match=r"other: numpy 0\.1"),
    ):
        study(FakeClient({"other": answer_of}))
    assert time.monotonic() - began < 2.0


def test_answers_survive_the_way_bit_by_bit() -> None:
    values = {"a": 0.1 + 0.2, "b": -0.0, "c": 10**30, "d": True, "e": math.inf, "f": 5e-324, "\u00e9 x": 1}
    points = [{"x": 1}, {"x": 2}]
    answer = told(list(enumerate(points)), [[values, None, False], [None, "why\x1b[2J", True]])
    read = reader(points)
    first, second = (read(number, content) for number, content in read_report(answer, [0, 1], (), 10_000).done)
    assert repr(first.values) == repr(values)
    assert (second.reason, second.passing) == ("why [2J", True)
    with pytest.raises(WrongAnswer):
        read(0, json.dumps([{"x": 1.0}, None, False]).encode())
