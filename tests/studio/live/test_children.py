"""Processes that a live page begins: children of the warm process, and their end with the server."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import psutil
import pytest

from studio.live.processes.children import Child
from studio.live.processes.nursery import Nursery
from studio.live.processes.trees import MARK
from tests.running.processes import until
from tests.studio.live.arm import ARM
from tests.studio.live.served import WAIT, processes_of

# Children end without harm to each other, with all that they have begun; the warm process may be killed or stopped.


MODULE = "tests.studio.live.ends"
LONG = 60.0
Heard = list[tuple[str, str]]


def opened() -> int:
    return len(os.listdir("/proc/self/fd"))


def is_there(process: int) -> bool:
    try:
        return psutil.Process(process).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


async def wait_until(there: Callable[[], bool]) -> None:
    ends = time.monotonic() + LONG
    while not there():
        assert time.monotonic() < ends
        await asyncio.sleep(0.005)


class Ward:
    """Nursery with the messages of its children."""

    def __init__(self) -> None:
        self.nursery = Nursery(LONG, MODULE)
        self.said: list[str] = []
        self.nursery.say = self.said.append
        self.heard: Heard = []

    def child(self, name: str, **request: Any) -> Child:
        """Return a child that gets one request."""
        child = self.nursery.child(name, self._hear)
        child.ask(1, {"do": "open", **request})
        return child

    async def answer(self) -> tuple[str, str]:
        """Return the next answer."""
        await wait_until(lambda: bool(self.heard))
        return self.heard.pop(0)

    def _hear(self, child: Child, header: dict, _: bytes) -> None:
        self.heard.append((header["kind"], header.get("text", "")))


def with_ward(test: Callable[[Ward], Awaitable[None]]) -> Ward:
    """Run a test in a loop, and end what it has begun."""

    async def run() -> Ward:
        ward = Ward()
        try:
            await test(ward)
        finally:
            await ward.nursery.end()
        return ward

    return asyncio.run(run())


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="counts descriptors in /proc")
def test_children_end_in_every_way_and_leave_nothing() -> None:
    async def test(ward: Ward) -> None:
        await ward.nursery.warm()
        before = opened()
        for name, wanted in (
            ("dies", "exit code 3"),
            ("closes", "its pipe was closed"),
            ("leaves another", ""),
            ("answers", ""),
        ):
            for _ in range(3):
                child = ward.child(name)
                assert wanted in (await ward.answer())[1]
                child.kill()
                child.kill()
                await asyncio.wait_for(child.task, LONG)
                assert not is_there(child.pid)
                assert not ward.heard
        assert opened() <= before
        warm = psutil.Process(ward.nursery.warm_pid)
        await wait_until(lambda: not warm.children(recursive=True))  # a keeper may be on its way out

    with_ward(test)


def test_all_that_a_child_has_begun_ends_with_it(tmp_path: Path) -> None:
    async def test(ward: Ward) -> None:
        file = tmp_path / "begun"
        child = ward.child("begins others", file=str(file))
        await ward.answer()
        others = [int(number) for number in file.read_text().split()]
        assert all(map(is_there, others))
        child.kill()
        await asyncio.wait_for(child.task, LONG)
        assert not any(map(is_there, [child.pid, *others]))

    with_ward(test)


def test_a_child_whose_keeper_was_stopped_ends_too(tmp_path: Path) -> None:
    async def test(ward: Ward) -> None:
        file = tmp_path / "begun"
        child = ward.child("begins others", file=str(file))
        await ward.answer()
        link = child._link
        assert link is not None
        os.kill(link.keeper, signal.SIGSTOP)
        child.kill()
        await asyncio.wait_for(child.task, LONG)
        others = [int(number) for number in file.read_text().split()]
        await wait_until(lambda: not any(map(is_there, [link.keeper, child.pid, *others])))

    with_ward(test)


def test_orphans_of_a_killed_keeper_end_with_the_server(tmp_path: Path) -> None:
    file = tmp_path / "begun"

    async def test(ward: Ward) -> None:
        child = ward.child("begins others", file=str(file))
        await ward.answer()
        assert child._link is not None
        os.kill(child._link.keeper, signal.SIGKILL)
        assert "was ended from outside" in (await ward.answer())[1]
        await wait_until(lambda: not is_there(child.pid))

    with_ward(test)
    others = [int(number) for number in file.read_text().split()]
    assert not any(map(is_there, others))


def test_code_that_holds_pythons_lock_is_ended_when_its_time_is_up() -> None:
    async def test(ward: Ward) -> None:
        ward.nursery.limit = 0.5
        child = ward.child("holds the lock of Python")
        assert "did not end within 0.5 s" in (await ward.answer())[1]
        await asyncio.wait_for(child.task, LONG)
        assert not is_there(child.pid)

    with_ward(test)


def test_code_that_takes_too_much_memory_is_ended() -> None:
    async def test(ward: Ward) -> None:
        ward.nursery.most_bytes = 1 << 29
        child = ward.child("takes memory")
        assert "more than the 0.5 GiB" in (await ward.answer())[1]
        await asyncio.wait_for(child.task, LONG)

    with_ward(test)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_warm_process_that_is_killed_or_stopped_is_replaced(number: signal.Signals) -> None:
    """At the moment at which a child is asked for, while another one serves, which goes on."""

    async def test(ward: Ward) -> None:
        older = ward.child("answers")
        assert (await ward.answer())[0] == "motion"
        warm = ward.nursery.warm_pid
        os.kill(warm, number)
        began = time.monotonic()
        newer = ward.child("answers")
        assert time.monotonic() - began < 1, "nothing waits for it"
        assert (await ward.answer())[0] == "motion"
        assert ward.nursery.warm_pid != warm
        assert not is_there(warm)
        older.ask(2, {"do": "set"})
        assert (await ward.answer())[0] == "motion"
        for child in (older, newer):
            child.kill()

    ward = with_ward(test)
    assert len(ward.said) == 1
    assert ("was stopped" if number == signal.SIGSTOP else "SIGKILL") in ward.said[0]


def test_a_warm_process_that_is_stopped_while_it_loads_is_replaced() -> None:
    async def test(ward: Ward) -> None:
        child = ward.child("answers")
        await wait_until(lambda: ward.nursery.warm_pid is not None)
        os.kill(ward.nursery.warm_pid, signal.SIGSTOP)
        assert (await ward.answer())[0] == "motion"
        child.kill()

    with_ward(test)


def test_a_warm_process_that_cannot_begin_is_an_error_and_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    async def test(ward: Ward) -> None:
        monkeypatch.setattr(ward.nursery, "_module", "no_such_module")
        ward.child("answers")
        assert "cannot be started" in (await ward.answer())[1]
        monkeypatch.setattr(ward.nursery, "_module", MODULE)
        child = ward.child("answers")
        assert (await ward.answer())[0] == "motion"
        child.kill()

    with_ward(test)


# When the server is killed, nothing of what the author's code has begun goes on.


BEGINS = """
import ctypes
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
subprocess.Popen([sys.executable, "-c", "import os, time; os.fork() or os.setsid(); time.sleep(600)"],
                 start_new_session=True)
