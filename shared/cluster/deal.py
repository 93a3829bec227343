"""Deals orders out to workers: to each what it can do, nothing lost with one that goes, nothing kept twice."""

from __future__ import annotations

import math
import queue
import threading
import time
import zlib
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from shared.cluster.address import size_of, tasks_of, workers_of
from shared.cluster.answers.report import AROUND, read_identity, read_report, refuse_large
from shared.cluster.answers.wrong_answer import WrongAnswer, printable
from shared.cluster.hand import Group, Hand
from shared.cluster.hands import Work, perform
from shared.cluster.identity import PACKAGES, asker, differences, identity, together
from shared.cluster.shares import stolen, unclaimed
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run

if TYPE_CHECKING:
    from distributed import Client

TICK = 0.2
"""Seconds between two looks at the workers while nothing comes."""
SURVEY = 1.0
"""Seconds between two looks at who is there."""
SOON = 2.0
"""Seconds without a worker after which it is said what is waited for."""
WAIT = 60.0
"""Seconds without a worker after which it is given up."""
FETCH = 60.0
"""Seconds that a finished result may be on its way."""
ATTEMPTS = 3
"""On workers, after which an order itself may be at fault."""


class Deal:
    """One kind of work for all workers of a cluster.

    ``work`` says what a worker does and what its answer has to be, ``common`` is the name of the content that all
    orders share, ``needed`` all contents by name as functions that give their bytes, ``orders`` what is to be done by
    key. Workers whose sources of ``rooms`` differ are refused by name; one whose answer is not what was ordered gets
    nothing more. ``patience`` (s) is a silence that is never too long; for ``grace`` (s) no worker whose pace is
    unknown is helped by others that have nothing to do.
    """

    def __init__(
        self,
        client: Client,
        work: Work,
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
        self._events: queue.SimpleQueue[tuple[Hand, Group | None, Any]] = queue.SimpleQueue()
        self._surveyed = -math.inf
        self._answered = self._without = time.monotonic()
        self._lost_one = False
        """Whether a worker that was fit has gone; whoever keeps it may start it again."""
        self._reported = ""
        """What was said of the waiting."""

    def results(self) -> Iterator[tuple[str, Any, str]]:
        """Key, result and worker of every order as they come, each once; raises UserError with the reason."""
        try:
            while self._left:
                self._survey()
                self._hand_out()
                try:
                    hand, group, answer = self._events.get(timeout=TICK)
                except queue.Empty:
                    continue
                if group is None:
                    self._judge(hand, answer)
                else:
                    yield from self._settle(hand, group, answer)
        finally:
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
            self._wait_for_scheduler()
            return
        self._answered = time.monotonic()
        for name in there.keys() - self.hands.keys():
            self.hands[name] = Hand(name, self.patience, self.grace)
            _beside(self._ask, self.hands[name])
        for hand in [self.hands.pop(name) for name in self.hands.keys() - there.keys()]:
            if hand.fit:
                self._lost_one = True
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

    def _wait_for_scheduler(self) -> None:
        silent = time.monotonic() - self._answered
        if silent > WAIT:
            raise UserError(f"the scheduler has been silent for {duration(silent)}; nothing was lost, start it again "
                            f"({to_run('scheduler')}), and then the same command")  # fmt: skip
        self._report(f"the scheduler does not answer; it is given {WAIT:.0f} s")

    def _refuse_none(self) -> None:
        """Raise UserError where no worker has been fit for long, and say soon what is waited for."""
        if any(hand.fit and not hand.stalled for hand in self.hands.values()):
            self._without, self._reported = time.monotonic(), ""
            return
        stalled = any(hand.stalled for hand in self.hands.values())
        asked = [hand.name for hand in self.hands.values() if not hand.fit and not hand.aside]
        none_left = bool(self.hands) and not stalled and not asked and not self._lost_one
        longest = max(WAIT, 6 * self.patience) if stalled else WAIT
        without = time.monotonic() - self._without
        reasons = {hand.name: hand.aside for hand in self.hands.values() if hand.aside}
        reasons |= dict.fromkeys(asked, "it does not answer")
        shown = "".join(f"; {who}: {why}" for who, why in together(reasons))
        if none_left or without >= longest:
            raise UserError(
                f"no worker of the cluster can do this{shown or ', for there is none'}; start workers "
                f"with the same lock file and sources ({to_run('worker')}), or leave CLUSTER out"
            )
        if without >= SOON:
            what = "all workers are silent" if stalled else "there is no worker that can do this"
            self._report(f"{what}{shown}; one is given {duration(longest)} to come ({to_run('worker')})")

    def _report(self, text: str) -> None:
        if text != self._reported:
            self._reported = text
            warn("cluster", text)

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
        group = Group(keys, frozenset(sent))
        group.future = self.client.submit(
            perform, self.work.do, self.common, list(self.needed), orders, sent,
            workers=[hand.name], allow_other_workers=False, pure=False, retries=0,
        )  # fmt: skip
        hand.take(group)
        group.future.add_done_callback(lambda _: _beside(self._fetch, hand, group))

    def _ask(self, hand: Hand) -> None:
        """Have a worker say what it works with, even while it does something for others."""
        try:
            ask = asker(self.rooms, self.packages)
            answers: Any = self.client.run(ask, workers=[hand.name], on_error="return")
            answer = answers.get(hand.name)
        except Exception as error:
            answer = error
        self._events.put((hand, None, answer))

    def _fetch(self, hand: Hand, group: Group) -> None:
        try:
            refuse_large(size_of(self.client, group.future.key), len(group.keys) * self.work.most + AROUND)
            answer = group.future.result(timeout=FETCH)
        except BaseException as error:  # cancelled ones are of this kind
            answer = error
        self._events.put((hand, group, answer))

    def _settle(self, hand: Hand, group: Group, answer: Any) -> Iterator[tuple[str, Any, str]]:
        if group not in hand.groups:
            return  # the worker was given up
        hand.drop(group)
        group.future.release()
        try:
            if isinstance(answer, WrongAnswer):
                raise answer
            if isinstance(answer, BaseException):
                self._blame(hand, f"{type(answer).__name__}: {answer}")
                self._requeue(group.keys)
                return
            report = read_report(answer, group.keys, self.needed, self.work.most)
            results = [(key, self.work.read(key, content)) for key, content in report.done if key in self._left]
        except WrongAnswer as wrong:
            self._leave_out(hand, str(wrong))
            self._requeue(group.keys)
            return
        hand.count(len(report.done), report.seconds)
        hand.lacks = report.lacking
        self.late += len(report.done) - len(results)
        for key, result in results:
            self._left.discard(key)
            yield key, result, hand.name
        if group.sent.intersection(report.lacking):
            self._blame(hand, "it does not keep the inputs that it was sent")
        if report.failed:
            self._judge_failure(hand, *report.failed)
        self._requeue(group.keys)
        self._release_needless()

    def _judge(self, hand: Hand, answer: Any) -> None:
        """Whether a worker is as we are."""
        if self.hands.get(hand.name) is not hand:
            return  # it has gone meanwhile
        try:
            if isinstance(answer, BaseException):
                raise WrongAnswer(printable(f"{type(answer).__name__}: {answer}"))
            differ = differences(read_identity(answer), self.ours)
        except WrongAnswer as wrong:
            differ = str(wrong)
        hand.fit = not differ
        if differ:
            hand.leave_out(differ)
            warn("cluster", f"worker {hand.name} is refused: {differ}")

    def _judge_failure(self, hand: Hand, key: str, reason: str) -> None:
        """An order is at fault where it failed on several workers that do others well, or on all that there are."""
        self._attempts[key] += 1
        tried = self._failed_on.setdefault(key, set())
        tried.add(hand.name)
        self._blame(hand, reason)
        proven = [name for name in tried if name in self.hands and self.hands[name].made]
        others = [
            other.name for other in self.hands.values() if other.fit and not other.stalled and other.name not in tried
        ]
        if len(proven) >= ATTEMPTS or (self._attempts[key] >= ATTEMPTS and not others):
            raise UserError(f"{printable(reason)} (on {', '.join(sorted(tried))}); what is finished is kept")

    def _blame(self, hand: Hand, reason: str) -> None:
        aside = hand.fail(printable(reason))
        warn("cluster", f"worker {hand.name}: {printable(reason)}" + ("; it is left out" if aside else ""))
        if aside:
            self._take_back(hand)

    def _leave_out(self, hand: Hand, reason: str) -> None:
        """A worker that sends something else than what was ordered may do so again, so it gets nothing more."""
        hand.leave_out(f"it sent a wrong answer: {reason}")
        warn("cluster", f"worker {hand.name} sent a wrong answer: {reason}; it is left out, others do its work")
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


def _beside(function: Callable[..., None], *arguments: Any) -> None:
    """In a thread of its own that holds up neither the answers of other workers nor the end of the program."""
    with suppress(RuntimeError):  # the program ends
        threading.Thread(target=function, args=arguments, daemon=True).start()
