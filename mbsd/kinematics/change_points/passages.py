"""Passages of a march past change points: the poses that they give, and where the march goes on.

The march comes to a pose where steps, however short, do not tell two assemblies apart. If they meet there
(assemblies.py), the steps nearby are left out, and it goes on beyond, on the smooth continuation or, where asked
for, on the other assembly. Poses near the change point are those of the passage.

Efforts near a change point follow from poses beside it (mbsd/arrays/efforts_beside.py): on both sides, or on one side
alone where the motion begins or ends there or switches to the other assembly.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from mbsd.arrays.efforts_beside import Side, lagrange
from mbsd.base.errors import ModelError, SingularPoseError
from mbsd.kinematics.change_points.assemblies import (
    APART,
    GAP,
    Assembly,
    Solver,
    Way,
    assembly_around,
    find_ahead,
    meets,
    other_assembly,
    way_from,
)
from mbsd.kinematics.steps import Steps

EDGE = 1.5 * GAP
"""Distance on both sides within which no step of the march is solved."""
BEYOND = (1.25, 1.5)
"""Times of the next steps after that, as parts of the time to the edge."""
FILLED = 0.022
"""Distance beyond the edge within which steps are those of the passage."""
FINEST, GROWTH, EVEN, MOST_LOOKS = 0.25, 1.02, 200, 1200
"""Steps in which the law is looked at: the first as a part of ``GAP``, growing after so many."""
CENTRED = 1e-3 * GAP
"""Distance of the change point from p = 0 within which the poses beside are taken as they are."""
ITSELF = 1e-9
"""Distance below which a pose is the change point itself."""
NEAR_END = 0.05
"""Part of the largest determinant below which the first and the last pose are looked at."""


@dataclass
class Passage:
    """The motion past one change point."""

    way: Way
    time: float
    """Time of the passage (s), or the time it would have if the motion began earlier or went on."""
    before: Assembly
    after: Assembly
    start: float
    end: float
    """Between these times no pose was solved (s)."""
    left_out: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """Times asked for in between (s)."""

    @property
    def is_switched(self) -> bool:
        """Return True if the motion goes on to the other assembly."""
        return self.after is not self.before

    @property
    def radius(self) -> float:
        """Largest distance at which poses are those of the passage."""
        return min(float(np.abs(assembly.nodes).min()) for assembly in (self.before, self.after))

    def motion(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return q, v, a (T, 3 nb) at ``times`` (T,) near the change point.

        Where the motion switches, they are those before it."""
        way = self.way.evaluate(times)
        late = (times > self.time) & ~self.is_at(times)
        q, slope, bend = self.before.evaluate(way[:, 0])
        if self.is_switched and late.any():
            q[late], slope[late], bend[late] = self.after.evaluate(way[late, 0])
        rate, second = way[:, 1, None], way[:, 2, None]
        return q, slope * rate, bend * rate * rate + slope * second

    def is_at(self, times: np.ndarray) -> np.ndarray:
        """Return (T,) whether the pose at ``times`` (s) is the change point itself, but for rounding."""
        return np.abs(self.way.evaluate(times)[:, 0]) <= ITSELF

    def is_near(self, times: np.ndarray) -> np.ndarray:
        """Return (T,) whether steps right beyond the gap at ``times`` (s) are those of the passage."""
        return np.abs(self.way.evaluate(times)[:, 0]) <= FILLED

    def covers(self, times: np.ndarray) -> np.ndarray:
        """Return (T,) True for the rising ``times`` (s) around it that stay within ``radius``."""
        near = np.abs(self.way.evaluate(times)[:, 0]) <= self.radius
        first, last = int(np.searchsorted(times, self.start, side="right")), int(np.searchsorted(times, self.end))
        while first > 0 and near[first - 1]:
            first -= 1
        while last < len(times) and near[last]:
            last += 1
        out = np.zeros(len(times), bool)
        out[first:last] = True
        return out


