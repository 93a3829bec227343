"""Deal of orders to workers: each gets what it can do, nothing is lost or kept twice.

Work of a worker that goes is dealt again.
"""

from __future__ import annotations

import math
import queue
import time
import zlib
from collections import Counter, deque
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from functools import partial
from typing import Any, NamedTuple

from mbsd.dealing.hand import Group, Hand, stolen, unclaimed
from mbsd.dealing.identity import Trust, differences, together
from mbsd.dealing.manner import Kind, Manner, Voice
from mbsd.dealing.pools import Gone, Here
from mbsd.dealing.report import AROUND, Key, WrongAnswer, printable, read_identity, read_report

TICK = 0.2
"""Seconds between two looks at the workers while nothing comes."""
SURVEY = 1.0
"""Seconds between two looks at who is there."""
SOON = 2.0
"""Seconds without a worker after which it is said what is waited for."""
WAIT = 60.0
"""Seconds without a worker after which it is given up."""
ATTEMPTS = 3
"""Number of workers after whose failure an order itself may be at fault."""
DEATHS = 4
"""Workers that went while they had an order alone, after which it counts as what ends them; seen to end by it, two."""


class Part(NamedTuple):
    """Results of a worker for a group of orders."""

    results: list[tuple[Any, Any]]
    """Keys and results, each key once."""
    note: Any
    """The worker's note on them together; None if there is none."""
    worker: str


