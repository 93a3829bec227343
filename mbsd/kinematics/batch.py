"""Many designs of one mechanism in one call: the same linkage with other lengths and places, solved in closed form.

The numbers of the groups (mbsd/kinematics/groups) are linear in the places of the markers, so those of all designs are
one matrix product. Designs share the branch of the mechanism itself.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.arguments import number_array, whole_number
from mbsd.base.errors import ModelError
from mbsd.base.names import names_in, no_such
from mbsd.base.shown import shown
from mbsd.kinematics.groups.blocks import BLOCK
from mbsd.kinematics.groups.designs import place_designs
from mbsd.kinematics.groups.groups import BRANCH, DRIVEN, PRP, RPR, RRP, SLIDE, WELDED, YOKE, Groups
from mbsd.kinematics.groups.plan import plan_groups
from mbsd.kinematics.groups.solve import DOUBTED, SOLVED
from mbsd.kinematics.prepared import prepare
from mbsd.kinematics.steps import divisions
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.model.output_times import refuse_beyond_memory


class Moved(NamedTuple):
    """What one parameter changes."""

    markers: Sequence[tuple[int, int]] = ()
    """Marker and axis."""
    trace: tuple[int, int] | None = None
    """Traced point and axis."""
    rod: int | None = None
    """Row of the distance constraints."""


MOST_THREADS = 1024
CHUNK = 64
"""Designs that a thread takes at once."""


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
    """(n,) whether a design was given up where its branches come near each other; sweep it alone to see more."""


def batch(
    m: Model,
    lengths: Mapping[str, Sequence[float] | np.ndarray],
    places: Mapping[str, Sequence[Sequence[float]] | np.ndarray],
    angles: Sequence[str],
    duration: float | None,
    steps: int,
    threads: int | None,
) -> Batch:
    """See :meth:`mbsd.mechanism.Mechanism.batch`."""
    from mbsd.kinematics.sweep import sweep_times

    for what, given in (("lengths", lengths), ("places", places)):
        if not isinstance(given, Mapping):
            raise ModelError(
                f"{m.name}: batch: {what} are {shown(given)}; give names and their values: {{name: [...]}}"
            )
    angles = names_in(f"{m.name}: batch: angles", angles)
    if threads is not None:
        threads = whole_number(f"{m.name}: batch: threads", threads)
        if threads > MOST_THREADS:
            raise ModelError(f"{m.name}: batch: threads is {shown(threads)}; it must be {MOST_THREADS} at most")
    grid = sweep_times(m, duration, steps, None)
    ready = prepare(m, float(grid[0]), float(grid[-1]))
    packed, groups = ready.packed, ready.groups
    if groups is None or ready.mobility.redundant_rows or (groups.kind >= BLOCK).any():
        raise ModelError(
            f"{m.name}: batch solves mechanisms of driven bodies and dyads (pins, sliders, slots, rods, "
            "welds); this one holds something else or a redundant joint. Sweep its designs one by one."
        )
    values, moved = _parameters(m, packed, lengths, places)
    count = len(values)
    numbers = _numbers(packed, ready.q0, groups, values, moved)
    markers = list(m.traces.values())
    refuse_beyond_memory(
        f"{m.name}: {count} designs at {len(grid)} times",
        count * (len(grid) * (2 * len(markers) + len(angles)) + groups.number.size),
        "Take fewer designs or steps at once",
    )
    arms = np.array([(p.x, p.y) for p in markers]).reshape(-1, 2)
    bodies = np.array([packed.body_names.index(p.body.name) for p in markers], np.int64)
    arms_of = np.tile(arms - packed.com[bodies], (count, 1, 1)) if markers else np.zeros((count, 0, 2))
    for column, change in enumerate(moved):
        if change.trace is not None:
            arms_of[:, change.trace[0], change.trace[1]] += values[:, column]
    turned = np.array([_body(m, packed, name) for name in angles], np.int64)
    out = np.empty((count, len(markers), len(grid), 2))
    out_angles = np.empty((count, len(turned), len(grid)))
    status = np.zeros(count, np.int64)
    every = divisions(packed, grid)
    driven, fixed = _turns(groups, packed.drives(np.linspace(grid[0], grid[-1], every * (len(grid) - 1) + 1)))

    def work(first: int) -> None:
        part = slice(first, min(first + CHUNK, count))
        place = np.zeros((len(packed.body_names), 4))
        place[0, 2] = 1.0
        scratch, roots, last = np.zeros((2, 2)), np.zeros((len(groups.kind), 2)), np.zeros(len(turned))
        place_designs(
            groups, numbers[part], ready.q0, driven, every, fixed, place, scratch, roots, last,
            bodies, arms_of[part], turned, out[part], out_angles[part], status[part],
        )  # fmt: skip
        for part_of in (out, out_angles):
            part_of[part][status[part] != SOLVED] = np.nan

    starts = range(0, count, CHUNK)
    if count:
        work(0)  # compiles before the threads start
    with ThreadPoolExecutor(threads or os.process_cpu_count()) as pool:
        list(pool.map(work, starts[1:]))
    points = {name: out[:, k] for k, name in enumerate(m.traces)}
    return Batch(
        grid, points, {name: out_angles[:, k] for k, name in enumerate(angles)}, status == SOLVED, status == DOUBTED
    )


def _turns(groups: Groups, drives: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What no design changes: cosine and sine of driven angles, other laws (T, g, 2); turns of A and B (g, 2, 2)."""
    driven = np.zeros((len(drives), len(groups.kind), 2))
    fixed = np.zeros((len(groups.kind), 2, 2))
    constant = {
        WELDED: ((0, 4),),
        RRP: ((1, 10),),
        RPR: ((1, 9),),
        YOKE: ((0, 8),),
        PRP: ((0, 4), (1, 11)),
        SLIDE: ((0, 4),),
    }
    for e, kind in enumerate(groups.kind):
        if kind == DRIVEN:
            angle = groups.number[e, 5] * (groups.number[e, 4] + drives[:, groups.motion[e], 0])
            driven[:, e] = np.column_stack([np.cos(angle), np.sin(angle)])
        else:
            driven[:, e, 0] = drives[:, groups.motion[e], 0]
        for side, column in constant.get(int(kind), ()):
            angle = groups.number[e, column]
            fixed[e, side] = math.cos(angle), math.sin(angle)
    return driven, fixed