class Passages:
    """Change points of one march, in the order in which they are met."""

    def __init__(self, solver: Solver, steps: Steps, switch_at: np.ndarray) -> None:
        self.solver, self.steps = solver, steps
        self.switch_at = switch_at
        """(n,) times at which the motion is to go on to the other assembly (s)."""
        self.passages: list[Passage] = []
        self._vain = (0.0, -np.inf)
        """Times between which none was found (s)."""

    def pass_ahead(self, row: int, q: np.ndarray, v: np.ndarray) -> Passage | None:
        """Return the passage past a change point that the motion reaches after step ``row``, or None.

        ``q``, ``v`` (T, 3 nb), known up to ``row``. Steps in its gap are left out of ``steps``, and those from which
        the march goes on are put there.
        """
        if self._vain[0] <= self.steps.times[row] <= self._vain[1]:
            return None
        meeting = self._meeting(row, q[row], v[row])
        if meeting is None:
            return None
        passage = self._in_time(row, *meeting)
        if not passage.start < passage.end:
            return None
        passage.left_out = self._leave_gap(passage)
        self.passages.append(passage)
        return passage

    def solver_at(self, row: int, q: np.ndarray) -> Solver | None:
        """Return a solver with rows that depend less on each other at a step of q (T, 3 nb), None if there is none."""
        self.solver.start_from(row)
        return self.solver.exchanged(q[row], self.steps.drives[row])

    def pass_ends(self, q: np.ndarray, v: np.ndarray, determinant: np.ndarray, is_redundant: bool = False) -> None:
        """Find change points that the motion does not reach, but comes near to with its first or last pose.

        Where joints repeat others, rows that alone are singular near there are exchanged before.
        """
        largest = np.abs(determinant).max(axis=0, initial=0.0)
        for row in dict.fromkeys((0, len(q) - 1)):
            time = self.steps.times[row]
            is_known = any(passage.start <= time <= passage.end for passage in self.passages)
            if not is_known and (len(q) == 1 or (np.abs(determinant[row]) < NEAR_END * largest).any()):
                self.solver = (self.solver_at(row, q) if is_redundant else None) or self.solver
                meeting = self._meeting(row, q[row], v[row])
                if meeting is not None:
                    self.passages.append(self._in_time(row, *meeting))

    def fill(self, arrays: dict[str, np.ndarray], poses: tuple[str, str, str]) -> list[np.ndarray]:
        """Fill ``poses`` among ``arrays`` (T, ...) near change points, and return at which rows.

        Steps that were left out are put back, with zeros in all other arrays.
        """
        steps = self.steps
        for passage in self.passages:
            if len(passage.left_out):
                at = steps.restore(passage.left_out)
                for name, array in arrays.items():
                    arrays[name] = np.insert(array, at, 0.0, axis=0)
        filled = []
        for passage in self.passages:
            rows = np.flatnonzero(passage.covers(steps.times))
            for name, part in zip(poses, passage.motion(steps.times[rows]), strict=True):
                arrays[name][rows] = part
            filled.append(rows)
        return filled

    def _meeting(self, row: int, pose: np.ndarray, v: np.ndarray) -> tuple[Way, Assembly] | None:
        """Return the way past the change point near a pose, and the smooth motion on it; None without one."""
        steps, solver, time = self.steps, self.solver, float(self.steps.times[row])
        solver.start_from(row)
        way = way_from(steps.packed, steps.drives, steps.drives[row], time, v, solver, pose)
        ahead = None if way is None else find_ahead(solver, way, pose)
        if way is None or ahead is None:
            return None
        p, rate, _ = way.evaluate(np.array([time]))[0] - [ahead, 0.0, 0.0]
        way.origin += ahead / way.scale
        assembly = assembly_around(solver, way, pose, p)
        root = None if assembly is None else assembly.root()
        if root is not None and abs(root) > CENTRED:
            p -= root
            way.origin += root / way.scale
            assembly = assembly_around(solver, way, pose, p)
            root = None if assembly is None else assembly.root()
        if assembly is None or root is None or not meets(solver, way, assembly):
            self._vain = time, time + (abs(p / rate) if rate else 0.0)
            return None
        way.origin += root / way.scale
        return way, Assembly(assembly.nodes - root, assembly.parts, assembly.determinant)

    def _in_time(self, row: int, way: Way, assembly: Assembly) -> Passage:
        """Return when the motion is near the change point, and on which assembly it goes on."""
        known = self.steps.times[: row + 1]
        outside = np.flatnonzero(np.abs(way.evaluate(known)[:, 0]) >= EDGE)
        start = float(known[outside[-1]]) if len(outside) else -np.inf
        looks = self._looks(way, max(start, float(known[0])))
        p = way.evaluate(looks)[:, 0]
        inside = np.flatnonzero(np.abs(p) < EDGE)
        if not len(inside):
            time = _meeting_time(way, float(known[-1]))
            return Passage(way, time, assembly, assembly, time, time)
        left = np.flatnonzero(np.abs(p[inside[0] :]) >= EDGE)
        last = inside[0] + int(left[0]) if len(left) else len(looks) - 1
        time = _crossing_time(way, looks[max(inside[0] - 1, 0) : last + 1])
        passage = Passage(way, time, assembly, assembly, start, float(looks[last]) if len(left) else np.inf)
        if ((self.switch_at > passage.start) & (self.switch_at < passage.end)).any():
            passage.after = self._other(passage)
        return passage

    def _other(self, passage: Passage) -> Assembly:
        """Raises SingularPoseError where the other assembly is not known."""
        other = other_assembly(self.solver, passage.way, passage.before)
        if other is None:
            raise SingularPoseError(
                f"{self.steps.packed.name}: at the change point at t = {passage.time:.9g} s no single other assembly "
                "was meeting, so the motion cannot switch to it. Leave that time out of switch_at."
            )
        return other

    def refuse_missed_switches(self) -> None:
        """Raise ModelError where the motion was to switch at a time at which it passes no change point."""
        passed = [passage for passage in self.passages if passage.start < passage.end]
        for time in self.switch_at.tolist():
            if not any(passage.start < time < passage.end for passage in passed):
                times = ", ".join(f"{passage.time:.9g}" for passage in passed)
                where = f"it passes change points at t = {times} s" if passed else "it passes no change point"
                raise ModelError(
                    f"{self.steps.packed.name}: switch_at has t = {time:.9g} s, but {where}. Give times of these alone."
                )

    def _leave_gap(self, passage: Passage) -> np.ndarray:
        """Remove steps in the gap of a passage and add those beyond it; return requested times in the gap."""
        beyond = np.zeros(0)
        if np.isfinite(passage.end):
            beyond = passage.time + (passage.end - passage.time) * np.array([1.0, *BEYOND])
        return self.steps.leave_out(passage.start, passage.end, beyond)

    def _looks(self, way: Way, start: float) -> np.ndarray:
        """Return times from ``start`` to the end (s) for a look at a motion near a change point.

        They are dense at first.
        """
        end = float(self.steps.times[-1])
        _, rate, second = way.evaluate(np.array([start]))[0]
        step = FINEST * GAP / max(abs(rate), np.sqrt(GAP * abs(second)), GAP / max(end - start, 1e-300))
        growing = GROWTH ** np.clip(np.arange(MOST_LOOKS) - EVEN, 0, None)
        looks = start + np.append(0.0, step * np.cumsum(growing))
        return np.append(looks[looks < end], end)


