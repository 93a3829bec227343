"""One worker as the coordinator sees it, and the orders that it gets next.

It gets orders that nobody has; towards the end, copies of orders that others hold.
"""

from __future__ import annotations

import math
import time
from collections import Counter, deque
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field

from mbsd.dealing.manner import Manner
from mbsd.dealing.report import Key

REST = 5.0
"""Seconds that a worker rests after a failure; twice as many after the next."""


@dataclass(eq=False)
class Group:
    """Orders that a worker has got together."""

    keys: list[Key]
    sent: frozenset[str] = frozenset()
    """Contents that went along."""
    release: Callable[[], object] = bool
    """Calls it back."""


@dataclass(eq=False)
class Hand:
    """A worker."""

    name: str
    manner: Manner
    threads: int = 1
    """Groups that it does at a time."""
    fit: bool = False
    aside: str = ""
    """Reason why it is left out."""
    stalled: bool = False
    each: float = math.inf
    """Seconds an order; infinite as long as it is not known."""
    groups: list[Group] = field(default_factory=list)
    lacks: list[str] = field(default_factory=list)
    """Contents that it asked for."""
    failures: int = 0
    resting: float = 0.0
    began: float = 0.0
    """Time at which it began its first group."""
    made: int = 0
    tasks: int = 0
    """Tasks of the worker at the last look, those of other coordinators included."""

    def is_ready(self) -> bool:
        """True if the worker can get another group."""
        ahead = self.manner.ahead if math.isfinite(self.each) else 1
        able = self.fit and not self.aside and not self.stalled and time.monotonic() >= self.resting
        return able and len(self.groups) < ahead * self.threads

    def size(self, fair: int) -> int:
        """Return the number of orders of its next group, ``fair`` at most."""
        if not math.isfinite(self.each):
            return 1
        return max(1, min(fair, self.manner.largest, int(self.manner.target / max(self.each, 1e-6))))

    def assign(self, group: Group) -> None:
        """Count a group as given to it."""
        if not self.groups:
            self.began = time.monotonic()
        self.groups.append(group)

    def drop(self, group: Group) -> None:
        """Drop a group that it has finished, so it lives."""
        self.stalled = False
        if group in self.groups:
            self.groups.remove(group)
            self.began = time.monotonic()

    def count(self, done: int, seconds: float) -> None:
        """Count orders that it did in so many seconds."""
        if done:
            pace = seconds / done
            # The first order loads and builds, which says too much of the others.
            known = math.isfinite(self.each) and self.made > 1
            self.each = 0.6 * self.each + 0.4 * pace if known else pace
            self.made += done
            self.failures = 0

    def leave_out(self, reason: str) -> None:
        """Give it nothing more."""
        self.fit, self.aside = False, reason

    def fail(self, reason: str) -> bool:
        """Count a failure; return True if it is left out from now on."""
        self.failures += 1
        self.resting = time.monotonic() + REST * 2 ** (self.failures - 1)
        if self.failures >= self.manner.failures:
            self.leave_out(reason)
        return bool(self.aside)

    def is_overdue(self) -> bool:
        """True if the worker has been silent for much longer than its group should take."""
        if not self.groups or self.stalled:
            return False
        silent, manner = time.monotonic() - self.began, self.manner
        if not math.isfinite(self.each):
            return silent > (manner.patience if manner.unknown is None else manner.unknown)
        return silent > max(manner.times * self.each * len(self.groups[0].keys), manner.patience)

    def remaining(self) -> dict[Key, float]:
        """Return seconds until each of its orders should be complete, last one last.

        They are infinite if its pace is unknown.
        """
        passed = time.monotonic() - self.began
        keys = [key for group in self.groups for key in group.keys]
        if not math.isfinite(self.each) or self.stalled:
            if passed < self.manner.grace and not self.stalled:
                return {}
            return dict.fromkeys(keys, math.inf)
        each = self.each / self.threads
        return {key: max((at + 1) * each - passed, 0.0) for at, key in enumerate(keys)}


UNKNOWN = 5.0
"""Seconds an order that are assumed of a worker whose pace is not known."""
WORTH = 1.5
"""An order is copied if it would be done later than in this many times what it takes."""


def unclaimed(
    hand: Hand,
    hands: Collection[Hand],
    pending: deque[Key],
    left: Collection[Key],
    failed_on: Mapping[Key, Collection[str]],
    suspects: Mapping[Key, int],
) -> list[Key]:
    """Return orders taken from ``pending``; those that failed on this worker only if no other answers.

    ``suspects`` have ended workers: they go to workers that have answered before, in groups of this size at most.
    """
    answering = {worker.name for worker in hands if worker.fit and not worker.aside and not worker.stalled}
    proven = {worker.name for worker in hands if worker.made} & answering
    size = hand.size(math.ceil(len(pending) / (2 * hand.threads * max(len(answering), 1))))
    keys: list[Key] = []
    passed: list[Key] = []
    while pending and len(keys) < size:
        key = pending.popleft()
        if key not in left:
            continue
        tried, most = set(failed_on.get(key, ())), suspects.get(key)
        if (hand.name in tried and answering - tried) or (most is not None and proven and hand.name not in proven):
            passed.append(key)
        elif keys and (most is None) != (keys[0] not in suspects):
            passed.append(key)
            break
        else:
            size = size if most is None else min(size, most)
            keys.append(key)
    pending.extendleft(reversed(passed))
    return keys


def stolen(hand: Hand, hands: Collection[Hand], left: Collection[Key]) -> list[Key]:
    """Return the last orders of the worker that will be the last to end, if this one would do them sooner.

    For a worker that has answered before, copies with those that never have do not count: these may never answer.
    """
    counted = [worker for worker in hands if worker.made or not hand.made]
    copies = Counter(key for worker in counted for group in worker.groups for key in group.keys)
    best: list[tuple[float, Key]] = []
    for other in hands:
        if other is hand:
            continue
        remaining = other.remaining().items()
        orders = [(at, key) for key, at in remaining if key in left and copies[key] < hand.manner.copies]
        if orders and (not best or orders[-1][0] > best[-1][0]):
            best = orders
    own = hand.each if math.isfinite(hand.each) else UNKNOWN
    worth = [key for seconds, key in best if seconds > WORTH * own + 0.1]
    return worth[-hand.size(math.ceil(len(worth) / 2)) :] if worth else []
