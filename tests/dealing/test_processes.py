"""One dealer for this process and for processes beside it: all orders once, whoever ends a process."""

from __future__ import annotations

import logging
import os
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from mbsd.dealing.deal import Deal
from mbsd.dealing.manner import Kind, Manner, Voice
from mbsd.dealing.pools import Here, Processes
from mbsd.dealing.report import Report, encoded
from tests.running.processes import until

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


STUDY = """
import os, sys, time
from pathlib import Path
from mbsd.dealing.pools import Processes

def begin(folder):
    (Path(folder) / str(os.getpid())).touch()

def work(seconds):
    time.sleep(seconds)
    return b""

if __name__ == "__main__":
    pool = Processes(2, begin, sys.argv[1])
    for name in pool.there():
        pool.submit(name, work, (60.0,), 1, print)
    time.sleep(60.0)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc")
def test_processes_end_with_the_one_that_started_them_though_it_is_killed(tmp_path: Path) -> None:
    (tmp_path / "begun").mkdir()
    script = tmp_path / "killed_study.py"
    script.write_text(STUDY)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), os.getcwd()])}
    starter = subprocess.Popen(
        [sys.executable, "-c", "import killed_study, runpy; runpy.run_module('killed_study', run_name='__main__')",
         str(tmp_path / "begun")],
        env=environment,
    )  # fmt: skip
    try:
        until(lambda: len(os.listdir(tmp_path / "begun")) == 2, 60.0)
        workers = [int(name) for name in os.listdir(tmp_path / "begun")]
        assert all(is_alive(worker) for worker in workers)
        starter.kill()
        starter.wait()
        until(lambda: not any(is_alive(worker) for worker in workers), 20.0)
    finally:
        starter.kill()


def is_alive(process: int) -> bool:
    """Return True if a process runs; one that has ended and waits for its parent does not."""
    try:
        return ") Z " not in Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False


def test_a_wrong_answer_of_this_process_is_no_endless_loop() -> None:
    kind = KIND._replace(task=lambda orders, sent: b"rubbish")
    with pytest.raises(RuntimeError, match="no worker"):
        list(Deal(Here(), kind, {1: 1}, VOICE).results())