class Deal:
    """One kind of work for all workers of a pool.

    ``kind`` says what a worker does and what its answer has to be, ``orders`` what is to be done by key. Workers that
    are not as ``trust`` demands are refused by name; one whose answer is not what was ordered gets nothing more.
    """

    def __init__(
        self,
        pool: Here,
        kind: Kind,
        orders: Mapping[Any, Any],
        voice: Voice,
        manner: Manner | None = None,
        trust: Trust | None = None,
    ) -> None:
        self.pool, self.kind, self.orders, self.voice = pool, kind, orders, voice
        self.manner, self.trust = manner or Manner(), trust
        self.hands: dict[str, Hand] = {}
        self.late = 0
        """Answers for orders that another worker had done."""
        self._pending: deque[Key] = deque(orders)
        self._left: set[Key] = set(orders)
        self._attempts: Counter[Key] = Counter()
        self._failed_on: dict[Key, set[str]] = {}
        self._suspects: dict[Key, int] = {}
        """Orders with which a worker ended, and how many of them another may get at once."""
        self._deaths: Counter[Key] = Counter()
        self._events: queue.SimpleQueue[tuple[Hand, Group | None, Any]] = queue.SimpleQueue()
        self._surveyed = -math.inf
        self._answered = self._without = time.monotonic()
        self._lost_one = False
        """True if a worker that was fit has gone; whoever keeps it may start it again."""
        self._reported = ""
        """The last report on the waiting."""

    def results(self) -> Iterator[tuple[Any, Any, str]]:
        """Yield key, result and worker of every order as they come, each once. Raises the voice's error."""
        for part in self.parts():
            for key, result in part.results:
                yield key, result, part.worker

    def parts(self) -> Iterator[Part]:
        """Return the same, as workers answer."""
        try:
            while self._left:
                self._survey()
                self._hand_out()
                yield from self._condemned()
                try:
                    hand, group, answer = self._events.get(timeout=TICK)
                except queue.Empty:
                    continue
                if group is None:
                    self._judge(hand, answer)
                elif part := self._settle(hand, group, answer):
                    yield part
                    self._release_needless()
        except Gone as error:
            raise self.voice.error(self.voice.gone.format(where=self.pool.where)) from error
        finally:
            for hand in self.hands.values():
                self._take_back(hand)

    def _survey(self) -> None:
        """Look who came, who went and who stalls."""
        if time.monotonic() - self._surveyed < SURVEY:
            return
        self._surveyed = time.monotonic()
        there, busy = self.pool.there(), self.pool.busy()
        if there is None:
            self._wait_for_scheduler()
            return
        self._answered = time.monotonic()
        for name in there.keys() - self.hands.keys():
            self._greet(Hand(name, self.manner, there[name] if self.manner.threads else 1))
        for name in self.hands.keys() - there.keys():
            self._mourn(self.hands[name], 1)
        for hand in self.hands.values():
            hand.tasks = busy.get(hand.name, 0)
            if hand.is_overdue():
                silent = self.voice.duration(time.monotonic() - hand.began)
                self.voice.warn(f"worker {hand.name} has been silent for {silent}; what it had to do goes to others")
                hand.stalled = True
                self._requeue([key for group in hand.groups for key in group.keys])
        self._refuse_none()

    def _greet(self, hand: Hand) -> None:
        """Greet a new worker, and ask for its identity where that matters."""
        self.hands[hand.name] = hand
        if self.trust is None:
            hand.fit = True
        else:
            self.pool.ask(hand.name, self.trust.request, lambda answer: self._events.put((hand, None, answer)))

    def _mourn(self, hand: Hand, weight: int) -> None:
        """Give what a worker that has gone had to others, in smaller groups if that may have been the reason."""
        del self.hands[hand.name]
        if hand.fit:
            self._lost_one = True
            self.voice.say(f"worker {hand.name} has gone; what it had to do goes to others")
        for group in hand.groups[: hand.threads] if self.kind.deadly else ():
            self._suspects |= dict.fromkeys(group.keys, max(1, len(group.keys) // 2))
            if len(group.keys) == 1:
                self._deaths[group.keys[0]] += weight
        self._take_back(hand)

    def _condemned(self) -> Iterator[Part]:
        """Yield results of orders that end every worker."""
        for key in [key for key, deaths in self._deaths.items() if deaths >= DEATHS and key in self._left]:
            self._left.discard(key)
            if self.kind.deadly:
                yield Part([(key, self.kind.deadly(key))], None, "")

    def _wait_for_scheduler(self) -> None:
        silent = time.monotonic() - self._answered
        if silent > WAIT:
            text, time_ = self.voice.silent, self.voice.duration(silent)
            raise self.voice.error(text.format(where=self.pool.where, time=time_))
        self._report(f"the scheduler does not answer; it is given {WAIT:.0f} s")

    def _refuse_none(self) -> None:
        """Raise an error where no worker has been fit for long, and say soon what is waited for."""
        if any(hand.fit and not hand.stalled for hand in self.hands.values()):
            self._without, self._reported = time.monotonic(), ""
            return
        stalled = any(hand.stalled for hand in self.hands.values())
        if stalled and self.manner.endless:
            return
        asked = [hand.name for hand in self.hands.values() if not hand.fit and not hand.aside]
        none_left = bool(self.hands) and not stalled and not asked and not self._lost_one
        longest = max(WAIT, 6 * self.manner.patience) if stalled else WAIT
        without = time.monotonic() - self._without
        reasons = {hand.name: hand.aside for hand in self.hands.values() if hand.aside}
        reasons |= dict.fromkeys(asked, "it does not answer")
        shown = "".join(f"; {who}: {why}" for who, why in together(reasons))
        if none_left or without >= longest:
            raise self.voice.error(
                self.voice.nobody.format(where=self.pool.where, shown=shown or ", for there is none")
            )
        if without >= SOON:
            what = "all workers are silent" if stalled else self.voice.without.format(where=self.pool.where)
            self._report(f"{what}{shown}; {self.voice.one_comes.format(time=self.voice.duration(longest))}")

    def _report(self, text: str) -> None:
        if text != self._reported:
            self._reported = text
            self.voice.warn(text)

    def _hand_out(self) -> None:
        ready = [hand for hand in self.hands.values() if hand.is_ready()]
        for hand in sorted(ready, key=self._turn):
            hands, keys = self.hands.values(), list[Key]()
            if self._pending and not self._is_first_alone():
                keys = unclaimed(hand, hands, self._pending, self._left, self._failed_on, self._suspects)
            if not keys and not hand.groups and self.manner.copies > 1:
                keys = stolen(hand, hands, self._left)
            if keys:
                self._send(hand, keys)

    def _is_first_alone(self) -> bool:
        """True while other orders wait for the first one, whose process compiles the kernels that they load."""
        nothing_done = len(self._left) == len(self.orders)
        away = any(hand.groups and not hand.stalled for hand in self.hands.values())
        return self.manner.first_alone and nothing_done and away

    def _turn(self, hand: Hand) -> tuple[float, ...]:
        """Return a worker's place in line: those with least to do first, and not the same one for all deals."""
        load = len(hand.groups) / hand.threads
        return load, hand.each, hand.tasks, zlib.crc32(f"{self.kind.salt} {hand.name}".encode())

    def _send(self, hand: Hand, keys: list[Key]) -> None:
        sent = {name: self.kind.needed[name]() for name in hand.lacks}
        hand.lacks = []
        orders = [(key, self.orders[key]) for key in keys]
        group = Group(keys, frozenset(sent))
        hand.assign(group)
        then, most = partial(self._come, hand, group), len(keys) * self.kind.most + AROUND
        group.release = self.pool.submit(hand.name, self.kind.task, (*self.kind.given, orders, sent), most, then)

    def _come(self, hand: Hand, group: Group, answer: Any) -> None:
        self._events.put((hand, group, answer))

    def _settle(self, hand: Hand, group: Group, answer: Any) -> Part | None:
        if group not in hand.groups:
            return None  # the worker was given up
        if _is_death(answer):
            self._surveyed = -math.inf  # it may have a successor
            self._mourn(hand, 2)
            return None
        hand.drop(group)
        group.release()
        try:
            if isinstance(answer, WrongAnswer):
                raise answer
            if isinstance(answer, BaseException):
                self._blame(hand, f"{type(answer).__name__}: {answer}")
                self._requeue(group.keys)
                return None
            report = read_report(answer, group.keys, self.kind.needed, self.kind.most)
            note = self.kind.note(report.note) if report.done else None
            results = [(key, self.kind.read(key, content)) for key, content in report.done if key in self._left]
        except WrongAnswer as wrong:
            self._leave_out(hand, str(wrong))
            self._requeue(group.keys)
            return None
        hand.count(len(report.done), report.seconds)
        hand.lacks = report.lacking
        self.late += len(report.done) - len(results)
        self._left.difference_update(key for key, _ in results)
        if group.sent.intersection(report.lacking):
            self._blame(hand, "it does not keep the inputs that it was sent")
        if report.failed:
            self._judge_failure(hand, *report.failed)
        self._requeue(group.keys)
        return Part(results, note, hand.name)

    def _judge(self, hand: Hand, answer: Any) -> None:
        """Admit a worker whose identity equals ours, else report the difference."""
        if self.hands.get(hand.name) is not hand or self.trust is None:
            return  # it has gone meanwhile
        try:
            differ = differences(read_identity(answer), self.trust.ours)
        except WrongAnswer as wrong:
            differ = str(wrong)
        hand.fit = not differ
        if differ:
            hand.leave_out(differ)
            self.voice.warn(f"worker {hand.name} is refused: {differ}")

    def _judge_failure(self, hand: Hand, key: Key, reason: str) -> None:
        """Raise an error for an order that failed on several workers that do others well, or on all there are."""
        self._attempts[key] += 1
        tried = self._failed_on.setdefault(key, set())
        tried.add(hand.name)
        self._blame(hand, reason)
        proven = [name for name in tried if name in self.hands and self.hands[name].made]
        others = [
            other.name for other in self.hands.values() if other.fit and not other.stalled and other.name not in tried
        ]
        if len(proven) >= ATTEMPTS or (self._attempts[key] >= ATTEMPTS and not others):
            raise self.voice.error(f"{printable(reason)} (on {', '.join(sorted(tried))}); what is finished is kept")

    def _blame(self, hand: Hand, reason: str) -> None:
        aside = hand.fail(printable(reason))
        text = self.voice.left_out if aside else self.voice.failed
        self.voice.warn(text.format(worker=hand.name, reason=printable(reason)))
        if aside:
            self._take_back(hand)

    def _leave_out(self, hand: Hand, reason: str) -> None:
        """Give nothing more to a worker that sent something else than what was ordered."""
        hand.leave_out(f"it sent a wrong answer: {reason}")
        self.voice.warn(self.voice.lied.format(worker=hand.name, reason=reason))
        self._take_back(hand)

    def _take_back(self, hand: Hand) -> None:
        """Give what a worker had to others."""
        groups, hand.groups = hand.groups, []
        for group in groups:
            group.release()
            self._requeue(group.keys)

    def _requeue(self, keys: Sequence[Key]) -> None:
        """Put keys back in front that are neither finished nor with another worker."""
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
                    group.release()


def _is_death(answer: Any) -> bool:
    """True if a process ended instead of answering, or called exit()."""
    return isinstance(answer, BrokenExecutor | SystemExit | KeyboardInterrupt)
