"""Deals orders out to workers: to each what it can do, nothing lost with one that goes, nothing kept twice."""

from __future__ import annotations

import math
import queue
import time
import zlib
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from shared.cluster.address import tasks_of, workers_of
from shared.cluster.hand import Group, Hand
from shared.cluster.hands import Report, perform
from shared.cluster.identity import PACKAGES, asker, differences, identity, together
from shared.cluster.shares import stolen, unclaimed
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from distributed import Client

TICK = 0.2
"""Seconds between two looks at the workers while nothing comes."""
SURVEY = 1.0
"""Seconds between two looks at who is there."""
WAIT = 60.0
"""Seconds without a worker after which it is given up."""
FETCH = 60.0
"""Seconds that a finished result may be on its way."""
ATTEMPTS = 3
"""On workers, after which an order itself is at fault."""


class Deal:
    """One kind of work for all workers of a cluster.

    ``work(files, common, order)`` is a function of the project, ``common`` the name of the content that all orders
    share, ``needed`` all contents by name as functions that give their bytes, ``orders`` what is to be done by key.
    Workers whose sources of ``rooms`` differ are refused by name. ``patience`` (s) is a silence that is never too long;
    for ``grace`` (s) no worker whose pace is unknown is helped by others that have nothing to do.
    """

    def __init__(
        self,
        client: Client,
        work: Callable[..., Any],
        common: str,
        needed: Mapping[str, Callable[[], bytes]],
        orders: Mapping[str, Any],
        rooms: Sequence[str],
        patience: float = 300.0,
        packages: Sequence[str] = PACKAGES,
        grace: float = 0.0,
    ) -> None:
        self.client, self.work, self.common, self.needed, self.orders = client, work, common, needed, orders
        self.rooms, self.packages = tuple(rooms), tuple(packages)
        self.patience, self.grace = patience, grace
        self.ours = identity(self.rooms, self.packages)
        self.hands: dict[str, Hand] = {}
        self.late = 0
        """Answers for orders that another worker had done."""
        self._pending = deque(orders)
        self._left = set(orders)
        self._attempts: Counter[str] = Counter()
        self._failed_on: dict[str, set[str]] = {}
        self._events: queue.SimpleQueue[tuple[Hand, Group, Any]] = queue.SimpleQueue()
        self._surveyed = -math.inf
        self._without = time.monotonic()
        self._refused: dict[str, str] = {}

    def results(self) -> Iterator[tuple[str, Any, str]]:
        """Key, result and worker of every order as they come, each once; raises UserError with the reason."""
        self._fetchers = ThreadPoolExecutor(4)
        try:
            while self._left:
                self._survey()
                self._hand_out()
                try:
                    hand, group, answer = self._events.get(timeout=TICK)
                except queue.Empty:
                    continue
                yield from self._settle(hand, group, answer)
        finally:
            self._fetchers.shutdown(wait=False, cancel_futures=True)
            for hand in self.hands.values():
                self._take_back(hand)

    def _survey(self) -> None:
        """Who came, who went, who stalls."""
        if time.monotonic() - self._surveyed < SURVEY:
            return
        self._surveyed = time.monotonic()
        if self.client.status in ("closed", "closing"):
            raise UserError("the scheduler has gone; nothing was lost, the same command goes on")
        there, busy = workers_of(self.client), tasks_of(self.client)
        if there is None:
            return
        for name in there.keys() - self.hands.keys():
            self.hands[name] = Hand(name, self.patience, self.grace)
            self._submit(self.hands[name], Group([]), asker(self.rooms, self.packages))
        for hand in [self.hands.pop(name) for name in self.hands.keys() - there.keys()]:
            if hand.fit:
                say("cluster", f"worker {hand.name} has gone; what it had to do goes to others")
            self._take_back(hand)
        for hand in self.hands.values():
            hand.tasks = busy.get(hand.name, 0)
            if hand.is_overdue():
                silent = duration(time.monotonic() - hand.began)
                warn("cluster", f"worker {hand.name} has been silent for {silent}; what it had to do goes to others")
                hand.stalled = True
                self._requeue([key for group in hand.groups for key in group.keys])
        self._refuse_none()

    def _refuse_none(self) -> None:
        """Raise UserError where no worker has been fit for long."""
        if any(hand.fit and not hand.aside and not hand.stalled for hand in self.hands.values()):
            self._without = time.monotonic()
            return
        some = any(hand.stalled for hand in self.hands.values())
        if time.monotonic() - self._without < (max(WAIT, 6 * self.patience) if some else WAIT):
            asking = any(hand.groups for hand in self.hands.values())
            if asking or not self.hands or some or not self._refused.keys() | self._aside().keys() >= self.hands.keys():
                return
        reasons = "".join(f"; {who}: {why}" for who, why in together(self._refused | self._aside()))
        raise UserError(
            f"no worker of the cluster can do this{reasons or ', for there is none'}; start workers "
            "with the same lock file and sources (make worker), or leave CLUSTER out"
        )

    def _aside(self) -> dict[str, str]:
        return {hand.name: hand.aside for hand in self.hands.values() if hand.aside}

    def _hand_out(self) -> None:
        ready = [hand for hand in self.hands.values() if hand.is_ready()]
        for hand in sorted(ready, key=self._turn):
            hands, keys = self.hands.values(), list[str]()
            if self._pending:
                keys = unclaimed(hand, hands, self._pending, self._left, self._failed_on)
            if not keys and not hand.groups:
                keys = stolen(hand, hands, self._left)
            if keys:
                self._send(hand, keys)

    def _turn(self, hand: Hand) -> tuple[float, ...]:
        """Who comes first: of equal workers one that has nothing to do for others, and not all deals the same one."""
        return len(hand.groups), hand.each, hand.tasks, zlib.crc32(f"{self.common} {hand.name}".encode())

    def _send(self, hand: Hand, keys: list[str]) -> None:
        sent = {name: self.needed[name]() for name in hand.lacks}
        hand.lacks = []
        orders = [(key, self.orders[key]) for key in keys]
        self._submit(hand, Group(keys), perform, self.work, self.common, list(self.needed), orders, sent)

    def _submit(self, hand: Hand, group: Group, function: Callable[..., Any], *arguments: Any) -> None:
        group.future = self.client.submit(
            function, *arguments, workers=[hand.name], allow_other_workers=False, pure=False, retries=0
        )
        hand.take(group)
        group.future.add_done_callback(lambda _: self._fetch_later(hand, group))

    def _fetch_later(self, hand: Hand, group: Group) -> None:
        with suppress(RuntimeError):  # all is done, and this one was not needed
            self._fetchers.submit(self._fetch, hand, group)

    def _fetch(self, hand: Hand, group: Group) -> None:
        try:
            answer = group.future.result(timeout=FETCH)
        except BaseException as error:  # cancelled ones are of this kind
            answer = error
        self._events.put((hand, group, answer))

    def _settle(self, hand: Hand, group: Group, answer: Any) -> Iterator[tuple[str, Any, str]]:
        if group not in hand.groups:
            return  # the worker was given up
        hand.drop(group)
        group.future.release()
        if not group.keys:
            self._judge(hand, answer)
            return
        if not isinstance(answer, Report):
            self._blame(hand, f"{type(answer).__name__}: {answer}")
            self._requeue(group.keys)
            return
        hand.count(len(answer.done), answer.seconds)
        hand.lacks = answer.lacking
        for key, result in answer.done:
            if key in self._left:
                self._left.discard(key)
                yield key, result, hand.name
            else:
                self.late += 1
        if answer.failed:
            self._judge_failure(hand, *answer.failed)
        self._requeue(group.keys)
        self._release_needless()

    def _judge(self, hand: Hand, answer: Any) -> None:
        """Whether a worker is as we are."""
        differ = differences(answer, self.ours) if isinstance(answer, dict) else f"{type(answer).__name__}: {answer}"
        if differ:
            self._refused[hand.name] = hand.aside = differ
            warn("cluster", f"worker {hand.name} is refused: {differ}")
            return
        hand.fit = True

    def _judge_failure(self, hand: Hand, key: str, reason: str) -> None:
        self._attempts[key] += 1
        self._failed_on.setdefault(key, set()).add(hand.name)
        if self._attempts[key] >= ATTEMPTS:
            raise UserError(f"{reason} (on {', '.join(sorted(self._failed_on[key]))}); what is finished is kept")
        self._blame(hand, reason)

    def _blame(self, hand: Hand, reason: str) -> None:
        aside = hand.fail(reason)
        warn("cluster", f"worker {hand.name}: {reason}" + ("; it is left out" if aside else ""))
        if aside:
            self._take_back(hand)

    def _take_back(self, hand: Hand) -> None:
        """Give what a worker had to others."""
        groups, hand.groups = hand.groups, []
        for group in groups:
            group.future.release()
            self._requeue(group.keys)

    def _requeue(self, keys: Sequence[str]) -> None:
        """Those that are neither done nor with another worker, in front."""
        if not self._left.intersection(keys):
            return
        away = {key for hand in self.hands.values() if not hand.stalled for group in hand.groups for key in group.keys}
        away.update(self._pending)
        self._pending.extendleft(reversed([key for key in keys if key in self._left and key not in away]))

    def _release_needless(self) -> None:
        """Call back groups that others have done wholly."""
        for hand in self.hands.values():
            for group in hand.groups[1:]:
                if group.keys and not self._left.intersection(group.keys):
                    hand.groups.remove(group)
                    group.future.release()
