"""The orders a worker gets next: those that nobody has, towards the end copies of orders that others hold."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Collection, Mapping

from mbsd.dealing.hand import Hand
from mbsd.dealing.report import Key

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
    """Orders taken from ``pending``, those that failed on this worker only if there is no other that answers.

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
    """The last orders of the worker that will be the last to end, if this one would do them sooner.

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