def _body(m: Model, packed: Packed, name: str) -> int:
    m.known_body(name)
    return packed.body_names.index(name)


def _parameters(
    m: Model,
    packed: Packed,
    lengths: Mapping[str, Sequence[float] | np.ndarray],
    places: Mapping[str, Sequence[Sequence[float]] | np.ndarray],
) -> tuple[np.ndarray, list[Moved]]:
    """Changes (n, p) against the mechanism itself, and what each moves: marker coordinates, or one of a trace."""
    columns: list[np.ndarray] = []
    moved: list[Moved] = []
    traces = list(m.traces)
    for name, values in lengths.items():
        rod = _rod(m, packed, name)
        body = m.known_body(name) if rod is None else m.ground
        if rod is None and body.length is None:
            raise ModelError(f"{m.name}: batch: '{name}' is no bar, so it has no length; give places instead")
        change = _finite(m, name, values, 1)[:, 0]
        if (change <= 0).any():
            raise ModelError(f"{m.name}: batch: length {change.min():g} m of '{name}' must be positive")
        if rod is not None:
            columns.append(change - packed.system.distance_length[rod])
            moved.append(Moved(rod=rod))
        if body.length is None:
            continue
        ends = [
            (number, 0)
            for joint, pair in zip(packed.joints, packed.markers, strict=True)
            for marker, number in zip((joint.i, joint.j), (int(pair[0]), int(pair[1])), strict=True)
            if marker.body is body and _at_end(marker, body.length)
        ]
        columns.append(change - body.length)
        moved.append(Moved(ends))
        for k, trace in enumerate(traces):
            if m.traces[trace].body is body and _at_end(m.traces[trace], body.length):
                columns.append(change - body.length)
                moved.append(Moved(trace=(k, 0)))
    for name, values in places.items():
        change = _finite(m, name, values, 2)
        if name in m.traces:
            base, target = m.traces[name], [Moved(trace=(traces.index(name), axis)) for axis in (0, 1)]
        elif name in m.joints:
            joint = m.joints[name]
            first = joint.i.body is m.ground or joint.j.body is not m.ground
            base = joint.i if first else joint.j
            number = int(packed.markers[packed.joints.index(joint)][0 if first else 1])
            target = [Moved([(number, axis)]) for axis in (0, 1)]
        else:
            raise ModelError(f"{m.name}: batch: {no_such('joint or traced point', name, [*m.joints, *m.traces])}")
        columns += [change[:, 0] - base.x, change[:, 1] - base.y]
        moved += target
    if not columns:
        raise ModelError(f"{m.name}: batch: nothing changes; give lengths or places")
    sizes = {len(column) for column in columns}
    if len(sizes) > 1:
        raise ModelError(
            f"{m.name}: batch: lists of {', '.join(map(str, sorted(sizes)))} designs; they must be equally long"
        )
    return np.column_stack(columns), moved


def _rod(m: Model, packed: Packed, name: str) -> int | None:
    """The row among the distance constraints of a rod of this name, if there is one. Raises ModelError if unclear."""
    joint = m.joints.get(name) if isinstance(name, str) else None
    if joint is None or joint.kind.constraints != ("distance",):
        return None
    if name in m.bodies:
        raise ModelError(f"{m.name}: batch: '{name}' is a body and a rod; give one of them another name")
    row = packed.first_row[packed.joints.index(joint)]
    return int(np.flatnonzero(packed.system.distance[:, 2] == row)[0])


def _at_end(marker: Marker, length: float) -> bool:
    return marker.x == length and marker.y == 0.0


def _finite(m: Model, name: str, values: Any, width: int) -> np.ndarray:
    out = number_array(f"{m.name}: batch: values of '{name}'", values)
    out = out[:, None] if width == 1 and out.ndim == 1 else out
    if out.ndim != 2 or out.shape[1] != width:
        shape = "(designs,)" if width == 1 else "(designs, 2)"
        raise ModelError(f"{m.name}: batch: values of '{name}' have shape {np.shape(values)}; give {shape}")
    return out


def _numbers(packed: Packed, q0: np.ndarray, groups: Groups, values: np.ndarray, moved: list[Moved]) -> np.ndarray:
    """(n, g, 14) numbers of the groups of all designs; exact, for they are linear in places and lengths."""
    out = np.tile(groups.number, (len(values), 1, 1))
    arms = packed.system.marker_arm
    for column, change in enumerate(moved):
        if change.trace is not None:
            continue
        shifted, lengths = arms.copy(), packed.system.distance_length.copy()
        for number, axis in change.markers:
            shifted[number, axis] += 1.0
        if change.rod is not None:
            lengths[change.rod] += 1.0
        system = packed.system._replace(marker_arm=shifted, distance_length=lengths)
        changed = plan_groups(replace(packed, system=system), q0, 0)
        assert changed is not None
        slope = changed.number - groups.number
        for e, kind in enumerate(groups.kind):
            if int(kind) in BRANCH:
                slope[e, BRANCH[int(kind)]] = 0.0
        out += values[:, column, None, None] * slope
    return out
