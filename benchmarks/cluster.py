"""Cost of a cluster, ``python -m benchmarks cluster``: the coordinator's, and two workers beside one.

``python -m benchmarks.cluster ADDRESS COUNT`` runs workers in one process; their tasks stand for frames.
"""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import psutil

from mbsd.dealing import hand
from mbsd.dealing.connection import workers_of
from shared.cluster.__main__ import scheduler_command, worker_command
from shared.cluster.address import connected
from shared.cluster.deal import Deal, Work, content_hash
from shared.stage.console import markdown_table, say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from shared.stage.signals import end_with_parent

HEAD = ("workers", "tasks", "in groups of", "wall, ms a task", "coordinator, ms a task", "scheduler, ms a task")
COUNTS = ((64, 100), (64, 1000), (64, 10_000), (8, 10_000), (1, 1000))
"""Workers and tasks."""
SECONDS, TASKS = 0.5, 60
"""Duration (s) of a task, and how many there are, for two workers against one."""
WANTED = 1.8
IDLE = 0.5
"""Load of the machine, in cores, up to which tasks that take processor time say something."""

PICTURE = bytes(20_000)
"""As large as a picture of a postage stamp."""


def nothing(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """A picture at once."""
    return PICTURE


def waiting(files: Mapping[str, Path], common: str, order: float) -> bytes:
    """So many seconds that take no core."""
    time.sleep(order)
    return b"done"


def burning(files: Mapping[str, Path], common: str, order: float) -> bytes:
    """So many seconds of processor time."""
    end = time.thread_time() + order
    while time.thread_time() < end:
        sum(range(2000))
    return b"done"


def measured() -> int:
    """Print the table and the ratio; 1 if two workers do less than 1.8 times the work of one.

    Tasks that wait need no core, so a machine that others use tells of them what the deal itself costs. On one that
    does nothing else tasks that take processor time are measured as well.
    """
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        os.environ["MBSD_OUT"] = folder
        rows = [_row(workers, tasks, largest) for workers, tasks in COUNTS for largest in (1, hand.LARGEST)]
        print(*markdown_table(HEAD, rows), sep="\n", flush=True)
        ratios = [_ratio(waiting, f"{SECONDS} s each")]
        if load <= IDLE:
            ratios.append(_ratio(burning, f"{SECONDS} s of processor time each"))
        else:
            say("bench", f"a load of {load:.1f}: tasks that take processor time were left out")
    return 0 if min(ratios) >= WANTED else 1


def _ratio(task: Callable[..., Any], what: str) -> float:
    single, two = _taken(1, task), _taken(2, task)
    say(
        "bench",
        f"{TASKS} tasks, {what}: one worker {single:.1f} s, two on separate cores {two:.1f} s: {single / two:.2f}x",
    )
    return single / two


def _row(workers: int, tasks: int, largest: int) -> list[str]:
    with _cluster([[sys.executable, "-m", "benchmarks.cluster", "ADDRESS", str(workers)]]) as (where, process):
        hand.LARGEST, kept = largest, hand.LARGEST
        try:
            _deal(where, workers, nothing, dict.fromkeys(map(str, range(workers)), 0))  # all are known, none lacks
            scheduler = psutil.Process(process)
            before, own = scheduler.cpu_times(), time.process_time()
            wall = _deal(where, workers, nothing, dict.fromkeys(map(str, range(tasks)), 0))
            after, own = scheduler.cpu_times(), time.process_time() - own
        finally:
            hand.LARGEST = kept
    theirs = after.user + after.system - before.user - before.system
    return [*map(str, (workers, tasks, largest)), *(f"{1000 * seconds / tasks:.2f}" for seconds in (wall, own, theirs))]


def _taken(workers: int, task: Callable[..., Any]) -> float:
    """Wall seconds of all tasks by workers with a core each."""
    pinned = [["taskset", "-c", str(core)] if sys.platform == "linux" else [] for core in range(workers)]
    with _cluster([[*pin, *worker_command("ADDRESS", "127.0.0.1", f"w{n}")] for n, pin in enumerate(pinned)]) as (
        where,
        _,
    ):
        _deal(where, workers, task, dict.fromkeys(map(str, range(workers)), 0.01))
        return _deal(where, workers, task, dict.fromkeys(map(str, range(TASKS)), SECONDS))


def _deal(where: str, workers: int, task: Callable[..., Any], orders: dict[str, Any]) -> float:
    content = b"the scene"
    name = content_hash(content)
    kind = Work(task, lambda _, result: result, len(PICTURE))
    with connected(where) as client:
        end = time.monotonic() + 300
        while len(workers_of(client)) < workers:
            if time.monotonic() > end:
                raise UserError(f"bench: {workers} workers did not start within five minutes")
            time.sleep(0.1)
        started = time.perf_counter()
        done = list(Deal(client, kind, name, {name: lambda: content}, orders, ("shared/cluster",)).results())
        seconds = time.perf_counter() - started
    if len(done) != len(orders):
        raise UserError(f"bench: {len(done)} of {len(orders)} tasks came back")
    return seconds


@contextmanager
def _cluster(workers: list[list[str]]) -> Iterator[tuple[str, int]]:
    """A scheduler and these workers; its address and process."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port = listener.getsockname()[1]
    where = f"tcp://127.0.0.1:{port}"
    commands = [scheduler_command("127.0.0.1", port)]
    commands += [[where if word == "ADDRESS" else word for word in command] for command in workers]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    started: list[subprocess.Popen[bytes]] = []
    with (Path(os.environ["MBSD_OUT"]) / "log").open("wb") as log:
        try:
            for command in commands:
                ends = partial(end_with_parent, signal.SIGTERM)
                started.append(
                    subprocess.Popen(command, cwd=ROOT, env=environment, stdout=log, stderr=log, preexec_fn=ends)
                )
                _wait_for(port)
            yield where, started[0].pid
        finally:
            for process in reversed(started):
                process.terminate()
            for process in started:
                process.wait(timeout=60)


def _wait_for(port: int) -> None:
    end = time.monotonic() + 60
    while time.monotonic() < end:
        try:
            socket.create_connection(("127.0.0.1", port), 1).close()
            return
        except OSError:
            time.sleep(0.1)
    raise UserError("bench: the scheduler did not start within a minute")


async def main(address: str, count: int) -> None:
    """Run workers until the process is ended."""
    from distributed import Worker

    workers = [Worker(address, nthreads=1, name=f"simulated-{number}", dashboard=False) for number in range(count)]
    await asyncio.gather(*workers)
    await asyncio.gather(*(worker.finished() for worker in workers))


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1], int(sys.argv[2])))
