"""Sweeps of many designs of one mechanism: prepared once, called with the numbers of n designs.

The numbers of the groups (mbsd/kinematics/groups) are linear in the places of the markers, so those of all designs are
one matrix product. Designs share the branch of the mechanism itself.

A batch looks at no pose between its steps, so it cannot tell a change point from a near miss. Designs whose branches
come near each other are doubted: swept in finer steps, then one by one by the march of a single sweep (march.py). That
passes change points on the smooth continuation, and raises an error for a design that does not close.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.running import cores
from mbsd.equations.system import System, workspace
from mbsd.kinematics.groups.blocks import BLOCK, no_blocks
from mbsd.kinematics.groups.carried import COS, DOUBTED, SOLVED
from mbsd.kinematics.groups.designs import Placed, Scratch, Wanted, place_designs
from mbsd.kinematics.groups.groups import DRIVEN, Groups
from mbsd.kinematics.groups.kinds.driven import OFFSET, SENSE
from mbsd.kinematics.groups.plan import plan_groups
from mbsd.kinematics.groups.tables import BRANCH, rows_of
from mbsd.kinematics.march import march_along
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.prepared import Prepared
from mbsd.kinematics.steps import divisions
from mbsd.model.mechanism import Model
from mbsd.model.output_times import check_memory

CHUNK = 64
"""Designs that a thread takes at once."""


class Push(NamedTuple):
    """A change that differs from one time to the next: ``size`` times ``profile``."""

    column: int
    """Number of the parameter, which moves no traced point."""
    size: np.ndarray
    """(n,) of each design."""
    profile: np.ndarray
    """(T,) at each time."""


class Moved(NamedTuple):
    """The change that one parameter makes."""

    markers: Sequence[tuple[int, int]] = ()
    """Marker and axis."""
    trace: tuple[int, int] | None = None
    """Traced point and axis."""
    rod: int | None = None
    """Row of the distance constraints."""


@dataclass(frozen=True, eq=False)
class Batch:
    """Results of n designs at T times; NaN where a design does not close."""

    t: np.ndarray
    """(T,) s."""
    points: dict[str, np.ndarray]
    """(n, T, 2) of each traced point (m)."""
    angles: dict[str, np.ndarray]
    """(n, T) of each body asked for (rad)."""
    closes: np.ndarray
    """(n,) whether the links close all the way."""
    doubted: np.ndarray
    """(n,) whether a design was given up where its branches come near each other (:func:`settle`)."""


def in_closed_form(ready: Prepared) -> bool:
    """Return True if a mechanism is made of driven bodies and dyads without a redundant joint."""
    groups = ready.groups
    return groups is not None and not ready.mobility.redundant_rows and not (groups.kind >= BLOCK).any()


class DesignSweeps:
    """Sweeps over times ``grid`` (T,) of designs that differ in what ``moved`` says.

    ``finer``: so many times more steps between two times than the drivers need; they clear some doubts of branches.
    Raises ModelError for a mechanism that is not made of driven bodies and dyads, and for an angle of no body.
    """

    def __init__(
        self,
        m: Model,
        ready: Prepared,
        grid: np.ndarray,
        moved: Sequence[Moved],
        angles: Sequence[str] = (),
        finer: int = 1,
    ) -> None:
        if not in_closed_form(ready):
            raise ModelError(
                f"{m.name}: batch solves mechanisms of driven bodies and dyads (pins, sliders, slots, rods, "
                "welds); this one holds something else or a redundant joint. Sweep its designs one by one."
            )
        assert ready.groups is not None
        packed = ready.packed
        self.m, self.ready, self.packed, self.groups = m, ready, packed, ready.groups
        self.q0, self.grid = ready.q0, grid
        self.moved, self.angles = list(moved), list(angles)
        self.slopes = slopes(packed, ready.q0, ready.groups, self.moved)
        self.bodies = np.array([packed.body_names.index(p.body.name) for p in m.traces.values()], np.int64)
        self.arms = np.array([(p.x, p.y) for p in m.traces.values()]).reshape(-1, 2) - packed.com[self.bodies]
        self.turned = np.array([_body(m, packed, name) for name in angles], np.int64)
        self.every = finer * divisions(packed, grid)
        dense = np.linspace(grid[0], grid[-1], self.every * (len(grid) - 1) + 1)
        self.driven = _driven(self.groups, packed.drives(dense))

    def __call__(self, values: np.ndarray, threads: int | None = None) -> Batch:
        """Sweep designs whose numbers differ from the mechanism's own by ``values`` (n, moved) (m)."""
        m, grid, traces = self.m, self.grid, len(self.bodies)
        count, turned = len(values), len(self.turned)
        check_memory(
            f"{m.name}: {count} designs at {len(grid)} times",
            count * (len(grid) * (2 * traces + turned) + self.groups.number.size),
            "Take fewer designs or steps at once",
        )
        numbers, arms = self._numbers(values), self.arms_of(values)
        out = np.empty((count, traces, len(grid), 2))
        out_angles = np.empty((count, turned, len(grid)))
        status = np.zeros(count, np.int64)

        def work(first: int) -> None:
            part = slice(first, min(first + CHUNK, count))
            self._place(numbers[part], self.q0, slice(None), self.every, arms[part], out[part], out_angles[part],
                        status[part])  # fmt: skip
            for part_of in (out, out_angles):
                part_of[part][status[part] != SOLVED] = np.nan

        starts = range(0, count, CHUNK)
        if count:
            work(0)  # compiles before the threads start
        if len(starts) > 1:
            with ThreadPoolExecutor(threads or cores()) as pool:
                list(pool.map(work, starts[1:]))
        points = {name: out[:, k] for k, name in enumerate(m.traces)}
        angles = {name: out_angles[:, k] for k, name in enumerate(self.angles)}
        return Batch(grid, points, angles, status == SOLVED, status == DOUBTED)

    def pushed(
        self, values: np.ndarray, pushes: Sequence[Push], poses: np.ndarray, threads: int | None = None
    ) -> Batch:
        """Return poses of designs whose numbers vary in time: by ``values`` (n, moved) and ``pushes``.

        Each time is solved alone, on the branch of the mechanism itself, whose poses (T, 3 nb) angles are near.
        """
        count, times = len(values), len(self.grid)
        base, arms = self._numbers(values), self.arms_of(values)
        out = np.empty((times, count, len(self.bodies), 1, 2))
        out_angles = np.empty((times, count, len(self.turned), 1))
        status = np.zeros((times, count), np.int64)

        def work(k: int) -> None:
            numbers = base.copy()
            for push in pushes:
                slope = self.slopes[push.column]
                assert slope is not None
                touched = np.flatnonzero(slope.any(axis=1))
                numbers[:, touched] += (push.profile[k] * push.size)[:, None, None] * slope[touched]
            self._place(numbers, poses[k], slice(self.every * k, self.every * k + 1), 1, arms, out[k], out_angles[k],
                        status[k])  # fmt: skip

        if count:
            work(0)  # compiles before the threads start
        with ThreadPoolExecutor(threads or cores()) as pool:
            list(pool.map(work, range(1, times)))
        closes = (status == SOLVED).all(axis=0)
        out[:, ~closes], out_angles[:, ~closes] = np.nan, np.nan
        points = {name: np.moveaxis(out[:, :, k, 0], 0, 1) for k, name in enumerate(self.m.traces)}
        angles = {name: out_angles[:, :, k, 0].T for k, name in enumerate(self.angles)}
        return Batch(self.grid, points, angles, closes, (status == DOUBTED).any(axis=0))

    def arms_of(self, values: np.ndarray) -> np.ndarray:
        """Return (n, points, 2) of the traced points, from centres of mass."""
        arms = np.tile(self.arms, (len(values), 1, 1))
        for column, change in enumerate(self.moved):
            if change.trace is not None:
                arms[:, change.trace[0], change.trace[1]] += values[:, column]
        return arms

    def system_of(self, values: np.ndarray) -> System:
        """Return the arrays of a design whose numbers differ from the mechanism's by ``values`` (moved,) (m)."""
        system = self.packed.system
        arms, lengths = system.marker_arm.copy(), system.distance_length.copy()
        for value, change in zip(values.tolist(), self.moved, strict=True):
            for number, axis in change.markers:
                arms[number, axis] += value
            if change.rod is not None:
                lengths[change.rod] += value
        return system.changed(marker_arm=arms, distance_length=lengths)

    def _place(
        self, numbers: np.ndarray, start: np.ndarray, steps: slice, every: int, arms: np.ndarray, out: np.ndarray,
        out_angles: np.ndarray, status: np.ndarray,
    ) -> None:  # fmt: skip
        """Fill rows of results with poses of designs with ``numbers`` (n, g, 14); angles begin at ``start``."""
        place = np.zeros((len(self.packed.body_names), 7))
        place[0, COS] = 1.0
        scratch = Scratch(place, np.zeros((1, 1)), np.zeros((len(self.groups.kind), 2)), np.zeros(len(self.turned)))
        place_designs(
            self.groups.group, rows_of(self.groups.kind, numbers), start, self.driven[steps], every,
            Wanted(self.bodies, arms, self.turned), Placed(out, out_angles, status), scratch,
        )  # fmt: skip

    def _numbers(self, values: np.ndarray) -> np.ndarray:
        """Return (n, g, 14) numbers of all designs' groups, exact since linear in places and lengths."""
        out = np.tile(self.groups.number, (len(values), 1, 1))
        for column, slope in enumerate(self.slopes):
            if slope is not None:
                out += values[:, column, None, None] * slope
        return out


