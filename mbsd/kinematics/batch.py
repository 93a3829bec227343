"""Many designs of one mechanism in one call: named values to numbers, and their sweeps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.arguments import number_array, whole_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.kinematics.design_sweeps import FINER, Batch, DesignSweeps, Moved, in_closed_form, settle
from mbsd.kinematics.prepared import prepare
from mbsd.model.body import at_end
from mbsd.model.mechanism import Model, names_given
from mbsd.numbers.names import place_in, placed_side

MOST_THREADS = 1024


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
    angles = names_given(f"{m.name}: batch: angles", angles)
    if threads is not None:
        threads = whole_number(f"{m.name}: batch: threads", threads)
        if threads > MOST_THREADS:
            raise ModelError(f"{m.name}: batch: threads is {shown(threads)}; it must be {MOST_THREADS} at most")
    grid = sweep_times(m, duration, steps, None)
    ready = prepare(m, float(grid[0]), float(grid[-1]))
    if not in_closed_form(ready):
        DesignSweeps(m, ready, grid, [])  # says why not
    values, moved = parameters(m, ready.packed, lengths, places)
    sweeps = DesignSweeps(m, ready, grid, moved, angles)
    out = sweeps(values, threads)
    settle(sweeps, lambda: DesignSweeps(m, ready, grid, moved, angles, FINER), out, values, threads)
    return out


def parameters(
    m: Model,
    packed: Packed,
    lengths: Mapping[str, Sequence[float] | np.ndarray],
    places: Mapping[str, Sequence[Sequence[float]] | np.ndarray],
) -> tuple[np.ndarray, list[Moved]]:
    """Return changes (n, p) against the mechanism, and what each moves: marker or trace coordinates."""
    columns: list[np.ndarray] = []
    moved: list[Moved] = []
    fixed = {_own_marker(m, packed, name) for name in places if name in m.joints and name not in m.traces}
    for name, values in lengths.items():
        rod = _rod(m, packed, name)
        if rod is None and m.known_body(name).length is None:
            raise ModelError(f"{m.name}: batch: '{name}' is no bar, so it has no length; give places instead")
        change = _finite(m, name, values, 1)[:, 0]
        if (change <= 0).any():
            raise ModelError(f"{m.name}: batch: length {change.min():g} m of '{name}' must be positive")
        if rod is not None:
            columns.append(change - packed.system.distance_length[rod])
            moved.append(Moved(rod=rod))
            continue
        body = m.bodies[name]
        ends = [
            (number, 0)
            for joint, pair in zip(packed.joints, packed.markers, strict=True)
            for marker, number in zip((joint.i, joint.j), (int(pair[0]), int(pair[1])), strict=True)
            if marker.body is body and at_end(marker, body.length) and number not in fixed  # its place is given
        ]
        own = [
            Moved(trace=(k, 0))
            for k, (trace, marker) in enumerate(m.traces.items())
            if marker.body is body and at_end(marker, body.length) and trace not in places
        ]
        moved += [Moved(ends), *own]
        columns += [change - body.length] * (1 + len(own))
    for name, values in places.items():
        change = _finite(m, name, values, 2)
        if name in m.traces:
            moved += [Moved(trace=(list(m.traces).index(name), axis)) for axis in (0, 1)]
        elif name in m.joints:
            moved += [Moved([(_own_marker(m, packed, name), axis)]) for axis in (0, 1)]
        else:
            raise ModelError(f"{m.name}: batch: {no_such('joint or traced point', name, [*m.joints, *m.traces])}")
        columns += [change[:, k] - place_in(m, name, axis).value for k, axis in enumerate("xy")]
    if not columns:
        raise ModelError(f"{m.name}: batch: nothing changes; give lengths or places")
    sizes = {len(column) for column in columns}
    if len(sizes) > 1:
        raise ModelError(
            f"{m.name}: batch: lists of {', '.join(map(str, sorted(sizes)))} designs; they must be equally long"
        )
    return np.column_stack(columns), moved


def _own_marker(m: Model, packed: Packed, name: str) -> int:
    """Return the number of the marker of a joint that ``places`` moves."""
    joint = m.joints[name]
    return int(packed.markers[packed.joints.index(joint)]["ij".index(placed_side(m, joint))])


def _rod(m: Model, packed: Packed, name: str) -> int | None:
    """Return the row of a rod of this name among distance constraints, if any.

    Raises ModelError if it is unclear.
    """
    joint = m.joints.get(name) if isinstance(name, str) else None
    if joint is None or joint.kind.constraints != ("distance",):
        return None
    if name in m.bodies:
        raise ModelError(f"{m.name}: batch: '{name}' is a body and a rod; give one of them another name")
    row = packed.rows_of(name).start
    return int(np.flatnonzero(packed.system.distance[:, 2] == row)[0])


def _finite(m: Model, name: str, values: Any, width: int) -> np.ndarray:
    out = number_array(f"{m.name}: batch: values of '{name}'", values)
    out = out[:, None] if width == 1 and out.ndim == 1 else out
    if out.ndim != 2 or out.shape[1] != width:
        shape = "(designs,)" if width == 1 else "(designs, 2)"
        raise ModelError(f"{m.name}: batch: values of '{name}' have shape {np.shape(values)}; give {shape}")
    return out
