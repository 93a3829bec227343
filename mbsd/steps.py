"""The steps of a driven motion: the times asked for, and those that the program puts between them.

Output times are the user's and may be few. A driver goes at most one stride in a step, so that no motion between two
outputs passes unseen, and a step that the solver doubts is divided further.
"""

from __future__ import annotations

import numpy as np

from mbsd.errors import ModelError
from mbsd.packing import Packed

TURN = 0.18
"""Stride (rad) of a driven angle: 35 steps a turn."""
LENGTH = 0.1
"""Stride of a driven length, in sizes of the mechanism."""
SHORTEST = 1e-7
"""A step divided to this part of its length that is still refused is not cured by dividing it."""
MOST = 20_000_000
"""Numbers of a motion, steps times coordinates, beyond which a sweep is refused."""
AT_ONCE = 64
"""Parts into which a step is divided before its laws are looked at again."""


def strides(packed: Packed) -> np.ndarray:
    """(motions + 1,) how far each law may go in one step (rad or m); entry 0 is the law that is always zero."""
    drivers = packed.joints[len(packed.joints) - len(packed.motions) :]
    return np.array([np.inf, *(TURN if driver.kind.angular else LENGTH * packed.size for driver in drivers)])


class Steps:
    """Times of a motion (T,), the laws' values there (T, motions + 1, 3), and which of them were asked for."""

    def __init__(self, packed: Packed, times: np.ndarray) -> None:
        self.packed, self.stride = packed, strides(packed)
        self.times = np.ascontiguousarray(times, float)
        self.wanted = np.ones(len(self.times), bool)
        self.out_of_reach: float | None = None
        """Time (s) at which a group was found that cannot close."""
        self._shortest = np.full(len(self.times), SHORTEST)
        self._shortest[1:] *= np.diff(self.times)
        knots = [law.knots(float(times[0]), float(times[-1])) for law in packed.motions]
        self.drives = packed.drives(self.times)
        if any(len(times_of) for times_of in knots):
            self._put_knots(np.unique(np.concatenate(knots)))

    @property
    def inserted(self) -> int:
        """How many times were put between those asked for."""
        return int(len(self.wanted) - np.count_nonzero(self.wanted))

    def divide(self, index: int, part: float = 0.5) -> bool:
        """Put a time into the step that ends at ``index``, at the given part of it; False if it is too short for that."""
        start, end = self.times[index - 1], self.times[index]
        middle = start + part * (end - start)
        if not (end - start > self._shortest[index] and start < middle < end):
            return False
        self._put(np.array([index]), np.array([middle]))
        return True

    def follow_laws(self) -> bool:
        """Divide all steps in which a law goes further than its stride; returns whether there were any."""
        count = len(self.times)
        for _ in range(64):
            h = np.diff(self.times)[:, None]
            value, rate = self.drives[:, 1:, 0], np.abs(self.drives[:, 1:, 1])
            way = np.maximum(np.abs(np.diff(value, axis=0)), h * np.maximum(rate[1:], rate[:-1]))
            need = np.ceil((way / self.stride[1:]).max(axis=1, initial=0.0) * (1.0 - 1e-9))
            need[h[:, 0] <= self._shortest[1:]] = 1
            parts = np.clip(need, 1, AT_ONCE).astype(np.int64)
            if (parts == 1).all():
                break
            self._refuse_endless(float(need.sum()), need)
            at = np.repeat(np.arange(1, len(self.times)), parts - 1)
            first = np.cumsum(parts - 1) - (parts - 1)
            number = np.arange(len(at)) - np.repeat(first, parts - 1) + 1
            self._put(at, self.times[at - 1] + h[at - 1, 0] * number / parts[at - 1])
        return len(self.times) > count

    def _put_knots(self, knots: np.ndarray) -> None:
        """Take those of a step that holds several: a law may go and come back in it."""
        knots = knots[~np.isin(knots, self.times) & (knots > self.times[0]) & (knots < self.times[-1])]
        at = np.searchsorted(self.times, knots)
        several = np.bincount(at, minlength=1)[at] > 1
        self._put(at[several], knots[several])

    def _put(self, at: np.ndarray, times: np.ndarray) -> None:
        self.drives = np.insert(self.drives, at, self.packed.drives(times), axis=0)
        self.wanted = np.insert(self.wanted, at, False)
        self._shortest = np.insert(self._shortest, at, self._shortest[at])
        self.times = np.insert(self.times, at, times)

    def _refuse_endless(self, steps: float, need: np.ndarray) -> None:
        if steps * 3 * len(self.packed.body_names) <= MOST:
            return
        k = int(np.argmax(need))
        way = np.abs(self.drives[k + 1, 1:, 0] - self.drives[k, 1:, 0]) / self.stride[1:]
        driver = self.packed.joints[len(self.packed.joints) - len(self.packed.motions) + int(np.argmax(way))]
        raise ModelError(
            f"{self.packed.name}: following the drivers from t = {self.times[0]:.6g} s to {self.times[-1]:.6g} s takes "
            f"{steps:.2g} steps, most of them for driver '{driver.name}' near t = {self.times[k]:.6g} s. Sweep a "
            "shorter time, or drive it more slowly."
        )