def _meeting_time(way: Way, time: float) -> float:
    """Return when p is 0 if it goes on as it goes at ``time``, forward or backward (s)."""
    p, rate, _ = way.evaluate(np.array([time]))[0]
    return time - p / rate if rate else time


def _crossing_time(way: Way, looks: np.ndarray) -> float:
    """Return the time at which p is 0, or nearest to it; beyond ``looks`` (T,) if it leads there (s)."""
    ends = float(looks[0]), float(looks[-1])
    for _ in range(8):
        p = way.evaluate(looks)[:, 0]
        crossed = np.flatnonzero(p[:-1] * p[1:] <= 0.0)
        k = int(crossed[0]) if len(crossed) else int(np.argmin(np.abs(p)))
        first, last = looks[k if len(crossed) else max(k - 1, 0)], looks[min(k + 1, len(looks) - 1)]
        if not last > first:
            break
        looks = np.linspace(first, last, 33)
    time = float(looks[int(np.argmin(np.abs(way.evaluate(looks)[:, 0])))])
    return _meeting_time(way, time) if time in ends else time


NEAR = 0.02
"""Distance from the change point, in sizes and rad, within which efforts are those of poses beside."""
ONE_SIDE = 0.0325 + 0.0275 * np.cos(np.pi * (np.arange(8)[::-1] + 0.5) / 8)
"""Distances of the poses where there are some on one side alone, in sizes and rad: Chebyshev's."""
VANISHES = 1e-6
"""Part of its largest value below which the determinant of a block vanishes at the change point."""


