"""Spans of time: intervals of data.json, neighbours together where there are many, halved where a search needs it."""

from __future__ import annotations

import numpy as np

from mechanisms.stages.clearance.path import RelativePath

MOST = 400
"""Spans to begin with; of more intervals, neighbours are taken together."""


class Spans:
    """A table that grows. Each span knows where the mover is at its ends and middle, and how far it strays between.

    ``first`` and ``last`` are the intervals it lies in; ``off`` (mm) is what the true motion may be off there.
    ``ends`` (n, 3, 3): at start, middle and end the centre's x, y (mm) and the angle (rad); ``place`` and ``turned``
    (n, 3) are the same as x + i y and e^(i angle). ``push`` (mm) and ``spin``
    (mm a mm from the centre) are how far points stray from the straight lines between their ends. ``travel`` (mm) and
    ``turn`` (rad) are how far centre and angle are from the middle's at most.
    """

    def __init__(self, path: RelativePath) -> None:
        self.path = path
        start, width = path.mover.start, path.mover.width
        self.error = path.error
        self._most = 1 + (len(start) - 1) // MOST
        """Intervals in a span."""
        jumps = np.flatnonzero(np.diff(path.mover.first) != 1) + 1  # two samples at one time: velocities may differ
        firsts = np.unique(np.concatenate([np.arange(0, len(start), self._most), jumps]))
        lasts = np.append(firsts[1:], len(start)) - 1
        self.first, self.last = np.empty(0, int), np.empty(0, int)
        self.start, self.end = np.empty(0), np.empty(0)
        self.ends = np.empty((0, 3, 3))
        self.place, self.turned = np.empty((0, 3), complex), np.empty((0, 3), complex)
        self.push, self.spin, self.travel, self.turn, self.off = (np.empty(0) for _ in range(5))
        self._half = np.empty(0, int)
        self._add(firsts, lasts, start[firsts], start[lasts] + width[lasts])

    def __len__(self) -> int:
        return len(self.start)

    def middle(self, spans: np.ndarray) -> np.ndarray:
        """(n,): the time (s) in the middle of each span."""
        return (self.start[spans] + self.end[spans]) / 2

    def stray(self, spans: np.ndarray, reach: np.ndarray) -> np.ndarray:
        """(n,): how far (mm) points within ``reach`` of the centre are from where they are at the middle, at most."""
        return self.travel[spans] + reach * self.turn[spans]

    def halves(self, spans: np.ndarray) -> np.ndarray:
        """(n,): the first half of each span; the second is the next one."""
        new = np.unique(spans[self._half[spans] < 0])
        if len(new):
            middle = self.middle(new)
            self._half[new] = len(self) + 2 * np.arange(len(new))
            cut = np.clip(self.path.mover.interval(middle), self.first[new], self.last[new])
            before = np.where(self.path.mover.start[cut] < middle, cut, cut - 1)
            first, last = np.stack([self.first[new], cut], axis=1), np.stack([before, self.last[new]], axis=1)
            bounds = np.stack([self.start[new], middle, self.end[new]], axis=1)
            self._add(first.ravel(), last.ravel(), bounds[:, :2].ravel(), bounds[:, 1:].ravel())
        return self._half[spans]

    def _add(self, first: np.ndarray, last: np.ndarray, start: np.ndarray, end: np.ndarray) -> None:
        middle = (start + end) / 2
        inner = np.clip(self.path.mover.interval(middle), first, last)
        places = ((first, start), (inner, middle), (last, end))
        ends = np.stack([self.path.place(k, t) for k, t in places], axis=1)
        off = np.abs(ends[:, (0, 2)] - ends[:, 1:2])
        bend = (end - start) ** 2 / 8
        within = np.minimum(first[:, None] + np.arange(self._most), last[:, None])
        push, spin = bend * self.path.push[within].max(axis=1), bend * self.path.spin[within].max(axis=1)
        columns = {
            "first": first,
            "last": last,
            "off": self.error[within].max(axis=1),
            "start": start,
            "end": end,
            "ends": ends,
            "place": ends[:, :, 0] + 1j * ends[:, :, 1],
            "turned": np.exp(1j * ends[:, :, 2]),
            "push": push,
            "spin": spin,
            "travel": np.hypot(off[:, :, 0], off[:, :, 1]).max(axis=1) + push,
            "turn": off[:, :, 2].max(axis=1) + spin,
            "_half": np.full(len(start), -1),
        }
        for name, column in columns.items():
            setattr(self, name, np.concatenate([getattr(self, name), column]))
