"""Orders on workers: all done, each once, whoever dies, fails, stalls or is slow."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import dask.config
import distributed
import pytest

from mbsd.dealing import deal, hand
from mbsd.dealing.connection import tasks_of, workers_of
from mbsd.dealing.identity import together
from mbsd.dealing.manner import Manner
from mbsd.dealing.pools import Dask, Gone
from shared.cluster.deal import Deal, content_hash
from shared.stage.errors import UserError
from tests.shared.cluster import acting

ROOMS = ("shared/cluster",)


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[distributed.Client]:
    """Yield a client of three workers within this process."""
    with (
        pytest.MonkeyPatch.context() as patch,
        dask.config.set({"distributed.client.scheduler-info-interval": "200ms"}),
    ):
        patch.setenv("MBSD_OUT", str(tmp_path_factory.mktemp("out")))
        with (
            distributed.LocalCluster(
                n_workers=3, threads_per_worker=1, processes=False, dashboard_address=None
            ) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):
            yield client


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hand, "REST", 0.05)
    monkeypatch.setattr(deal, "SURVEY", 0.1)
    monkeypatch.setattr(deal, "TICK", 0.02)


def dealt(client: distributed.Client, work: Callable[..., Any], orders: dict[str, Any], **more: Any) -> Deal:
    content = b"in common"
    name = content_hash(content)
    return Deal(client, acting.work(work), name, {name: lambda: content}, orders, ROOMS, **more)


def first_worker(client: distributed.Client) -> str:
    """Return the first worker by its address, since the client's own view may be outdated."""
    client.wait_for_workers(3, timeout=60)
    assert isinstance(client.cluster, distributed.LocalCluster)
    assert client.cluster.scheduler is not None
    return sorted(client.cluster.scheduler.workers)[0]


def test_all_orders_are_done_once_with_their_inputs(client: distributed.Client) -> None:
    orders = {f"k{n}": n for n in range(200)}
    answers = list(dealt(client, acting.doubled, orders).results())
    assert {key: value for key, value, _ in answers} == {f"k{n}": f"in common{n}{n}" for n in range(200)}
    assert len(answers) == 200
    assert len({worker for _, _, worker in answers}) == 3


def test_inputs_are_sent_only_where_they_lack(client: distributed.Client) -> None:
    asked = []
    content = os.urandom(1000)
    name = content_hash(content)

    def give() -> bytes:
        asked.append(1)
        return content

    for _ in range(2):
        orders = {f"k{n}": n for n in range(30)}
        list(Deal(client, acting.work(acting.doubled), name, {name: give}, orders, ROOMS).results())
    assert 1 <= len(asked) <= 3  # these three have one folder


def test_a_worker_that_fails_gives_its_orders_to_others(client: distributed.Client) -> None:
    sick = first_worker(client)
    work = dealt(client, acting.refusing, {f"k{n}": sick for n in range(20)})
    answers = list(work.results())
    assert len(answers) == 20
    assert sick not in {value for _, value, _ in answers}


def test_an_order_that_fails_everywhere_is_told(client: distributed.Client) -> None:
    orders = {f"k{n}": "never" for n in range(5)} | {"bad": "always"}
    with pytest.raises(UserError, match="frame of always: the disk is full"):
        list(dealt(client, acting.refusing, orders).results())


def test_a_worker_that_stalls_keeps_nothing_back(client: distributed.Client) -> None:
    started = time.monotonic()
    stalling = first_worker(client)
    work = dealt(client, acting.hanging, {f"k{n}": stalling for n in range(12)}, patience=0.7)
    answers = list(work.results())
    assert Counter(key for key, _, _ in answers) == Counter([f"k{n}" for n in range(12)])
    assert time.monotonic() - started < acting.HANGS or stalling in {value for _, value, _ in answers}
    time.sleep(acting.HANGS)  # the sleeper wakes up before the next test


def test_a_worker_that_answers_after_all_gets_orders_again() -> None:
    worker = hand.Hand("w", Manner(patience=0.0), fit=True, groups=[hand.Group(["a"])])
    assert worker.is_overdue()
    worker.stalled = True
    assert not worker.is_ready()
    worker.drop(worker.groups[0])
    assert worker.is_ready()


def test_workers_that_have_nothing_to_do_take_over_from_slow_ones(client: distributed.Client) -> None:
    """The last order is with a worker that should take long; another does it as well, and one answer is kept."""
    orders = {f"k{n}": 0.05 for n in range(12)}
    work = dealt(client, acting.slow, orders)
    keys = [key for key, _, _ in work.results()]
    assert Counter(keys) == Counter(orders.keys())


def test_workers_with_other_sources_are_refused_by_name(client: distributed.Client) -> None:
    work = dealt(client, acting.doubled, {"k": 1})
    assert work.trust is not None
    work.trust = work.trust._replace(ours=dict(work.trust.ours) | {"numpy": "0.1"})
    name = first_worker(client)
    with pytest.raises(UserError, match=f"{name}, .*: numpy .*, here 0.1") as refusal:
        list(work.results())
    assert "make worker" in str(refusal.value)


def test_no_worker_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deal, "WAIT", 0.3)
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
        pytest.raises(UserError, match="for there is none"),
    ):
        list(dealt(client, acting.doubled, {"k": 1}).results())


def test_killed_workers_lose_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "out"))
    orders = {f"k{n}": str(tmp_path / ("dies" if n == 5 else f"lives{n}")) for n in range(40)}
    with (
        dask.config.set({"distributed.client.scheduler-info-interval": "200ms"}),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        answers = list(dealt(client, acting.deadly, orders).results())
    assert Counter(key for key, _, _ in answers) == Counter(orders.keys())
    assert (tmp_path / "dies").exists()


def test_workers_with_one_reason_are_told_together() -> None:
    reasons = {f"w{n}": "numpy 1, here 2" for n in range(5)} | {"x": "Python 3.12, here 3.13"}
    assert list(together(reasons)) == [("x", "Python 3.12, here 3.13"), ("w0, w1, w2 and 2 more", "numpy 1, here 2")]


def test_a_client_that_gives_up_while_it_asks_has_lost_the_scheduler() -> None:
    """Its pool of connections is closed between two looks at its status, and it raises no OSError then."""
    cluster = distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None)
    client = distributed.Client(cluster, set_as_default=False)
    client.sync(client.rpc.close)
    with pytest.raises((OSError, RuntimeError)):
        workers_of(client)
    assert Dask(client).there() is None
    assert tasks_of(client) == {}
    client.close()
    with pytest.raises(Gone):
        Dask(client).there()
    cluster.close()
