"""Paths of many designs of a mechanism, all at once in closed form where possible, and tangents.

A design is a vector of the numbers that vary. It is either the mechanism itself with other lengths and places, or what
a function of the author builds from them; the latter is solved with the others as long as only places of markers, of
the traced point and lengths of rods differ. Other designs are swept one by one; how the path of one of them changes
with its numbers follows from the differentiated closure, without another sweep:

    J q' = -dPhi/dp;   the point and the angles follow from q'
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import MechanismError
from mbsd.derivatives.driven.tangents import Inverse
from mbsd.derivatives.numbers.terms import Along, terms_of
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variation
from mbsd.kinematics.batch import parameters
from mbsd.kinematics.design_sweeps import DesignSweeps, Moved, in_closed_form
from mbsd.kinematics.march import kinematics_at
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.prepared import Prepared, prepare
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, changed, numbers_named
from mbsd.synthesis.conditions import Pin, four_bar, grashof_excess, pins, transmission_angles
from mbsd.synthesis.variables import Varied, built, numbers_of_build

if TYPE_CHECKING:
    from mbsd.synthesis.variables import Varied, numbers_of_build


Build = Callable[..., Model]
KEPT = 100
"""Designs whose poses are kept for their tangents."""


@dataclass(frozen=True, eq=False)
class Paths:
    """Paths of n designs."""

    path: np.ndarray
    """(n, T, 2) of the traced point (m); NaN where a design does not close."""
    closes: np.ndarray
    """(n,)"""
    transmission: np.ndarray
    """(n,) least transmission angle (rad); pi/2 where there is no pin that has one."""
    excess: np.ndarray
    """(n,) by how much Grashof's inequality is missed, relative to the sum of the lengths; 0 where not asked for."""

    def parts(self) -> tuple[np.ndarray, ...]:
        """Return all four arrays."""
        return self.path, self.closes, self.transmission, self.excess


