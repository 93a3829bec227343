"""One dealer for this process and for processes beside it: all orders once, whoever ends a process."""

from __future__ import annotations

import logging
import os
import signal
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import pytest

from mbsd.dealing.deal import Deal
from mbsd.dealing.manner import Kind, Manner
from mbsd.dealing.pools import Here, Processes
from mbsd.dealing.report import Report, encoded
from mbsd.dealing.voice import Voice

SAID: list[str] = []
VOICE = Voice(SAID.append, SAID.append, RuntimeError, str, *["no worker"] * 9)


def squares(orders: Sequence[tuple[int, int]], sent: Mapping[str, bytes]) -> bytes:
    """The squares of whole numbers; a negative one ends the process."""
    for _, number in orders:
        if number < 0:
            os.kill(os.getpid(), signal.SIGKILL)
        if number == 0:
            raise SystemExit
    done = [(key, str(number**2).encode()) for key, number in orders]
    return encoded(Report(done=done, note=f"{os.getpid()}".encode(), seconds=1e-3 * len(orders)))


KIND = Kind(squares, (), lambda _, content: int(content), 100, int, lambda _: "dead")


def dealt(pool: Here, orders: Mapping[int, int], manner: Manner) -> tuple[dict[int, Any], set[int]]:
    """Results by key, and the processes that gave them."""
    parts = list(Deal(pool, KIND, orders, VOICE, manner).parts())
    keys = Counter(key for part in parts for key, _ in part.results)
    assert keys == Counter(orders.keys()), "each once"
    return {key: result for part in parts for key, result in part.results}, {part.note for part in parts} - {None}


def test_this_process_does_all_by_itself() -> None:
    results, processes = dealt(Here(), {n: n + 1 for n in range(500)}, Manner())
    assert results == {n: (n + 1) ** 2 for n in range(500)}
    assert processes == {os.getpid()}


@pytest.mark.parametrize("deadly", [-1, 0], ids=["killed", "exit()"])
def test_an_order_that_ends_its_process_is_found_and_the_others_are_done(deadly: int) -> None:
    orders = {n: n + 1 for n in range(60)} | {17: deadly}
    pool = Processes(2, logging.getLogger)
    try:
        results, processes = dealt(pool, orders, Manner(copies=1, first_alone=True, target=0.02))
    finally:
        pool.close()
    assert results.pop(17) == "dead"
    assert results == {n: (n + 1) ** 2 for n in range(60) if n != 17}
    assert os.getpid() not in processes
    assert len(processes) > 1
    assert "worker process" in SAID[-1]


def test_a_wrong_answer_of_this_process_is_no_endless_loop() -> None:
    kind = KIND._replace(task=lambda orders, sent: b"rubbish")
    with pytest.raises(RuntimeError, match="no worker"):
        list(Deal(Here(), kind, {1: 1}, VOICE).results())
