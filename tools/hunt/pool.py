"""Cases on several processes, each bounded in time.

A process that hangs is killed, its case counted, and another process started.

The clock of a case stands still while numba compiles, which happens once on a machine for each kind of mechanism.
"""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

from tools.hunt.outcome import BASE, HUNG, WRONG, CaseResult, Outcome

LIMIT = 300.0
"""s of one case without compiling: what is stiff, or touches along outlines, takes up to 200 s."""
KERNEL = 1.0
"""s from which on a kernel was compiled, and not read from the cache."""
PATIENCE = 5.0
"""s of compiling in one process before a word is said."""
Runner = Callable[[int], CaseResult]
BEGINS, COMPILES, COMPILED = "begins", "compiles", "compiled"


def _work(connection: Connection, run: Runner) -> None:
    """Loop of a process: cases until there are no more."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the parent, which ends this
    _tell_of_compiling(connection)
    while (seed := connection.recv()) is not None:
        connection.send(BEGINS)
        try:
            result = run(seed)
        except Exception as error:
            import traceback

            result = CaseResult(
                seed, "?", [Outcome(BASE, WRONG, f"the hunt itself: {error!r}", traceback.format_exc())]
            )
        connection.send(result)


def _tell_of_compiling(connection: Connection) -> None:
    from numba.core.event import Event, Listener, register

    class Told(Listener):
        depth = 0

        def on_start(self, event: Event) -> None:
            self.depth += 1
            if self.depth == 1:
                connection.send(COMPILES)

        def on_end(self, event: Event) -> None:
            self.depth -= 1
            if self.depth == 0:
                connection.send(COMPILED)

    register("numba:compile", Told())


class _Worker:
    """A process and the case it is at."""

    def __init__(self, run: Runner) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process: BaseProcess = context.Process(target=_work, args=(theirs, run), daemon=True)
        self.process.start()
        theirs.close()
        self.seed: int | None = None
        self.spent, self.since, self.waiting = 0.0, time.monotonic(), True
        self.compiles, self.compiled = False, 0.0

    def begin(self, seed: int) -> None:
        """Hand out a case."""
        self.seed, self.spent, self.since, self.waiting = seed, 0.0, time.monotonic(), True
        self.connection.send(seed)

    def seconds(self) -> float:
        """Seconds of the case so far, without the start of the process and without compiling."""
        return self.spent + (0.0 if self.waiting else time.monotonic() - self.since)

    def heard(self, word: str) -> None:
        """The case begins; compiling begins or ends."""
        now = time.monotonic()
        if word == COMPILES:
            self.spent += now - self.since
        if word == COMPILED:
            self.compiled = self.compiling()
        self.waiting = self.compiles = word == COMPILES
        self.since = now

    def compiling(self) -> float:
        """Seconds that kernels have taken so far."""
        lasted = time.monotonic() - self.since if self.compiles else 0.0
        return self.compiled + (lasted if lasted > KERNEL else 0.0)

    def kill(self) -> None:
        """At once."""
        self.process.kill()
        self.process.join()
        self.connection.close()


def results(
    seeds: Iterable[int],
    run: Runner,
    jobs: int | None = None,
    limit: float = LIMIT,
    notice: Callable[[], None] | None = None,
) -> Iterator[CaseResult]:
    """The result of every case, in the order in which they end. ``run`` is a function of a module.

    ``notice`` is called once, where a process has compiled for longer than :data:`PATIENCE`.
    """
    left = iter(seeds)
    first = [seed for _, seed in zip(range(jobs or os.cpu_count() or 1), left, strict=False)]
    workers: list[_Worker] = []
    try:
        for seed in first:
            workers.append(_Worker(run))
            workers[-1].begin(seed)
        while workers:
            ready = wait([worker.connection for worker in workers], timeout=0.5)
            if notice is not None and any(worker.compiling() > PATIENCE for worker in workers):
                notice()
                notice = None
            for worker in list(workers):
                result = _heard(worker) if worker.connection in ready else _overdue(worker, limit)
                if result is None:
                    continue
                yield result
                workers.remove(worker)
                lost = not worker.process.is_alive() or result.outcomes[-1].state == HUNG
                if lost:
                    worker.kill()
                seed = next(left, None)
                if seed is not None:
                    worker = _Worker(run) if lost else worker
                    worker.begin(seed)
                    workers.append(worker)
                elif not lost:
                    worker.connection.send(None)
                    worker.process.join()
    finally:
        for worker in workers:
            worker.kill()


def _heard(worker: _Worker) -> CaseResult | None:
    assert worker.seed is not None
    try:
        word = worker.connection.recv()
    except (EOFError, ConnectionResetError):
        worker.process.join()
        code = worker.process.exitcode
        return CaseResult(worker.seed, "?", [Outcome(BASE, WRONG, f"the process died with exit code {code}")])
    if isinstance(word, CaseResult):
        return word
    worker.heard(word)
    return None


def _overdue(worker: _Worker, limit: float) -> CaseResult | None:
    assert worker.seed is not None
    if worker.seconds() < limit:
        return None
    worker.kill()
    outcome = Outcome(BASE, HUNG, f"not done after {limit:g} s", "the process was killed")
    return CaseResult(worker.seed, "?", [outcome], limit)
