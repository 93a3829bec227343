"""A study over Dask gives the table of a local one; workers that do not fit are refused by name."""

from __future__ import annotations

import os
import signal
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from types import SimpleNamespace
from typing import Any

import dask.config
import distributed
import pytest
from pandas.testing import assert_frame_equal

import mbsd
from mbsd import Mechanism, ModelError
from mbsd.studies import remote

LENGTHS = {"length": [0.1, 0.2, 0.3, -0.1, 0.5, 0.6]}
QUIET = {"progress": False, "folder": None}


def build(length: float) -> Mechanism:
    m = Mechanism("pendulum")
    bar = m.bar("bar", length, mass=1.0)
    m.revolute("O", m.ground.at(0, 0), bar.start)
    m.start_near(bar=30)
    return m


def fastest(m: Mechanism) -> dict[str, float]:
    return {"fastest": float(m.simulate(0.5, steps=20).body("bar").omega.max())}


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Two workers, processes of their own on loopback."""
    settings = {"distributed.scheduler.allowed-failures": 0, "distributed.worker.daemon": True}
    with (
        dask.config.set(settings),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_the_table_is_that_of_a_local_study(client: Any) -> None:
    alone = mbsd.study(build, LENGTHS, fastest, processes=1, **QUIET)
    assert list(alone["reason"].notna()).count(True) == 1
    assert_frame_equal(mbsd.study(build, LENGTHS, fastest, client, **QUIET), alone)
    assert_frame_equal(mbsd.study(build, LENGTHS, fastest, client.scheduler.address, **QUIET), alone)


def test_a_point_that_ends_workers_is_told(client: Any) -> None:
    def deadly(m: Mechanism) -> dict[str, float]:
        if m.bodies["bar"].length == 0.3:
            os.kill(os.getpid(), signal.SIGKILL)
        return fastest(m)

    table = mbsd.study(build, LENGTHS, deadly, client, **QUIET)
    assert list(table["reason"].notna()).count(True) == 2
    assert table["reason"][2].startswith("its process was ended")


def test_workers_with_other_versions_are_refused_by_name(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    ours = remote.versions() | {"numpy": "1.0"}
    monkeypatch.setattr(remote, "versions", lambda: ours)
    [name, *_] = client.scheduler_info(n_workers=-1)["workers"]
    with warnings.catch_warnings(), pytest.raises(ModelError, match=f"{name}: numpy .*, here 1.0; start workers"):
        warnings.simplefilter("ignore")
        mbsd.study(build, LENGTHS, fastest, client, **QUIET)


class Lost:
    """A chunk's future whose result goes with its worker while it comes: it is there only when cancelled."""

    def __init__(self) -> None:
        self.asked, self._given_up = threading.Event(), threading.Event()

    def add_done_callback(self, done: Callable[[Any], None]) -> None:
        threading.Thread(target=done, args=(self,), daemon=True).start()

    def cancelled(self) -> bool:
        return self._given_up.is_set()

    def cancel(self) -> None:
        self._given_up.set()

    def result(self) -> Any:
        self.asked.set()
        assert self._given_up.wait(10.0)
        raise CancelledError


class Found(Lost):
    """One whose result comes."""

    def result(self) -> Any:
        return "the result"


def test_a_result_that_goes_with_its_worker_is_made_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was done, and its worker was killed before it came: nobody waits for it for ever."""
    futures, living = [Lost(), Found()], iter([["first"], ["second"], ["second"]])
    client = SimpleNamespace(status="running", submit=lambda *_, **__: futures[handed.pop(0)])
    handed, lost = [0, 1], futures[0]
    monkeypatch.setattr(remote.Cluster, "_look", lambda _: None)
    monkeypatch.setattr(remote.Cluster, "_living", lambda _: frozenset(next(living)))
    monkeypatch.setattr(remote.Cluster, "_wait_for_workers", lambda self: self._living())
    cluster = remote.Cluster(b"", client)
    promise = cluster.submit([])
    assert lost.asked.wait(10.0)
    cluster.look_after()
    assert promise.result(10.0) == "the result"
    assert lost.cancelled()
