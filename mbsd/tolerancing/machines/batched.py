"""Linkages swept all at once, their pins in the bores where the reaction pushes them.

The sweep is that of mbsd/kinematics/batch.py.
"""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mbsd.dynamics.measures.kinds import Measure
from mbsd.kinematics.batch import parameters
from mbsd.kinematics.design_sweeps import FINER, Batch, DesignSweeps, Moved, Push, in_closed_form, settle
from mbsd.kinematics.prepared import prepare
from mbsd.model.body import at_end
from mbsd.model.mechanism import Model
from mbsd.numbers.names import place_in, placed_side
from mbsd.tolerancing.dimensions.dimension import Column
from mbsd.tolerancing.machines.one_by_one import Answers
from mbsd.tolerancing.machines.results import called, measured, numbers_of_batch, placed

NUMBERS_AT_ONCE = 8_000_000
"""Numbers of a batch's results, 64 MB."""
OPEN = "the links do not close over the whole motion"
DOUBTED = "two assemblies come near each other during the motion"


def serves(m: Model, columns: Sequence[Column], result: Any, ready: Any) -> bool:
    """Return True if these machines can be swept all at once."""
    return (
        in_closed_form(ready)
        and all(column.kind not in ("argument", "part") for column in columns)
        and (not isinstance(result, Measure) or all(placed(m, name) for name in result.quantities))
    )


class Batched:
    """Mechanisms swept over times ``grid`` (T,).

    ``pushes`` by joint are directions of gaps (:func:`push_directions`).
    """

    way = "swept all at once"

    def __init__(
        self, m: Model, columns: Sequence[Column], result: Measure | Callable[[Any], Any], grid: np.ndarray,
        pushes: dict[str, np.ndarray], poses: np.ndarray | None, threads: int | None,
    ) -> None:  # fmt: skip
        self._owner, self._result, self._threads = m.name, result, threads
        self._columns, self._pushes, self._poses = columns, pushes, poses
        self._m, self._of = _followed(m, result)
        self._ready, self._grid = prepare(self._m, float(grid[0]), float(grid[-1])), grid
        turned = sorted({name for kind, name, part in self._of.values() if part == "theta"})
        self._angles = turned if isinstance(result, Measure) else [name for name in m.bodies if name != "ground"]
        self._sweeps: DesignSweeps | None = None
        self._finer: DesignSweeps | None = None
        width = len(grid) * (2 * len(self._m.traces) + len(self._angles)) + self._ready.groups.number.size  # pyright: ignore[reportOptionalMemberAccess]
        self.at_once = max(64, NUMBERS_AT_ONCE // width)

    def __call__(self, x: np.ndarray) -> Answers:
        """The result of each row."""
        batch = self._batch(x)
        failures = Counter({DOUBTED: int(batch.doubted.sum()), OPEN: int((~batch.closes & ~batch.doubted).sum())})
        if isinstance(self._result, Measure):
            along = {name: self._along(batch, name) for name in self._result.quantities}
            values = measured(self._owner, self._result, batch.t, along)
        else:
            values = numbers_of_batch(self._owner, called(self._owner, self._result, batch), len(x))
        return Answers(np.where(batch.closes, values, np.nan), +failures)

    def _along(self, batch: Batch, name: str) -> np.ndarray:
        _, whole, part = self._of[name]
        return batch.angles[whole] if part == "theta" else batch.points[whole][..., "xy".index(part)]

    def _batch(self, x: np.ndarray) -> Batch:
        lengths, places = self._numbers(x)
        values, moved = parameters(self._m, self._ready.packed, lengths, places)
        if self._sweeps is None:
            self._sweeps = self._build_sweeps(moved)
        if not self._pushes:
            batch = self._sweeps(values, self._threads)
            settle(self._sweeps, lambda: self._with_finer_steps(moved), batch, values, self._threads)
            return batch
        first = values.shape[1] - 2 * len(places)
        pushes = []
        for k, column in enumerate(self._columns):
            if column.kind == "reaction":
                at = first + 2 * list(places).index(column.name)
                pushes += [Push(at + axis, x[:, k], self._pushes[column.name][:, axis]) for axis in (0, 1)]
        assert self._poses is not None
        return self._sweeps.pushed(values, pushes, self._poses, self._threads)

    def _with_finer_steps(self, moved: Sequence[Moved]) -> DesignSweeps:
        self._finer = self._finer or self._build_sweeps(moved, FINER)
        return self._finer

    def _build_sweeps(self, moved: Sequence[Moved], finer: int = 1) -> DesignSweeps:
        return DesignSweeps(self._m, self._ready, self._grid, moved, self._angles, finer)

    def _numbers(self, x: np.ndarray) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        """Return lengths and positions as ``batch`` takes them.

        A pin at the end of a bar goes with its length.
        """
        lengths = {
            column.name: column.nominal + x[:, k] for k, column in enumerate(self._columns) if column.kind == "length"
        }
        places: dict[str, np.ndarray] = {}
        for k, column in enumerate(self._columns):
            if column.kind == "length":
                continue
            if column.name not in places:
                marker = place_in(self._m, column.name, "x").marker
                assert marker is not None
                places[column.name] = np.tile([marker.x, marker.y], (len(x), 1))
                if marker.body.name in lengths and at_end(marker, marker.body.length):
                    places[column.name][:, 0] = lengths[marker.body.name]
            if column.kind != "reaction":
                places[column.name][:, "xy".index(column.key)] += x[:, k]
        return lengths, places


def _followed(m: Model, result: Any) -> tuple[Model, dict[str, tuple[str, str, str]]]:
    """Return a mechanism that traces all that the result reads, and the trace of each quantity.

    A quantity may also have a body; both have a component.
    """
    if not isinstance(result, Measure):
        return m, {}
    out, of = m, {}
    for name in result.quantities:
        kind, whole, part = placed(m, name)  # pyright: ignore[reportGeneralTypeIssues]
        if kind == "body" and part != "theta":
            out = copy.deepcopy(m) if out is m else out
            trace = f"origin of {whole}"
            out.traces[trace] = replace(out.bodies[whole].at(0.0, 0.0))
            whole = trace
        of[name] = kind, whole, part
    return out, of


def push_directions(sol: Any, names: Sequence[str]) -> dict[str, np.ndarray | None]:
    """Return by pin (T, 2) the displacement of the marker that ``batch`` places for a unit of the gap.

    It is in the frame of the marker's body. The centre of the second marker lies behind that of the first, against the
    force on the second body. None for a pin without force.
    """
    m = sol.mechanism
    forces = {name: sol.joint(name).reaction for name in m.joints}
    largest = max((float(np.abs(force).max(initial=0.0)) for force in forces.values()), default=0.0)
    out: dict[str, np.ndarray | None] = {}
    for name in names:
        force = forces[name]
        size = np.hypot(*force.T)
        if size.max(initial=0.0) <= NOTHING * largest or largest == 0.0:
            out[name] = None
            continue
        along = force / np.where(size > 0.0, size, 1.0)[:, None]
        side = placed_side(m, m.joints[name])
        marker, behind = getattr(m.joints[name], side), -along if side == "i" else along
        theta = np.zeros(len(sol.t)) if marker.body is m.ground else sol.body(marker.body.name).theta
        c, s = np.cos(theta), np.sin(theta)
        out[name] = np.column_stack([c * behind[:, 0] + s * behind[:, 1], c * behind[:, 1] - s * behind[:, 0]])
    return out


NOTHING = 1e-9
"""Part of the largest reaction that is rounding."""
