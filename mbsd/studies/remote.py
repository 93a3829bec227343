"""Chunks of a study on a Dask cluster, each bound to one worker; what a worker that goes or errs had goes to others."""

from __future__ import annotations

import logging
import os
import queue
import threading
import time
import uuid
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from concurrent.futures import BrokenExecutor
from concurrent.futures import Future as Promise
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.studies.cluster.answers import WrongAnswer, answer_of, most_bytes, printable, read
from mbsd.studies.cluster.members import TIMEOUT, Members
from mbsd.studies.identity.content import own_sources
from mbsd.studies.points import Point
from mbsd.studies.work import Done, Order

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "cloudpickle")
"""Those whose version decides what comes out, beside mbsd's own sources and Python."""
FETCH = 60.0
"""Seconds that a finished chunk may be on its way."""
SILENT, TIMES = 60.0, 20.0
"""Seconds that a chunk may take before an idle worker does it as well, and times the longest that points have taken."""
DEATHS = 4
"""Workers that end with a chunk before it counts as what ends them."""
TLS = "CLUSTER_TLS"
"""Environment variable with the folder of certificates: ca.pem, cert.pem, key.pem."""


@contextmanager
def connected(address: str) -> Iterator[Any]:
    """A client of the scheduler at this address, closed afterwards. Raises ModelError if none answers."""
    try:
        from distributed import Client, Security
    except ImportError as error:
        raise ModelError("a study on a cluster needs distributed: install mbsd[cluster]") from error
    folder = os.environ.get(TLS)
    pem = {name: str(Path(folder) / f"{name}.pem") for name in ("ca", "cert", "key")} if folder else {}
    security = Security(
        tls_ca_file=pem["ca"], tls_client_cert=pem["cert"], tls_client_key=pem["key"], require_encryption=True
    ) if pem else None  # fmt: skip
    try:
        client = Client(address, security=security, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ModelError(
            f"study: no scheduler answers at {address} ({error}); start one (docs/cluster.md) or leave client out"
        ) from error
    try:
        yield client
    finally:
        if client.status != "running":  # what Dask logs of that is said already
            logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        with suppress(Exception):
            client.close(timeout=2)


def versions() -> dict[str, str]:
    """What this machine computes with."""
    import platform

    own = {"Python": platform.python_version(), "mbsd": own_sources()[:12]}
    return own | {package: metadata.version(package) for package in PACKAGES}


@dataclass(eq=False)
class _Chunk:
    """Points that are under way."""

    name: str
    points: list[Point]
    promise: Promise[Done] = field(default_factory=Promise)
    futures: dict[str, Any] = field(default_factory=dict)
    """By the workers that have it."""
    sent: float = 0.0
    copies: int = 0
    deaths: int = 0
    """Workers that went while they had it."""


class Cluster:
    """Workers of a Dask cluster that take chunks."""

    target = 2.0
    wave = 2

    def __init__(self, order: Order, client: Any) -> None:
        self.order, self.client = order, client
        self.members = Members(client, versions())
        self._chunks: dict[str, _Chunk] = {}
        self._changing = threading.Lock()
        self._replies: queue.SimpleQueue[tuple[_Chunk, str, Any, str]] = queue.SimpleQueue()
        """Answers that were wrong and why; those that were lost without a reason."""
        self._proven: set[str] = set()
        """Workers that have given right answers."""
        self._longest = 0.0
        """Seconds of the slowest point so far."""
        self.members.awaited()

    @property
    def slots(self) -> int:
        """Threads of all workers that fit."""
        return max(1, sum(self.members.fit.values()))

    def submit(self, points: Sequence[Point]) -> Promise[Done]:
        """Hand out a chunk. The promise raises BrokenExecutor if it ended several workers."""
        chunk = _Chunk(uuid.uuid4().hex, list(points))
        self._chunks[chunk.name] = chunk
        self._send(chunk)
        return chunk.promise

    def look_after(self) -> None:
        """Look for workers that came, leave those out that erred, and send again what workers that went had.

        Raises ModelError where the scheduler has gone or no worker is left.
        """
        while not self._replies.empty():
            chunk, worker, future, reason = self._replies.get()
            if chunk.futures.get(worker) is future:
                del chunk.futures[worker]
            if reason:
                self.members.leave_out(worker, reason)
        self.members.look()
        for chunk in list(self._chunks.values()):
            self._look_after_chunk(chunk)

    def mend(self) -> None:
        """Take back what is under way, as one of these points may end workers again."""
        self.close()

    def close(self) -> None:
        """Take back what is under way."""
        for chunk in list(self._chunks.values()):
            for future in list(chunk.futures.values()):
                _cancel(future)
        self._chunks.clear()

    def _look_after_chunk(self, chunk: _Chunk) -> None:
        for worker in chunk.futures.keys() - self.members.fit.keys():
            _cancel(chunk.futures.pop(worker))
            chunk.deaths += worker not in self.members.out
        if not chunk.futures:
            if chunk.deaths >= DEATHS:
                self._settle(chunk, BrokenExecutor(f"{chunk.deaths} workers ended"))
            else:
                self._send(chunk)
            return
        longest = max(SILENT, TIMES * self._longest * len(chunk.points)) * 2**chunk.copies
        idle = self.members.fit.keys() - set(self._load())
        if idle and time.monotonic() - chunk.sent > longest:
            chunk.copies += 1
            self._send(chunk, but=self.members.fit.keys() - idle)

    def _send(self, chunk: _Chunk, but: Collection[str] = ()) -> None:
        """To the worker that has least to do; of a chunk with which one has ended, to one that has answered before."""
        workers = self.members.awaited(but)
        if chunk.deaths:
            workers = {name: threads for name, threads in workers.items() if name in self._proven} or workers
        load = self._load()
        worker = min(workers, key=lambda name: (load[name] / workers[name], name))
        try:
            future = self.client.submit(
                answer_of, self.order, chunk.points, chunk.name,
                workers=[worker], allow_other_workers=False, pure=False,
            )  # fmt: skip
        except Exception as error:
            if self.client.status != "running":
                raise self.members.gone() from error
            raise
        chunk.futures[worker], chunk.sent = future, time.monotonic()
        future.add_done_callback(
            lambda done: threading.Thread(target=self._fetch, args=(chunk, worker, done), daemon=True).start()
        )

    def _load(self) -> Counter[str]:
        """Chunks that each worker has."""
        return Counter(worker for chunk in list(self._chunks.values()) for worker in list(chunk.futures))

    def _fetch(self, chunk: _Chunk, worker: str, future: Any) -> None:
        """Get an answer and look at it. It may be lost with its worker while it comes: then the chunk is sent again,
        and this one is cancelled.
        """
        if future.cancelled() or chunk.futures.get(worker) is not future:
            return
        try:
            size = self.client.nbytes(keys=[future.key], summary=False).get(future.key) or 0
            if size > most_bytes(len(chunk.points)):
                raise WrongAnswer(f"its answer for {len(chunk.points)} points has {size / 1e6:.1f} MB")
            done = read(future.result(timeout=FETCH), chunk.points, chunk.name)
        except BaseException as error:  # cancelled ones are of this kind
            if type(error).__name__ == "KilledWorker":
                self._settle(chunk, BrokenExecutor(str(error)))
                return
            lost = future.cancelled() or self.client.status != "running"
            said = str(error) if isinstance(error, WrongAnswer) else f"{type(error).__name__}: {error}"
            self._replies.put((chunk, worker, future, "" if lost else printable(said)))
            return
        if chunk.futures.get(worker) is future:
            self._proven.add(worker)
            self._longest = max(self._longest, done.seconds / max(len(chunk.points), 1))
            self._settle(chunk, done)

    def _settle(self, chunk: _Chunk, answer: Done | BrokenExecutor) -> None:
        """Hand the first answer on."""
        with self._changing:
            if self._chunks.pop(chunk.name, None) is None:
                return
        for future in list(chunk.futures.values()):
            if not future.done():
                _cancel(future)
        if isinstance(answer, BrokenExecutor):
            chunk.promise.set_exception(answer)
        else:
            chunk.promise.set_result(answer)


def _cancel(future: Any) -> None:
    with suppress(Exception):  # the scheduler has gone, and the future with it
        future.cancel()
