"""How fast contacts approached when they began, noted step by step, so that results know it at each output."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd.arrays.approaches import remembers
from mbsd.dynamics.state import PAUSED, TIME, State
from mbsd.equations.interactions.switching import APPROACHED
from mbsd.equations.loads import Loads


class Approaches:
    """What the contacts of one mechanism remember, after each accepted step; kernels read and write the last of it."""

    def __init__(self, loads: Loads) -> None:
        self._now = loads.switch[1:, APPROACHED]
        self._asked = remembers(loads)
        self.forget()

    def __bool__(self) -> bool:
        return self._asked

    def forget(self) -> None:
        """Nothing has happened yet."""
        self._now[:] = np.nan
        self._times: list[float] = []
        self._speeds: list[np.ndarray] = []

    def copy(self) -> Approaches | None:
        """All that is noted, for results; None where no contact asks for it."""
        if not self._asked:
            return None
        out = object.__new__(Approaches)
        out._now, out._asked, out._times, out._speeds = self._now, True, [*self._times], [*self._speeds]
        return out

    def at(self, times: np.ndarray) -> np.ndarray:
        """(T, n) what was remembered in the steps that passed these times (m/s)."""
        none = np.full(len(self._now), np.nan)
        before = [bisect_left(self._times, t) - 1 for t in times]
        return np.array([none if k < 0 else self._speeds[k] for k in before]).reshape(len(times), -1)

    def recall(self, time: float) -> None:
        """Let kernels go on from this time (s)."""
        self._now[:] = self.at(np.array([time]))[0]

    def note(self, time: float) -> None:
        """Keep what is remembered at a time (s), and forget what was noted later, in steps that were taken back."""
        if self._asked:
            kept = bisect_left(self._times, time)
            del self._times[kept:], self._speeds[kept:]
            self._times.append(time)
            self._speeds.append(self._now.copy())

    def through(self, advance: Callable[..., int], arrays: Any, scratch: Any, state: State, *rest: Any) -> int:
        """``advance`` of an Integrator, a step at a time, with what each step leaves noted."""
        out, settings, end, steps = rest
        kept = bisect_right(self._times, float(state.clock[TIME]))
        del self._times[kept:], self._speeds[kept:]  # steps that were taken back
        for _ in range(steps):
            status = advance(arrays, scratch, state, out, settings, end, 1)
            self._times.append(float(state.clock[TIME]))
            self._speeds.append(self._now.copy())
            if status != PAUSED:
                return status
        return PAUSED
