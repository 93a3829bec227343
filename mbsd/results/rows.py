"""Rows of a motion: at jumps of forces, and after releases of joints and drivers.

A known time at which forces jump has two rows: right before it and right after it, at equal times. A motion is solved
on both sides of every possible jump; where neither accelerations nor reactions jump, these rows are removed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mbsd.model.event import Happening

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mbsd.results.solution import Solution


JUMPED = 1e-6
"""Part of the largest acceleration or reaction by which it differs on both sides of a jump."""

ROUNDING = 1e-6
"""Part of forces by the mechanism's size (or of accelerations over it) that torques (turning) are, to count."""
AT_ONCE = 1e-9
"""Part of the time spanned within which jumps are one."""


@dataclass(frozen=True)
class Jumps:
    """Times (s) right before and right after each possible jump, rising, with the names of what may jump."""

    before: np.ndarray
    after: np.ndarray
    """(n,)"""
    names: tuple[tuple[str, ...], ...]

    def __bool__(self) -> bool:
        return len(self.before) > 0

    def among(self, asked: np.ndarray) -> Asked:
        """Return output times ``asked`` (T,) with both sides of each jump.

        An output on a jump is right after it.
        """
        solved, shown, added, jumps = asked.copy(), asked.copy(), [], []
        for before, after, names in self._apart(AT_ONCE * float(asked[-1] - asked[0])):
            on = np.flatnonzero((asked >= before) & (asked <= after))
            if before <= asked[0] or after >= asked[-1] or len(on) > 1:
                continue
            if len(on):
                solved[on] = after
            else:
                added.append((after, after, True))
            added.append((before, float(shown[on[0]]) if len(on) else after, True))
            jumps.append((before, after, names))
        rows = [*zip(solved.tolist(), shown.tolist(), [False] * len(solved), strict=True), *added]
        times, labels, extra = (np.array(column) for column in zip(*sorted(rows), strict=True))
        return Asked(times, labels, extra.astype(bool), tuple(jumps))

    def _apart(self, least: float) -> list[tuple[float, float, tuple[str, ...]]]:
        """Merge times nearer to each other than ``least`` (s)."""
        out: list[tuple[float, float, tuple[str, ...]]] = []
        for before, after, names in zip(self.before.tolist(), self.after.tolist(), self.names, strict=True):
            if out and before - out[-1][1] < least:
                first, last, known = out.pop()
                out.append((first, max(last, after), tuple(dict.fromkeys(known + names))))
            else:
                out.append((before, after, names))
        return out


def jumps_of(rows: Sequence[tuple[float, float, tuple[str, ...]]]) -> Jumps:
    """Jumps from times right before and right after, in any order, with the names of what may jump."""
    ordered = sorted(rows)
    before, after = (np.array([row[k] for row in ordered], float) for k in (0, 1))
    return Jumps(before, after, tuple(names for _, _, names in ordered))


@dataclass(frozen=True)
class Asked:
    """Times at which a motion is solved, (T,) each, for jumps that may be: (before, after, names)."""

    solved: np.ndarray
    shown: np.ndarray
    """Times that their rows show."""
    extra: np.ndarray
    """True if nobody asked for it but a jump."""
    jumps: tuple[tuple[float, float, tuple[str, ...]], ...]

    def rows(self, solution: Solution) -> Solution:
        """The motion solved at these times, and perhaps events', with both rows of what jumps and no others.

        Its events tell what jumps.
        """
        t = solution.t
        at = np.searchsorted(self.solved, t)
        known = at < len(self.solved)
        known[known] = self.solved[at[known]] == t[known]
        shown = t.copy()
        shown[known] = self.shown[at[known]]
        keep = np.ones(len(t), bool)
        extra = self.solved[self.extra]
        extra = extra[extra <= t[-1]]  # a motion may end before
        keep[np.searchsorted(t, extra)] = False  # rows of events at the same time stand behind these
        marks = []
        for before, after, names in self.jumps:
            first = int(np.searchsorted(t, before, side="right")) - 1
            second = int(np.searchsorted(t, after))
            if first < 0 or second >= len(t) or t[first] != before or t[second] != after:
                continue  # the motion ended before
            size = solution.packed.size
            if _differ(solution.a, first, second, 1.0 / size) or _differ(solution.wrench, first, second, size):
                keep[[first, second]] = True
                marks += [Happening(float(shown[second]), name, "jumps") for name in names]
        events = sorted([*solution.events, *marks], key=lambda event: event.time)
        return replace(solution.only(keep), t=shown[keep], law_times=t[keep], events=tuple(events))


def _differ(values: np.ndarray, first: int, second: int, arm: float) -> bool:
    """Return which rows of values (T, n, 3), forces or accelerations and torques or turning, are apart.

    ``arm`` makes one of the other; what is nothing beside the other is rounding.
    """
    gap = np.abs(values[second] - values[first])
    straight, turning = (float(np.abs(part).max(initial=0.0)) for part in (values[..., :2], values[..., 2]))
    return bool(
        gap[:, :2].max(initial=0.0) > JUMPED * max(straight, ROUNDING * turning / arm)
        or gap[:, 2].max(initial=0.0) > JUMPED * max(turning, ROUNDING * straight * arm)
    )


def released_rows(sol: Solution) -> dict[str, np.ndarray]:
    """Return (T,) of each joint and driver that an event releases: True where that has happened."""
    if sol.held is None:
        return {}
    count = len(sol.packed.joints) - sol.packed.contacts
    joints = zip(sol.packed.joints[:count], sol.packed.first_row, strict=False)
    gone = {joint.name: ~sol.held[:, first] for joint, first in joints}
    return {name: since for name, since in gone.items() if since.any()}


def release_times(sol: Solution) -> dict[str, float]:
    """Return the time (s) of the event that released a joint or driver, by its name."""
    times = {}
    for name, gone in released_rows(sol).items():
        row = int(gone.argmax())
        since, until = sol.t[max(row - 1, 0)], sol.t[row]
        events = [event.time for event in sol.events if event.what == "event" and since <= event.time <= until]
        times[name] = float(events[-1] if events else until)
    return times
