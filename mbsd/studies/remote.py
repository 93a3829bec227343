"""Chunks of a study on a Dask cluster. A worker with other versions is refused by its name."""

from __future__ import annotations

import asyncio
import os
import threading
import time
from collections.abc import Sequence
from concurrent.futures import BrokenExecutor, CancelledError
from concurrent.futures import Future as Promise
from importlib import metadata
from pathlib import Path
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.warn import warn
from mbsd.studies import work
from mbsd.studies.content import own_sources
from mbsd.studies.points import Point
from mbsd.studies.work import Done

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "cloudpickle")
"""Those whose version decides what comes out, beside mbsd's own sources and Python."""
PATIENCE = 60.0
"""Seconds to wait where no worker is there that fits."""
TIMEOUT = 10.0
"""Seconds in which a scheduler must answer."""
TLS = "CLUSTER_TLS"
"""Environment variable with the folder of certificates: ca.pem, cert.pem, key.pem."""


def connected(address: str) -> Any:
    """A client of the scheduler at this address. Raises ModelError if none answers."""
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
        return Client(address, security=security, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ModelError(
            f"study: no scheduler answers at {address} ({error}); start one (docs/cluster.md) or leave client out"
        ) from error


def versions() -> dict[str, str]:
    """What this machine computes with."""
    import platform

    found = {"Python": platform.python_version(), "mbsd": own_sources()[:12]}
    return found | {package: metadata.version(package) for package in PACKAGES}


class Cluster:
    """Workers of a Dask cluster that take chunks."""

    target = 2.0
    wave = 2

    def __init__(self, functions: bytes, client: Any) -> None:
        self.functions, self.client = functions, client
        self.ours = versions()
        self._fit: dict[str, bool] = {}
        self._refused: dict[str, str] = {}
        self._away: dict[Promise[Done], tuple[Any, list[Point], frozenset[str]]] = {}
        self._changing = threading.Lock()
        self._looked = 0.0
        self._look()

    @property
    def slots(self) -> int:
        """Threads of all workers that fit."""
        workers = self._workers()
        return max(1, sum(workers[name]["nthreads"] for name in self._living()))

    def submit(self, points: Sequence[Point]) -> Promise[Done]:
        """Hand out a chunk. The promise raises BrokenExecutor if it ended several workers."""
        promise: Promise[Done] = Promise()
        self._send(promise, list(points))
        return promise

    def look_after(self) -> None:
        """Look for workers that came, and send chunks again whose workers have all gone; once a second."""
        if time.monotonic() - self._looked < 1.0:
            return
        self._look()
        if self.client.status in ("closed", "closing"):
            raise ModelError(
                "study: the scheduler has gone; what is computed is kept, the same call goes on from there"
            )
        living = self._living()
        for promise, (future, points, places) in list(self._away.items()):
            if not places & living:
                with self._changing:
                    if not self._is_away(promise, future):
                        continue
                    del self._away[promise]
                future.cancel()
                self._send(promise, points)

    def mend(self) -> None:
        """The scheduler has forgotten what broke."""

    def close(self) -> None:
        """Take back what is under way."""
        for future, _, _ in self._away.values():
            future.cancel()
        self._away.clear()

    def _send(self, promise: Promise[Done], points: list[Point]) -> None:
        places = self._wait_for_workers()
        future = self.client.submit(
            work.chunk, self.functions, points, workers=sorted(places), allow_other_workers=False, pure=False
        )
        self._away[promise] = (future, points, places)
        future.add_done_callback(lambda done: self._settle(promise, done))

    def _settle(self, promise: Promise[Done], future: Any) -> None:
        """Hand the result on. It may be lost with its worker while it comes: then the chunk is sent again, and this
        one is cancelled.
        """
        if future.cancelled() or not self._is_away(promise, future):
            return
        found: Done | Exception
        try:
            found = future.result()
        except (CancelledError, asyncio.CancelledError):
            return
        except Exception as error:
            killed = type(error).__name__ == "KilledWorker"
            found = BrokenExecutor(str(error)) if killed else error
        with self._changing:
            if not self._is_away(promise, future):
                return
            del self._away[promise]
        if isinstance(found, Exception):
            promise.set_exception(found)
        else:
            promise.set_result(found)

    def _is_away(self, promise: Promise[Done], future: Any) -> bool:
        return promise in self._away and self._away[promise][0] is future

    def _workers(self) -> dict[str, Any]:
        # The scheduler itself: what the client keeps is replaced now and then by a list without workers.
        return self.client.sync(self.client.scheduler.identity, n_workers=-1)["workers"]

    def _living(self) -> frozenset[str]:
        return frozenset(name for name in self._workers() if self._fit.get(name))

    def _look(self) -> None:
        """Ask workers that are new what they compute with."""
        self._looked = time.monotonic()
        new = [name for name in self._workers() if name not in self._fit]
        if not new:
            return

        def asked() -> dict[str, str]:  # of no module, so it travels as it is
            from mbsd.studies.remote import versions

            return versions()

        for name, theirs in self.client.run(asked, workers=new, on_error="return").items():
            differ = (
                [f"{what} {theirs.get(what)}, here {own}" for what, own in self.ours.items() if theirs.get(what) != own]
                if isinstance(theirs, dict)
                else [f"{type(theirs).__name__}: {theirs}"]
            )
            self._fit[name] = not differ
            if differ:
                self._refused[name] = "; ".join(differ)
                warn(f"study: worker {name} is refused: {self._refused[name]}", UserWarning)

    def _wait_for_workers(self) -> frozenset[str]:
        end = time.monotonic() + PATIENCE
        while not (living := self._living()):
            if time.monotonic() > end or self._refused:
                reasons = "".join(f"; {name}: {why}" for name, why in sorted(self._refused.items()))
                raise ModelError(
                    f"study: no worker of {self.client.scheduler.address} can compute it{reasons}; start workers with "
                    "the same lock file (docs/cluster.md)"
                )
            time.sleep(0.5)
            self._look()
        return living
