"""A scheduler and its workers without a process or a socket: what is asked of Dask, answered by functions."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

from mbsd.studies import orders
from mbsd.studies.orders import answer_of

Acts = Callable[..., Any]
"""A worker's answer to the arguments of its task: functions of a study, numbered points, nothing."""


class Held(Future[Any]):
    """A result on a worker."""

    key = "chunk"
    fetched: Callable[[], None] = staticmethod(lambda: None)
    """Called when it is fetched; may raise what happens to it on the way."""

    def result(self, timeout: float | None = None) -> Any:
        value = super().result(timeout)
        self.fetched()
        return value

    def release(self) -> None:
        self.cancel()


class FakeClient:
    """Stands for a ``distributed.Client`` whose workers act as ``workers`` says, by name."""

    status = "running"

    def __init__(self, workers: Mapping[str, Acts], task: Callable[..., Any] = answer_of) -> None:
        self.workers, self.task = dict(workers), task
        self.asked: list[str] = []
        """The worker of each chunk, in order."""
        self.scheduler = SimpleNamespace(
            address="tcp://scheduler:8786", identity=self._identity, processing=lambda **_: {}
        )

    def scheduler_info(self, **_: Any) -> Any:
        return self._identity()

    def sync(self, function: Callable[..., Any], *arguments: Any, callback_timeout: float = 0.0, **named: Any) -> Any:
        return function(*arguments, **named)

    def run(self, function: Callable[[], bytes], workers: list[str], on_error: str) -> dict[str, bytes]:
        if workers[0].startswith("silent"):
            threading.Event().wait(60.0)
        if workers[0].startswith("other"):
            return {workers[0]: json.dumps(orders.identity() | {"numpy": "0.1"}).encode()}
        return {workers[0]: function()}

    def nbytes(self, keys: list[str], summary: bool) -> dict[str, int]:
        return {}

    def submit(self, function: Any, *arguments: Any, workers: list[str], **_: Any) -> Held:
        assert function is self.task
        future = Held()
        self.asked.append(workers[0])
        if acts := self.workers.get(workers[0]):  # it may have gone
            threading.Thread(target=self._act, args=(future, acts, arguments), daemon=True).start()
        return future

    def _act(self, future: Future[Any], acts: Acts, arguments: tuple[Any, ...]) -> None:
        with suppress(InvalidStateError):  # it was called back
            try:
                future.set_result(acts(*arguments))
            except Exception as error:
                future.set_exception(error)

    def _identity(self, **_: Any) -> dict[str, Any]:
        return {"workers": {name: {"nthreads": 1} for name in self.workers}}