def slopes(packed: Packed, q0: np.ndarray, groups: Groups, moved: Sequence[Moved]) -> list[np.ndarray | None]:
    """Return the change of the groups' (g, 14) numbers by each parameter; None for traced points."""
    out: list[np.ndarray | None] = []
    arms = packed.system.marker_arm
    for change in moved:
        if change.trace is not None:
            out.append(None)
            continue
        shifted, lengths = arms.copy(), packed.system.distance_length.copy()
        for number, axis in change.markers:
            shifted[number, axis] += 1.0
        if change.rod is not None:
            lengths[change.rod] += 1.0
        system = packed.system.changed(marker_arm=shifted, distance_length=lengths)
        changed = plan_groups(replace(packed, system=system, constant=None), q0, 0)
        assert changed is not None
        slope = changed.number - groups.number
        for e, kind in enumerate(groups.kind):
            if int(kind) in BRANCH:
                slope[e, BRANCH[int(kind)]] = 0.0
        out.append(slope)
    return out


def _driven(groups: Groups, drives: np.ndarray) -> np.ndarray:
    """Return (T, g, 2) which no design changes: cosine and sine of driven angles, other laws."""
    driven = np.zeros((len(drives), len(groups.kind), 2))
    for e, kind in enumerate(groups.kind):
        if kind == DRIVEN:
            angle = groups.number[e, SENSE] * (groups.number[e, OFFSET] + drives[:, groups.motion[e], 0])
            driven[:, e] = np.column_stack([np.cos(angle), np.sin(angle)])
        else:
            driven[:, e, 0] = drives[:, groups.motion[e], 0]
    return driven