def sides_of(passage: Passage, times: np.ndarray) -> list[Side]:
    """Return poses beside a change point for efforts at rising ``times`` (T,) (s), with their indices."""
    rows = times[passage.covers(times)]
    rows = rows[np.abs(passage.way.evaluate(rows)[:, 0]) < NEAR]
    if not len(rows):
        return []
    _, rate, second = passage.way.evaluate(np.array([passage.time]))[0]
    pace = max(abs(rate), np.sqrt(0.5 * NEAR * abs(second)))
    if not pace > 0.0:
        return [Side(passage.time, np.zeros(0), rows)]
    apart, ends = passage.is_switched, (float(times[0]), float(times[-1]))
    there = passage.is_at(rows) if apart else np.zeros(len(rows), bool)
    sides = sides_beside(passage.time, rows[~there], 1.0 / pace, *ends, apart)
    return [*sides, Side(passage.time, np.zeros(0), rows[there])] if there.any() else sides


def sides_beside(
    time: float, rows: np.ndarray, pace: float, start: float, end: float, is_switched: bool = False
) -> list[Side]:
    """Return poses beside a change point at ``time`` (s).

    In ``pace`` (s) the motion goes on by 1 size or rad.
    ``rows`` (R,): times of the efforts (s); ``start``, ``end``: times of the whole motion (s).
    """
    away = pace * NEAR * APART
    reach = float(away[-1])
    is_open = start <= time - reach and time + reach <= end
    early, late = start <= time - reach, time + reach <= end
    if not is_switched and (is_open or not (early or late)):
        return [Side(time, time + np.concatenate([-away[::-1], away]), rows)]
    alone = pace * ONE_SIDE
    sides = [Side(time, time - alone[::-1], rows[rows < time]), Side(time, time + alone, rows[rows > time])]
    if is_switched:
        return [side for side in sides if len(side.rows)]
    side = sides[0] if early else sides[1]
    return [Side(time, side.nodes, rows)]


def determinant_of(passage: Passage, times: np.ndarray) -> np.ndarray:
    """Return (T,) products of determinants that vanish at a change point, on one side of it.

    ``times`` are in s.
    """
    assembly = passage.after if passage.is_switched and times[0] > passage.time else passage.before
    weights = lagrange(assembly.nodes, np.append(passage.way.evaluate(times)[:, 0], 0.0))
    values = weights @ assembly.determinant
    vanishing = np.abs(values[-1]) < VANISHES * np.abs(assembly.determinant).max(axis=0)
    return np.prod(values[:-1, vanishing], axis=1)
