"""Results that are lost while they are fetched from a worker: made again, each once, and nobody waits for them."""

from __future__ import annotations

import asyncio
import threading
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import CancelledError
from typing import Any

import pytest

from mbsd.dealing import deal, hand
from mbsd.dealing.manner import Manner
from mbsd.dealing.report import Report, encoded
from shared.cluster.deal import Deal, content_hash, perform
from tests.shared.cluster import acting
from tests.studies.fake_cluster import FakeClient, Held

ORDERS = {f"k{n}": n for n in range(12)}
WAIT = 20.0


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hand, "REST", 0.02)
    monkeypatch.setattr(deal, "SURVEY", 0.02)
    monkeypatch.setattr(deal, "TICK", 0.01)


class Losing(FakeClient):
    """Two workers that do what they are asked; something happens to results of the first on their way."""

    def __init__(self, happens: Callable[[list[str]], None], times: int = 1) -> None:
        super().__init__(dict.fromkeys(("losing", "keeping"), self._report), perform)
        self.happens, self.left = happens, times
        self.did: Counter[str] = Counter()
        """How often each order was done."""

    def submit(self, function: Any, *arguments: Any, workers: list[str], **more: Any) -> Held:
        future = super().submit(function, *arguments, workers=workers, **more)
        if workers == ["losing"] and self.left:
            self.left -= 1
            keys = [key for key, _ in arguments[3]]
            future.fetched = lambda: self.happens(keys)
        return future

    def _report(self, do: Any, common: str, needed: Any, orders: list[tuple[str, Any]], sent: Any) -> bytes:
        time.sleep(0.01)
        self.did.update(key for key, _ in orders)
        return encoded(Report(done=[(key, key.encode()) for key, _ in orders], seconds=0.01))


def dealt(client: FakeClient) -> list[tuple[str, str, str]]:
    content = b"in common"
    name = content_hash(content)
    deal_ = Deal(client, acting.work(acting.doubled), name, {name: lambda: content}, ORDERS, ("shared/cluster",))  # pyright: ignore[reportArgumentType]
    answers = list(deal_.results())
    assert Counter(key for key, _, _ in answers) == Counter(ORDERS.keys()), "each once"
    assert all(value == key for key, value, _ in answers)
    return answers


LOST: dict[str, Callable[[], BaseException]] = {
    "cancelled by the scheduler": lambda: CancelledError("k0", "lost dependencies"),
    "cancelled in the loop": asyncio.CancelledError,
    "not there in time": TimeoutError,
    "the connection broke": lambda: OSError("in <TCP (closed) Client>: Stream is closed"),
    "no such key": lambda: KeyError("chunk"),
}


@pytest.mark.parametrize("kind", LOST)
def test_a_lost_result_is_made_again_and_its_worker_goes_on(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    lost: list[str] = []

    def fails(keys: list[str]) -> None:
        lost.extend(keys)
        raise LOST[kind]()

    client = Losing(fails)
    del client.workers["keeping"]
    assert {worker for _, _, worker in dealt(client)} == {"losing"}, "once is no reason to leave it out"
    assert lost
    assert all(client.did[key] == 2 for key in lost)
    said = capsys.readouterr().err
    assert said.count("worker losing: ") == 1
    assert "left out" not in said


def test_a_worker_whose_results_never_arrive_is_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    failed: list[str] = []

    def fails(keys: list[str]) -> None:
        failed.extend(keys)
        if len(failed) == Manner().failures:
            client.workers["keeping"] = client.workers["losing"]
        raise OSError("Stream is closed")

    client = Losing(fails, times=100)
    del client.workers["keeping"]  # it comes later
    answers = dealt(client)
    assert {worker for _, _, worker in answers} == {"keeping"}
    assert "worker losing: OSError: Stream is closed; it is left out" in capsys.readouterr().err


@pytest.mark.parametrize("arrives", [False, True], ids=["never", "late"])
def test_a_worker_that_goes_while_its_result_is_fetched_holds_up_nobody(
    arrives: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    """Dask would make such a result again on that worker alone, which is no more; it may also have been under way."""
    again, over = threading.Event(), threading.Event()

    def goes(keys: list[str]) -> None:
        client.workers.pop("losing", None)
        ends = time.monotonic() + WAIT
        while not all(client.did[key] > 1 for key in keys) and time.monotonic() < ends:
            time.sleep(0.005)
        again.set()
        if not arrives:
            over.wait(WAIT)
            raise TimeoutError

    client = Losing(goes)
    began = time.monotonic()
    answers = dealt(client)
    over.set()
    assert again.is_set()
    assert {worker for _, _, worker in answers} == {"keeping"}
    assert time.monotonic() - began < WAIT / 2
    said = capsys.readouterr()
    assert "worker losing has gone; what it had to do goes to others" in said.out
    assert "worker losing" not in said.err, "it is not blamed"