def _body(m: Model, packed: Packed, name: str) -> int:
    m.known_body(name)
    return packed.body_names.index(name)


FINER = 8
"""Times more steps with which designs are swept again."""


def settle(
    sweeps: DesignSweeps, finer: Callable[[], DesignSweeps], batch: Batch, values: np.ndarray, threads: int | None
) -> None:
    """Give designs of a ``batch`` that are doubted the results of sweeps that look closer.

    ``values`` (n, moved): their numbers against the mechanism's own (m). ``finer``: sweeps of the same with ``FINER``
    times more steps. A design whose sweep is refused does not close; one that starts on another branch stays doubted.
    """
    if not batch.doubted.any():
        return
    rows = batch.doubted.copy()
    _copy_rows(batch, rows, finer()(values[rows], threads))
    for row in np.flatnonzero(batch.doubted).tolist():
        try:
            q = _swept(sweeps, values[row])
        except MechanismError:
            batch.doubted[row] = False
            continue
        if q is not None:
            _fill_row(sweeps, batch, row, values[row], q)


def _copy_rows(batch: Batch, rows: np.ndarray, others: Batch) -> None:
    """Give some rows the results of ``others``."""
    for name, points in batch.points.items():
        points[rows] = others.points[name]
    for name, angles in batch.angles.items():
        angles[rows] = others.angles[name]
    batch.closes[rows], batch.doubted[rows] = others.closes, others.doubted


def _fill_row(sweeps: DesignSweeps, batch: Batch, row: int, values: np.ndarray, q: np.ndarray) -> None:
    """Give a row the traced points and angles of poses q (T, 3 nb)."""
    arms = sweeps.arms_of(values[None])[0]
    for points, body, (x, y) in zip(batch.points.values(), sweeps.bodies.tolist(), arms, strict=True):
        c, s = np.cos(q[:, 3 * body + 2]), np.sin(q[:, 3 * body + 2])
        points[row, :, 0] = q[:, 3 * body] + c * x - s * y
        points[row, :, 1] = q[:, 3 * body + 1] + s * x + c * y
    for angles, body in zip(batch.angles.values(), sweeps.turned.tolist(), strict=True):
        theta = q[:, 3 * body + 2]
        turns = round((sweeps.q0[3 * body + 2] - theta[0]) / math.tau)
        angles[row] = theta + math.tau * turns
    batch.closes[row], batch.doubted[row] = True, False


def _swept(sweeps: DesignSweeps, values: np.ndarray) -> np.ndarray | None:
    """Return the poses (T, 3 nb) of one design; None if it starts on another branch.

    Raises MechanismError.
    """
    ready, grid = sweeps.ready, sweeps.grid
    system = sweeps.system_of(values)
    scratch = workspace(system, len(ready.packed.ws.phi))
    packed = replace(ready.packed, system=system, ws=scratch, constant=None)
    q0 = assemble(sweeps.m, packed, float(grid[0]))
    groups = plan_groups(packed, q0, 0)
    if groups is None or (groups.kind != sweeps.groups.kind).any():
        return None
    for own, base, kind in zip(groups.number, sweeps.groups.number, groups.kind.tolist(), strict=True):
        if kind in BRANCH and own[BRANCH[kind]] * base[BRANCH[kind]] < 0.0:
            return None
    own = Prepared(packed, q0, ready.start_time, ready.sequence, ready.factors, ready.mobility, groups, no_blocks())
    return march_along(own, grid).q
