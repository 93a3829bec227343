"""Which workers are there and compute with what this machine does; one that errs is left out with a warning."""

from __future__ import annotations

import json
import queue
import threading
import time
from collections.abc import Collection, Mapping
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.warn import warn
from mbsd.studies.cluster.answers import WrongAnswer, printable

SURVEY = 1.0
"""Seconds between two looks at who is there."""
SOON = 5.0
"""Seconds without a worker after which it is said what is waited for."""
PATIENCE = 60.0
"""Seconds to wait where no worker is there that fits, or the scheduler is silent."""
TIMEOUT = 10.0
"""Seconds in which a scheduler must answer."""
IDENTITY = 100_000
"""Bytes of what a worker tells of itself."""


class Members:
    """The workers of a scheduler. ``ours`` is what this machine computes with."""

    def __init__(self, client: Any, ours: Mapping[str, str]) -> None:
        self.client, self.ours = client, ours
        self.fit: dict[str, int] = {}
        """Threads of each worker that is there and fits."""
        self.out: dict[str, str] = {}
        """Why others are left out."""
        self._there: dict[str, int] = {}
        self._asked: set[str] = set()
        self._fits: set[str] = set()
        self._answers: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()
        self._lost_one = False
        self._looked = self._answered = time.monotonic() - SURVEY

    def look(self) -> None:
        """See who came and who went, once a second. Raises ModelError where the scheduler has gone."""
        while not self._answers.empty():
            self._judge(*self._answers.get())
        if time.monotonic() - self._looked < SURVEY:
            self._count()
            return
        there = self._asked_scheduler()
        if there is None:
            return
        self._looked = self._answered = time.monotonic()
        self._there = there
        for name in there.keys() - self._asked:
            self._asked.add(name)
            threading.Thread(target=self._ask, args=(name,), daemon=True).start()
        self._lost_one = self._lost_one or bool(self.fit.keys() - there.keys() - self.out.keys())
        self._count()

    def leave_out(self, name: str, reason: str) -> None:
        """It errs, so it gets nothing more."""
        if name not in self.out:
            self.out[name] = reason
            warn(f"study: worker {name} is left out: {reason}; others do its work", UserWarning)
        self._count()

    def awaited(self, but: Collection[str] = ()) -> dict[str, int]:
        """Those that fit and their threads, waited for where there are none.

        Raises ModelError where none is left, none comes in time, or the scheduler has gone.
        """
        began, warned = time.monotonic(), False
        while True:
            self.look()
            able = {name: threads for name, threads in self.fit.items() if name not in but}
            if able:
                return able
            waited = time.monotonic() - began
            silent = self._there.keys() - self._fits - self.out.keys()
            reasons = self.out | dict.fromkeys(silent, "it does not answer")
            shown = "".join(f"; {name}: {why}" for name, why in sorted(reasons.items()) if name in self._there)
            where = self.client.scheduler.address
            if waited > PATIENCE or (self._there and not silent and not self._lost_one):
                raise ModelError(
                    f"study: no worker of {where} can compute it{shown}; start workers with the same lock file "
                    "(docs/cluster.md). What is computed is kept"
                )
            if waited > SOON and not warned:
                warned = True
                warn(
                    f"study: {where} has no worker that can compute it{shown}; one is given {PATIENCE:.0f} s to come",
                    UserWarning,
                )
            time.sleep(0.1)

    def gone(self) -> ModelError:
        """The scheduler has."""
        return ModelError(
            f"study: the scheduler {self.client.scheduler.address} has gone; start it again (make scheduler). What is "
            "computed is kept where there is a folder, the same call goes on from there"
        )

    def _count(self) -> None:
        self.fit = {
            name: threads for name, threads in self._there.items() if name in self._fits and name not in self.out
        }

    def _asked_scheduler(self) -> dict[str, int] | None:
        """Threads of all workers by name; None where the scheduler has not answered in time."""
        if self.client.status != "running":
            raise self.gone()
        try:
            # The scheduler itself: what the client keeps is replaced now and then by a list without workers.
            identity = self.client.sync(self.client.scheduler.identity, n_workers=-1, callback_timeout=TIMEOUT)
        except TimeoutError as error:
            if self.client.status != "running" or time.monotonic() - self._answered > PATIENCE:
                raise self.gone() from error
            return None
        except (OSError, RuntimeError) as error:
            raise self.gone() from error
        return {
            name: max(1, int(worker["nthreads"]))
            for name, worker in identity["workers"].items()
            if len(name) < 200 and name.isascii() and name.isprintable()
        }

    def _ask(self, name: str) -> None:
        def asked() -> bytes:  # of no module, so it travels as it is, and a worker with other sources understands it
            import importlib
            import json

            return json.dumps(importlib.import_module("mbsd.studies.remote").versions()).encode()

        try:
            answer = self.client.run(asked, workers=[name], on_error="return").get(name)
        except Exception as error:
            answer = error
        self._answers.put((name, answer))

    def _judge(self, name: str, answer: Any) -> None:
        try:
            theirs = _versions(answer)
        except WrongAnswer as wrong:
            differ = [str(wrong)]
        else:
            differ = [
                f"{what} {theirs.get(what)}, here {own}" for what, own in self.ours.items() if theirs.get(what) != own
            ]
        if not differ:
            self._fits.add(name)
        else:
            self.out[name] = "; ".join(differ)
            warn(f"study: worker {name} is refused: {self.out[name]}", UserWarning)


def _versions(answer: Any) -> dict[str, str]:
    if not isinstance(answer, bytes):
        raise WrongAnswer(printable(f"{type(answer).__name__}: {answer}"))
    try:
        versions = json.loads(answer[:IDENTITY])
    except (ValueError, RecursionError) as error:
        raise WrongAnswer("what it tells of itself cannot be read") from error
    if not isinstance(versions, dict):
        raise WrongAnswer("what it tells of itself is no list of versions")
    return {printable(name, 80): printable(str(value), 80) for name, value in versions.items()}
