"""Who does the work: this process, processes beside it, or the workers of a Dask cluster."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor, Future
from contextlib import suppress
from typing import Any

from mbsd.dealing.connection import size_of, tasks_of, workers_of
from mbsd.dealing.report import refuse_large

FETCH = 60.0
"""Seconds that a finished result may be on its way."""
WATCH = 0.5
"""Seconds between two looks at the process that started this one."""
SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
"""Each process works on one core."""

Then = Callable[[Any], None]
"""Called with an answer, or with the exception in its place, in any thread."""
Task = Callable[..., bytes]


class Gone(Exception):
    """The scheduler has gone."""


class Here:
    """This very process, so that breakpoints work; others have the same methods, which wait for nothing."""

    where = ""
    """The address of the scheduler, if there is one."""

    def there(self) -> Mapping[str, int] | None:
        """Return the threads of each worker that is there, by name; None if not known now. Raises Gone."""
        return {"here": 1}

    def busy(self) -> Mapping[str, int]:
        """Return the tasks of workers, those of other programs included."""
        return {}

    def ask(self, name: str, asked: Callable[[], bytes], then: Then) -> None:
        """Have a worker say what it works with, even while it does something for others."""
        then(asked())

    def submit(self, name: str, task: Task, arguments: tuple[Any, ...], most: int, then: Then) -> Callable[[], object]:
        """Have a worker do something whose answer has ``most`` bytes at most; what calls it back. Raises Gone.

        BrokenExecutor in place of an answer says that its process ended by it.
        """
        then(task(*arguments))
        return bool

    def close(self) -> None:
        """Leave nothing behind."""


class Processes(Here):
    """Processes of this computer, each begun with ``begin(*arguments)``.

    One that is killed has a successor. They import nothing of the script that started them, and end with the process
    that did, however it ends. Raises ImportError where loky is not installed.
    """

    def __init__(self, count: int, begin: Callable[..., None], *arguments: Any) -> None:
        from loky import ProcessPoolExecutor

        def start() -> Any:
            executor = ProcessPoolExecutor(1, initializer=_begin, initargs=(os.getpid(), begin, arguments), env=SINGLE)
            executor.submit(bool)  # it loads what it needs now
            return executor

        self._start, self._count, self._started = start, count, 0
        self._running: dict[str, Any] = {}
        self._ended: list[Any] = []

    def there(self) -> Mapping[str, int]:
        """Return the running processes, with new ones for those that ended."""
        while len(self._running) < self._count:
            self._started += 1
            self._running[f"process {self._started}"] = self._start()
        return dict.fromkeys(list(self._running), 1)

    def submit(self, name: str, task: Task, arguments: tuple[Any, ...], most: int, then: Then) -> Callable[[], object]:
        """Submit to one of the processes."""
        try:
            future = self._running[name].submit(task, *arguments)
        except (BrokenExecutor, KeyError) as error:
            future = Future[bytes]()
            future.set_exception(error if isinstance(error, BrokenExecutor) else BrokenExecutor(name))
        future.add_done_callback(lambda done: self._answered(name, done, then))
        return future.cancel

    def _answered(self, name: str, future: Future[bytes], then: Then) -> None:
        answer = _outcome(future.result)
        if isinstance(answer, BrokenExecutor) and name in self._running:
            self._ended.append(self._running.pop(name))
        then(answer)

    def close(self) -> None:
        """End all processes."""
        for executor in (*self._running.values(), *self._ended):
            executor.shutdown(wait=True, kill_workers=True)


def _begin(starter: int, begin: Callable[..., None], arguments: tuple[Any, ...]) -> None:
    """Begin a process that ends with the one that started it, which a SIGKILL leaves no time to tell it."""
    threading.Thread(target=_end_with, args=(starter,), daemon=True).start()
    begin(*arguments)


def _end_with(starter: int) -> None:
    while os.getppid() == starter:
        time.sleep(WATCH)
    os._exit(1)


class Dask(Here):
    """The workers of a Dask cluster. ``strict`` gives it up as soon as the connection breaks."""

    def __init__(self, client: Any, strict: bool = False) -> None:
        self.client, self.strict = client, strict
        self.where = getattr(client.scheduler, "address", "")

    def there(self) -> Mapping[str, int] | None:
        """Return the workers that the scheduler knows."""
        self._refuse_gone()
        try:
            workers = workers_of(self.client)
        except (OSError, RuntimeError) as error:  # the latter where the client gives up while it asks
            if self.strict and not isinstance(error, TimeoutError):
                raise Gone from error
            self._refuse_gone()
            return None
        return {name: max(1, int(worker["nthreads"])) for name, worker in workers.items()}

    def busy(self) -> Mapping[str, int]:
        """Return the tasks of all programs."""
        return tasks_of(self.client)

    def ask(self, name: str, asked: Callable[[], bytes], then: Then) -> None:
        """Ask outside of what it has to do."""
        client = self.client
        run_aside(lambda: then(_outcome(lambda: client.run(asked, workers=[name], on_error="return").get(name))))

    def submit(self, name: str, task: Task, arguments: tuple[Any, ...], most: int, then: Then) -> Callable[[], object]:
        """Submit to this worker alone."""
        try:
            future = self.client.submit(
                task, *arguments, workers=[name], allow_other_workers=False, pure=False, retries=0
            )
        except Exception as error:
            if self.client.status != "running":
                raise Gone from error
            raise
        future.add_done_callback(lambda _: run_aside(lambda: then(_outcome(lambda: self._fetched(future, most)))))

        def call_back() -> None:
            with suppress(Exception):  # the scheduler has gone, and the future with it
                future.release()

        return call_back

    def _fetched(self, future: Any, most: int) -> Any:
        refuse_large(size_of(self.client, future.key), most)
        try:
            return future.result(timeout=FETCH)
        except Exception as error:
            if type(error).__name__ == "KilledWorker":
                raise BrokenExecutor(str(error)) from error
            raise

    def _refuse_gone(self) -> None:
        status = self.client.status
        if status in ("closed", "closing") or (self.strict and status != "running"):
            raise Gone


def run_aside(function: Callable[[], None]) -> None:
    """Run in a thread that delays neither answers of other workers nor the end of the program."""
    with suppress(RuntimeError):  # the program ends
        threading.Thread(target=function, daemon=True).start()


def _outcome(wanted: Callable[[], Any]) -> Any:
    try:
        return wanted()
    except BaseException as error:  # cancelled ones are of this kind
        return error
