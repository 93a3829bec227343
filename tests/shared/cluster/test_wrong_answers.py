"""Workers that answer with something else than what was ordered: left out by name, and others do their work."""

from __future__ import annotations

import functools
import time
from collections import Counter
from collections.abc import Iterator
from typing import Any

import distributed
import pytest

from mbsd.dealing import deal, hand
from mbsd.dealing.report import WrongAnswer, printable
from shared.cluster.deal import Deal, Work, content_hash
from shared.stage.errors import UserError
from tests.shared.cluster import lying

ORDERS = {f"k{n}": n for n in range(6)}


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[distributed.Client]:
    """Yield a client of two workers within this process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(tmp_path_factory.mktemp("out")))
        with (
            distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, processes=False, dashboard_address="127.0.0.1:0"
            ) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):
            yield client


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hand, "REST", 0.05)
    monkeypatch.setattr(deal, "SURVEY", 0.05)
    monkeypatch.setattr(deal, "TICK", 0.01)


def done_or_refused(key: str, content: bytes) -> str:
    if content != b"done":
        raise WrongAnswer(f"'{key}' is {content[:10]!r}")
    return "done"


def dealt(client: distributed.Client, orders: dict[str, Any] = ORDERS, do: Any = lying.small, **more: Any) -> Deal:
    content = b"in common"
    name = content_hash(content)
    return Deal(client, Work(do, done_or_refused, 10_000), name, {name: lambda: content}, orders, ("shared/cluster",),
                **more)  # fmt: skip


def workers(client: distributed.Client) -> list[str]:
    assert isinstance(client.cluster, distributed.LocalCluster)
    assert client.cluster.scheduler is not None
    return sorted(client.cluster.scheduler.workers)


@pytest.mark.parametrize("kind", lying.LIES)
def test_a_worker_that_lies_is_left_out_and_the_other_does_all(
    client: distributed.Client, kind: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    liar, honest = workers(client)
    monkeypatch.setattr("shared.cluster.deal.perform", functools.partial(lying.lie, kind, liar))
    answers = list(dealt(client).results())
    assert Counter(key for key, _, _ in answers) == Counter(ORDERS.keys())
    assert {(value, worker) for _, value, worker in answers} == {("done", honest)}
    said = capsys.readouterr().err
    assert said.count(f"worker {liar} sent a wrong answer: ") == 1
    assert "it is left out" in said


def test_where_all_lie_the_run_ends_with_their_names(
    client: distributed.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    def all_lie(*_: Any) -> None:
        return None

    monkeypatch.setattr("shared.cluster.deal.perform", all_lie)
    began = time.monotonic()
    with pytest.raises(UserError, match=r"no worker of the cluster can do this; .*answers with NoneType") as refusal:
        list(dealt(client).results())
    assert all(name in str(refusal.value) for name in workers(client))
    assert time.monotonic() - began < 10.0


def test_what_a_worker_says_is_printed_as_one_line_of_plain_text() -> None:
    assert printable("a\x1b[2Jb\nc\r\u202ed") == "a [2Jb c d"
    assert len(printable("x" * 10_000)) < 500


def test_a_worker_that_others_keep_busy_is_asked_at_once(
    client: distributed.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its packages are known before it has time; a run once waited for them, and ended after a minute."""
    monkeypatch.setattr(deal, "WAIT", 0.5)
    busy = [client.submit(time.sleep, 1.5, workers=[name], pure=False) for name in workers(client)]
    assert len(list(dealt(client).results())) == len(ORDERS)
    assert all(future.done() for future in busy)


def test_the_reason_for_waiting_is_reported_soon(
    client: distributed.Client, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The only worker that was fit has gone: it may come back, so it is waited for, and that is said."""
    monkeypatch.setattr(deal, "SOON", 0.1)
    monkeypatch.setattr(deal, "WAIT", 0.5)
    work = dealt(client)
    assert work.trust is not None
    work.trust = work.trust._replace(ours=dict(work.trust.ours) | {"numpy": "0.1"})
    work._lost_one = True
    began = time.monotonic()
    with pytest.raises(UserError, match=r"here 0\.1"):
        list(work.results())
    assert time.monotonic() - began > 0.45
    assert "one is given 0.5 s to come (make worker)" in capsys.readouterr().err