class Designs:
    """Vectors in, paths out, on a coarse grid of times for the search and a fine one (T,) for the fit."""

    def __init__(
        self, m: Model, varied: Varied, build: Build | None, trace: str, grids: dict[bool, np.ndarray], grashof: bool
    ) -> None:
        self.m, self.varied, self.build, self.trace, self.grids = m, varied, build, trace, grids
        self.evaluations = 0
        grid = grids[True]
        self.ready = prepare(m, float(grid[0]), float(grid[-1]))
        packed = self.ready.packed
        self.pins: list[Pin] = pins(m, packed)
        self.links = four_bar(m, packed) if grashof else []
        self.turned = list(dict.fromkeys(body for pin in self.pins for body in pin.bodies))
        self._used = np.zeros(0, bool)
        """Numbers that a function of the author has moved so far, of those it may move."""
        middle = (varied.low + varied.high) / 2
        self.at_once = in_closed_form(self.ready)
        if build is not None:
            self.at_once = self.at_once and all(self._only_places(x) for x in (varied.low, middle, varied.high))
        self._sweeps: dict[bool, DesignSweeps] = {}
        self._solved: dict[tuple[bytes, int], tuple[Model, Prepared, np.ndarray]] = {}

    def __call__(self, x: np.ndarray, fine: bool = False, threads: int | None = None) -> Paths:
        """Return paths of designs x (n, k)."""
        self.evaluations += len(x)
        if not self.at_once:
            return self._judged(x, *self._one_by_one(x, self.grids[fine]))
        values, moved = self.changes(x)
        if fine not in self._sweeps:
            self._sweeps[fine] = DesignSweeps(self.m, self.ready, self.grids[fine], moved, self.turned)
        swept = self._sweeps[fine](values, threads)
        return self._judged(x, swept.points[self.trace], swept.angles, swept.closes)

    def neighbours(self, x: np.ndarray, steps: np.ndarray, fine: bool) -> Paths:
        """Return paths (n k) of designs x (n, k) of which one number after the other goes a step (n, k) on.

        They go along the exact tangents of the paths of x: nothing is swept but x.
        """
        n, k = x.shape
        path, angles, closes = self._one_by_one(x, self.grids[fine])
        paths = np.repeat(path, k, axis=0)
        turned = {body: np.repeat(rows, k, axis=0) for body, rows in angles.items()}
        closes = np.repeat(closes, k)
        for row, values in enumerate(x):
            if not closes[row * k]:
                continue
            try:
                along, turns = tangents_of_path(self, values, self.grids[fine])
            except MechanismError:
                closes[row * k : (row + 1) * k] = False
                continue
            at = slice(row * k, (row + 1) * k)
            paths[at] += along * steps[row, :, None, None]
            for body, rows in turned.items():
                rows[at] += turns[body] * steps[row, :, None]
        return self._judged((x[:, None] + steps[:, :, None] * np.eye(k)).reshape(n * k, k), paths, turned, closes)

    def _judged(self, x: np.ndarray, path: np.ndarray, angles: dict[str, np.ndarray], closes: np.ndarray) -> Paths:
        """Return paths of designs x (n, k), and how they meet the conditions."""
        values, moved = self.changes(x) if self.pins or self.links else (np.zeros((len(x), 0)), [])
        arms = np.tile(self.ready.packed.system.marker_arm, (len(x), 1, 1))
        for column, change in enumerate(moved):
            for number, axis in change.markers:
                arms[:, number, axis] += values[:, column]
        transmission = np.full(len(x), np.pi / 2)
        for pin in self.pins:
            first, second = (angles[body] for body in pin.bodies)
            at_pin = transmission_angles(pin, arms, first, second).min(axis=1)
            transmission = np.fmin(transmission, at_pin)
        excess = np.zeros(len(x))
        if self.links:
            lengths = np.stack([np.hypot(*(arms[:, a] - arms[:, b]).T) for a, b in self.links], axis=1)
            excess = np.maximum(grashof_excess(lengths), 0.0)
        return Paths(path, closes, transmission, excess)

    def model(self, x: np.ndarray) -> Model:
        """Return the mechanism of one design x (k,). Raises what the author's function raises."""
        values = self.varied.values(x)
        if self.build is None:
            return changed(self.m, values)
        return built(f"{self.m.name}: fit_path", self.build, values)

    def numbers(self, apart: np.ndarray) -> list[Number]:
        """Return the numbers that vary, in the middle of their bounds, which are ``apart`` (k,)."""
        out, given = [], self.varied
        for name, part, single in given.columns():
            for k in range(part.start, part.stop):
                middle = 0.5 * float(given.low[k] + given.high[k])
                if self.build is not None:
                    out.append(Number(name, middle, _unmoved, reach=float(apart[k])))
                else:
                    last = "length" if single else "xy"[k - part.start]
                    out.append(Number(f"{name}.{last}", middle, _unmoved, is_place=not single))
        return out

    def changes(self, x: np.ndarray) -> tuple[np.ndarray, list[Moved]]:
        """Return (n, p) differences from the mechanism itself, and what each moves."""
        packed = self.ready.packed
        if self.build is not None:
            rows = [self._places(self.model(values)) for values in x]
            moved = [Moved([(number, axis)]) for number in range(2 * len(packed.joints)) for axis in (0, 1)]
            moved += [Moved(trace=(k, axis)) for k in range(len(self.m.traces)) for axis in (0, 1)]
            moved += [Moved(rod=k) for k in range(len(packed.system.distance_length))]
            differences = np.array(rows) - self._places(self.m)
            used = differences.any(axis=0)
            if not len(self._used) or (used & ~self._used).any():
                self._used, self._sweeps = used | (self._used if len(self._used) else False), {}
            return differences[:, self._used], [move for move, some in zip(moved, self._used, strict=True) if some]
        lengths, places = {}, {}
        for name, part, single in self.varied.columns():
            if single:
                lengths[name] = x[:, part][:, 0]
            else:
                places[name] = x[:, part]
        return parameters(self.m, packed, lengths, places)

    def _places(self, m: Model) -> np.ndarray:
        """Return places of the markers of all joints and traces, and lengths of rods, as one vector (p,)."""
        joints = [*m.joints.values(), *m.drivers.values()]
        markers = [marker for joint in joints for marker in (joint.i, joint.j)]
        rods = [
            joint.params.get("length", 0.0)
            for joint in joints
            for constraint in joint.kind.constraints
            if constraint == "distance"
        ]
        places = [number for marker in (*markers, *m.traces.values()) for number in (marker.x, marker.y)]
        return np.array([*places, *rods])

    def _only_places(self, x: np.ndarray) -> bool:
        """Return True if the design x (k,) is the mechanism itself but for places and rods."""
        own, other = self.ready.packed, pack(self.model(x))
        other.settle_laws(float(self.grids[True][0]), float(self.grids[True][-1]))
        if list(own.body_names) != list(other.body_names):
            return False
        return _fixed_numbers(own, self.grids[True]) == _fixed_numbers(other, self.grids[True])

    def solved(self, x: np.ndarray, grid: np.ndarray) -> tuple[Model, Prepared, np.ndarray]:
        """Return the mechanism of one design x (k,), prepared, and its poses (T, nb, 3).

        The last ones are kept.
        """
        key = x.tobytes(), len(grid)
        if key not in self._solved:
            m = self.model(x)
            ready = prepare(m, float(grid[0]), float(grid[-1]))
            while len(self._solved) >= KEPT:
                del self._solved[next(iter(self._solved))]
            self._solved[key] = m, ready, kinematics_at(ready, grid)[0]
        return self._solved[key]

    def _one_by_one(self, x: np.ndarray, grid: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
        path = np.full((len(x), len(grid), 2), np.nan)
        angles = {body: np.full((len(x), len(grid)), np.nan) for body in self.turned}
        for k, values in enumerate(x):
            try:
                m, ready, q = self.solved(values, grid)
            except MechanismError:
                continue
            path[k] = path_of(ready.packed, m.traces[self.trace], q)
            for name, rows in angles.items():
                rows[k] = q[:, ready.packed.body_names.index(name), 2]
        return path, angles, np.isfinite(path).all(axis=(1, 2))


def _unmoved(m: Model, value: float) -> None:
    """Leave the model; designs are moved as vectors."""


def _fixed_numbers(packed: Packed, grid: np.ndarray) -> tuple[bytes, ...]:
    """Return all of a mechanism but places of markers, lengths of rods, masses and forces."""
    system = packed.system
    axes = system.marker_axis[: 2 * len(packed.joints)]
    kept = (axes, system.angle_offset, system.special, system.numbers, system.point, system.angle, system.slot)
    tables = (*kept, system.along, system.distance, packed.markers, system.marker_body[: len(axes)])
    return (*(np.ascontiguousarray(part).tobytes() for part in tables), packed.drives(grid).tobytes())


def path_of(packed: Packed, marker: Marker, q: np.ndarray) -> np.ndarray:
    """Return (T, 2) of a point at poses q (T, nb, 3)."""
    body = packed.body_names.index(marker.body.name)
    x0, y0 = np.array([marker.x, marker.y]) - packed.com[body]
    c, s = np.cos(q[:, body, 2]), np.sin(q[:, body, 2])
    return q[:, body, :2] + np.column_stack([c * x0 - s * y0, s * x0 + c * y0])


def tangents_of_path(designs: Designs, x: np.ndarray, grid: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return derivatives by the numbers of a design x (k,): of its point and of angles.

    The point's are (k, T, 2), those of angles (k, T) by body.
    """
    m, ready, q = designs.solved(x, grid)
    packed, span = ready.packed, (float(grid[0]), float(grid[-1]))
    terms = terms_of(packed, span, loads=False)
    flat = np.ascontiguousarray(q.reshape(len(grid), -1))
    still = np.zeros_like(flat)
    along = Along(grid, flat, still, still, np.zeros((len(grid), len(packed.ws.phi))))
    inverse = Inverse(terms, along, bool(ready.mobility.redundant_rows))
    variation = Variation(m, terms, span, lambda m, packed: assemble(m, packed, span[0]), loads=False)
    paths = np.zeros((len(x), len(grid), 2))
    angles = {body: np.zeros((len(x), len(grid))) for body in designs.turned}
    for k, number in enumerate(_numbers(designs, m, x)):
        variants = variation.of(number, SECOND, TINY)
        slope = inverse.solved(-variants.slope(lambda variant: variant.terms.rows(along)[0]), number.name, 1e-6)
        for weight, variant in zip(variants.weights, variants.variants, strict=True):
            moved = (flat + variant.offset * variants.step * slope).reshape(q.shape)
            paths[k] += weight / variants.step * path_of(variant.terms.packed, variant.traces[designs.trace], moved)
        for body, rows in angles.items():
            rows[k] = slope[:, 3 * packed.body_names.index(body) + 2]
    return paths, angles


def _numbers(designs: Designs, m: Model, x: np.ndarray) -> list[Number]:
    """Return the numbers of a design as those of its mechanism, or of the author's function."""
    varied = designs.varied
    if designs.build is None:
        names = []
        for name, _, single in varied.columns():
            names += [name] if single else [f"{name}.x", f"{name}.y"]
        return numbers_named(m, names)
    names = [f"{name} {k}" for name, part, _ in varied.columns() for k in range(part.start, part.stop)]
    return numbers_of_build(names, x, varied.high - varied.low, designs.model)
