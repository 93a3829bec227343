"""Which orders a worker gets next: those that nobody has, and towards the end copies of what others would do later."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Collection, Mapping

from shared.cluster.hand import Hand

COPIES = 2
"""Copies of an order at most."""
UNKNOWN = 5.0
"""Seconds an order that are assumed of a worker whose pace is not known."""
WORTH = 1.5
"""An order is copied if it would be done later than in this many times what it takes."""


def unclaimed(
    hand: Hand,
    hands: Collection[Hand],
    pending: deque[str],
    left: Collection[str],
    failed_on: Mapping[str, Collection[str]],
) -> list[str]:
    """Orders taken from ``pending``, those that failed on this worker only if there is no other that answers."""
    answering = {worker.name for worker in hands if worker.fit and not worker.aside and not worker.stalled}
    able = len(answering)
    size = hand.size(math.ceil(len(pending) / (2 * max(able, 1))))
    keys: list[str] = []
    passed: list[str] = []
    while pending and len(keys) < size:
        key = pending.popleft()
        if key not in left:
            continue
        tried = set(failed_on.get(key, ()))
        (passed if hand.name in tried and answering - tried else keys).append(key)
    pending.extendleft(reversed(passed))
    return keys


def stolen(hand: Hand, hands: Collection[Hand], left: Collection[str]) -> list[str]:
    """The last orders of the worker that will be the last to end, if this one would do them sooner.

    For a worker that has answered before, copies with those that never have do not count: these may never answer.
    """
    counted = [worker for worker in hands if worker.made or not hand.made]
    copies = Counter(key for worker in counted for group in worker.groups for key in group.keys)
    best: list[tuple[float, str]] = []
    for other in hands:
        if other is hand:
            continue
        orders = [(at, key) for key, at in other.remaining().items() if key in left and copies[key] < COPIES]
        if orders and (not best or orders[-1][0] > best[-1][0]):
            best = orders
    own = hand.each if math.isfinite(hand.each) else UNKNOWN
    worth = [key for seconds, key in best if seconds > WORTH * own + 0.1]
    return worth[-hand.size(math.ceil(len(worth) / 2)) :] if worth else []
