"""The steps of a driven motion: the times asked for, and those that the program puts between them.

Output times are the user's and may be few. A driver goes at most one stride in a step, so that no motion between two
outputs passes unseen, and a step that the solver doubts is divided further.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError

TURN = 0.18
"""Stride (rad) of a driven angle: 35 steps a turn."""
LENGTH = 0.1
"""Stride of a driven length, in sizes of the mechanism."""
SHORTEST = 1e-7
"""A step divided to this part of its length that is still refused is not cured by dividing it."""
MOST = 20_000_000
"""Numbers of a motion, steps times coordinates, beyond which a sweep is refused."""
MOST_DIVISIONS = 20_000
"""Steps of a sweep that may be doubted one by one; as many as outputs may be, where these are more."""
ASTRAY = 0.01
"""Part of a stride by which a law may be off the cubic through both ends of a step."""
AT_ONCE = 64
"""Parts into which a step is divided before its laws are looked at again."""


def strides(packed: Packed) -> np.ndarray:
    """Return (motions + 1,) largest steps of each law (rad or m); entry 0 is the zero law."""
    return np.array([np.inf, *(TURN if driver.kind.angular else LENGTH * packed.size for driver in packed.drivers)])


def divisions(packed: Packed, times: np.ndarray) -> int:
    """Return equal parts of the even steps of ``times`` (T,) in which no law exceeds its stride."""
    first, last, steps = float(times[0]), float(times[-1]), len(times) - 1
    stride = strides(packed)
    crowd = np.diff(np.flatnonzero(Steps(packed, times).wanted))  # outputs and knots within each step
    parts = 2 * int(crowd.max(initial=1)) - 1
    for _ in range(8):
        refuse_endless(packed, np.linspace(first, last, 2), parts * steps)
        inner = np.linspace(first, last, parts * steps + 1)
        need = _strides_taken(inner, packed.drives(inner), stride).max(initial=0.0)
        if need <= 1.0 + 1e-9:
            break
        parts = math.ceil(parts * need)
    return parts


def _strides_taken(times: np.ndarray, drives: np.ndarray, stride: np.ndarray) -> np.ndarray:
    """Return (T - 1,) strides that the furthest law goes in each step, by its values or by its rates."""
    value, rate = drives[:, 1:, 0], np.abs(drives[:, 1:, 1])
    by_rate = np.diff(times)[:, None] * np.maximum(rate[1:], rate[:-1])
    return (np.maximum(np.abs(np.diff(value, axis=0)), by_rate) / stride[1:]).max(axis=1, initial=0.0)


def refuse_endless(packed: Packed, times: np.ndarray, steps: float) -> None:
    """Raise ModelError if following the drivers over ``times`` (T,) takes more steps than fit."""
    if steps * 3 * len(packed.body_names) <= MOST:
        return
    drives = packed.drives(times)
    way = np.abs(np.diff(drives[:, 1:, 0], axis=0)).sum(axis=0) / strides(packed)[1:]
    driver = packed.drivers[int(np.argmax(way))]
    raise ModelError(
        f"{packed.name}: following the drivers from t = {times[0]:.6g} s to {times[-1]:.6g} s takes {steps:.2g} steps, "
        f"most of them for driver '{driver.name}'. Sweep a shorter time, or drive it more slowly."
    )


class Steps:
    """Times of a motion (T,), the laws' values there (T, motions + 1, 3), and the requested ones."""

    def __init__(self, packed: Packed, times: np.ndarray) -> None:
        self.packed, self.stride = packed, strides(packed)
        self.times = np.ascontiguousarray(times, float)
        self.wanted = np.ones(len(self.times), bool)
        self.out_of_reach: float | None = None
        """Time (s) at which a group was found that cannot close."""
        self._divisions_left = max(MOST_DIVISIONS, len(self.times))
        self._shortest = np.full(len(self.times), SHORTEST)
        self._shortest[1:] *= self.times[1:] - self.times[:-1]
        knots = [law.knots(float(times[0]), float(times[-1])) for law in packed.motions]
        self.drives = packed.drives(self.times)
        if any(len(times_of) for times_of in knots):
            self._insert_knots(np.unique(np.concatenate(knots)))

    @property
    def inserted(self) -> int:
        """How many times were put between those asked for."""
        return int(len(self.wanted) - np.count_nonzero(self.wanted))

    def divide(self, index: int, part: float = 0.5) -> bool:
        """Put a time into the step that ends at ``index``, at the given part of it; False if it is too short.

        Raises ModelError where so many were divided that no end is in sight.
        """
        start, end = self.times[index - 1], self.times[index]
        middle = start + part * (end - start)
        if not (end - start > self._shortest[index] and start < middle < end):
            return False
        if not self._divisions_left:
            raise ModelError(self._without_end(index))
        self._divisions_left -= 1
        self._insert(np.array([index]), np.array([middle]))
        return True

    def leave_out(self, start: float, end: float, more: np.ndarray) -> np.ndarray:
        """Remove the steps strictly between ``start`` and ``end`` (s), and add ``more`` (n,) before the last.

        Returns the times taken out that were asked for.
        """
        last = self.times[-1]
        inside = (self.times > start) & (self.times < end)
        left_out = self.times[inside & self.wanted]
        keep = ~inside
        self.times, self.drives = self.times[keep], self.drives[keep]
        self.wanted, self._shortest = self.wanted[keep], self._shortest[keep]
        more = more[(more < last) & ~np.isin(more, self.times)]
        if len(more) and len(self.times):
            self._insert(np.searchsorted(self.times, more), more)
        return left_out

    def restore(self, times: np.ndarray) -> np.ndarray:
        """Put ``times`` (n,) that were asked for and left out back; returns before which steps they stand."""
        at = np.searchsorted(self.times, times)
        self.drives = np.insert(self.drives, at, self.packed.drives(times), axis=0)
        self.wanted = np.insert(self.wanted, at, True)
        self._shortest = np.insert(self._shortest, at, 0.0)
        self.times = np.insert(self.times, at, times)
        return at

    def _without_end(self, index: int) -> str:
        """Return the error text of a sweep whose steps are divided without end; the last ends at ``index``."""
        packed, start, end = self.packed, self.times[index - 1], self.times[index]
        way = np.abs(np.diff(self.drives[index - 1 : index + 1, 1:, 0], axis=0))[0] / self.stride[1:]
        k = int(np.argmax(way))
        (value, _, _), (after, rate, _) = self.drives[index - 1 : index + 1, k + 1]
        return (
            f"{packed.name}: the sweep from t = {self.times[0]:.6g} s to {self.times[-1]:.6g} s was given up at t = "
            f"{start:.9g} s: {self.inserted} steps were put between the {np.count_nonzero(self.wanted)} asked for. "
            f"The one from there to {end:.9g} s is doubted, too. In it driver '{packed.driver_names[k]}' goes from "
            f"{value:.6g} to {after:.6g} at a rate of {rate:.6g}. Its law shakes, or the motion passes one nearly "
            "singular pose after another: sweep a shorter time, smooth the law, or change a length."
        )

    def follow_laws(self) -> bool:
        """Divide all steps in which a law goes further than its stride; returns whether there were any."""
        count = len(self.times)
        for _ in range(64):
            h = np.diff(self.times)
            need = np.ceil(_strides_taken(self.times, self.drives, self.stride) * (1.0 - 1e-9))
            need[h <= self._shortest[1:]] = 1
            parts = np.clip(need, 1, AT_ONCE).astype(np.int64)
            if (parts == 1).all():
                break
            refuse_endless(self.packed, self.times, float(need.sum()))
            at = np.repeat(np.arange(1, len(self.times)), parts - 1)
            first = np.cumsum(parts - 1) - (parts - 1)
            number = np.arange(len(at)) - np.repeat(first, parts - 1) + 1
            self._insert(at, self.times[at - 1] + h[at - 1] * number / parts[at - 1])
        return len(self.times) > count

    def _insert_knots(self, knots: np.ndarray) -> None:
        """Keep knots at which a law is off the line of its step's ends: it may go and come back there."""
        knots = knots[~np.isin(knots, self.times) & (knots > self.times[0]) & (knots < self.times[-1])]
        if not len(knots):
            return
        at = np.searchsorted(self.times, knots)
        h = (self.times[at] - self.times[at - 1])[:, None]
        u = (knots - self.times[at - 1])[:, None] / h
        start, end = self.drives[at - 1], self.drives[at]
        way = end[..., 0] - start[..., 0]
        rise, fall = h * start[..., 1] - way, way - h * end[..., 1]
        led = start[..., 0] + u * (way + (1.0 - u) * ((1.0 - u) * rise + u * fall))  # cubic Hermite interpolation
        astray = np.abs(self.packed.drives(knots)[..., 0] - led) > ASTRAY * self.stride
        taken = astray.any(axis=1)
        if taken.any():
            self._insert(at[taken], knots[taken])

    def _insert(self, at: np.ndarray, times: np.ndarray) -> None:
        self.drives = np.insert(self.drives, at, self.packed.drives(times), axis=0)
        self.wanted = np.insert(self.wanted, at, False)
        self._shortest = np.insert(self._shortest, at, self._shortest[at])
        self.times = np.insert(self.times, at, times)