if os.fork() == 0:
    ctypes.PyDLL(None).sleep(600)  # holds Python's lock
"""
LOOPS = BEGINS + '(HERE / "making").touch()\nwhile True:\n    pass\n'


@pytest.mark.skipif(sys.platform != "linux", reason="reads the environment of other processes in /proc")
def test_nothing_outlives_a_server_that_was_killed(tmp_path: Path) -> None:
    """Servers that end in order are checked by each test that has one (served.py)."""
    folder = tmp_path / "mechanisms"
    (folder / "arm").mkdir(parents=True)
    (folder / "arm" / "mechanism.py").write_text(ARM + BEGINS)
    (folder / "arm" / "parts.py").write_text(LOOPS)
    environment = os.environ | {"MBSD_TEST_PARTS": str(folder), "MBSD_OUT": str(tmp_path / "out")}
    command = [sys.executable, "-m", "tests.studio.live.serving", "arm"]
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, start_new_session=True) as server:
        try:
            until((folder / "arm" / "making").exists, WAIT)
            warm = next(
                child for child in psutil.Process(server.pid).children() if "forking" in " ".join(child.cmdline())
            )
            mark = warm.environ()[MARK]
            assert len(processes_of(mark)) >= 9, "the warm process, two keepers, what they keep and what that has begun"
            server.kill()
            server.wait(WAIT)
            until(lambda: not processes_of(mark), WAIT)
        finally:
            server.kill()
