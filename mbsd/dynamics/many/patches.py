"""Numbers that vary, put straight into the block of a prepared run: nothing is prepared anew for a row.

Known are numbers of forces that are plain parameters of them or of their laws, restitution and friction of contacts,
masses and moments of inertia, poses and velocities at the start. What a row then differs by is found for all rows at
once. Some rows are prepared in full, too, and all numbers of their blocks compared: where any differs, all rows are
prepared one by one.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from mbsd.arrays.directory import directory, made_of_masses, numbers_of
from mbsd.base.arguments import SMALLEST
from mbsd.base.errors import MechanismError
from mbsd.dynamics.embedding.arrays import Embedding
from mbsd.dynamics.embedding.blocks.places import KEPT_Q, KEPT_SIZE
from mbsd.dynamics.many.base import Base
from mbsd.dynamics.many.contact_numbers import contact_columns
from mbsd.dynamics.many.designs import Designs
from mbsd.dynamics.many.law_numbers import law_columns
from mbsd.dynamics.many.starts import Starts, starts_of
from mbsd.dynamics.prepare.mass_ratio import USUAL
from mbsd.dynamics.prepare.pressed import presses
from mbsd.kinematics.groups.carrying.columns import BASE, INERTIA, MASS, THETA
from mbsd.model.body import rod_inertia
from mbsd.model.force import Force

ROUNDING = 1e-12
"""Part of a number by which it may differ from that of a row prepared in full."""
Column = tuple[int, np.ndarray]
"""Place in the block, and values (n,) of all rows."""


class NotPatched(Exception):
    """Why rows must be prepared one by one."""


class Patches:
    """Numbers of all rows of ``designs`` by their places in the block of ``base``. Raises NotPatched."""

    def __init__(self, designs: Designs, base: Base, starts: bool = True) -> None:
        self.designs, self.base, self.dyn, self.scratch = designs, base, base.arguments[0], base.arguments[1]
        self.ready = base.run.ready
        self.mass: np.ndarray | None = None
        self.inertia: np.ndarray | None = None
        columns: list[Column] = []
        m = designs.m
        if self.ready.packed.states:
            raise NotPatched("states of forces are found with the start")
        if presses(m):
            raise NotPatched("a journal starts pressed into its bearing")
        of_laws = law_columns(designs, base, designs.numbers)
        if of_laws is None:
            raise NotPatched(" and ".join(f"{each.key} of '{each.whole}'" for each in designs.numbers))
        columns += of_laws
        for name, values in designs.changes.items():
            if name in m.forces:
                columns += self._of_force(name, values)
            elif name in m.bodies and set(values) <= {"mass", "inertia"}:
                self._take_masses(name, values)
            elif name in m.contacts:
                of_contact = contact_columns(designs, base, name, values)
                if of_contact is None:
                    raise NotPatched(f"{', '.join(values)} of '{name}'")
                columns += of_contact
            else:
                raise NotPatched(f"{', '.join(values)} of '{name}'")
        if self.mass is not None:
            if designs.exact and self.ready.initial.v.any():
                raise NotPatched("speeds at the start are found with the masses")
            columns += self._of_masses()
        self.place = np.array([place for place, _ in columns], np.int64)
        self.columns = np.array([values for _, values in columns]).reshape(len(columns), designs.count)
        self.starts: Starts | None = None
        if starts and (designs.starts or designs.velocities):
            self.starts = starts_of(designs, base)
            self.place = np.concatenate([self.place, self._start_places()])

    def of_thread(self, base: Base) -> Patches:
        """The same for a block of another thread, which is laid out alike."""
        out = copy.copy(self)
        out.base, out.dyn, out.scratch, out.ready = base, base.arguments[0], base.arguments[1], base.run.ready
        out.starts = None if self.starts is None else starts_of(self.designs, base)
        return out

    def __call__(self, rows: range) -> tuple[np.ndarray, np.ndarray | None, list[str | None]]:
        """Values (R, k) of rows, their start poses (R, 3 nb) if these vary, and why a row has none."""
        at = slice(rows.start, rows.stop)
        own = self.columns[:, at].T
        if self.starts is None:
            return np.ascontiguousarray(own), None, [None] * len(rows)
        q, v, reasons = self.starts(rows)
        return np.concatenate([own, self._start_values(q, v)], axis=1), q, reasons

    # -- forces --------------------------------------------------------------------------------------------------

    def _of_force(self, name: str, values: dict[str, np.ndarray]) -> Iterator[Column]:
        loads = self.dyn.loads
        force, masses = self._plain(name, values), self.ready.packed.masses
        if force.kind.of_reactions or force.kind.oil or force.kind.chamber or "function" in force.params:
            raise NotPatched(f"force '{name}'")
        entries = directory(self.ready.packed)[name].entries(loads)
        places = [self.base.layout.place(array, *index) for array, index in entries]
        numbers = numbers_of(force, masses)
        if len(numbers) != len(places):
            raise NotPatched(f"{', '.join(values)} of '{name}'")
        varying = [k for k, value in enumerate(numbers) if isinstance(value, np.ndarray)]
        if self.designs.exact and varying:  # arrays may be rounded otherwise than single numbers
            rows = np.array([self._row_of_force(force, values, row) for row in range(self.designs.count)], float)
            yield from ((places[k], rows[:, k].copy()) for k in varying)
            return
        yield from ((places[k], numbers[k]) for k in varying)

    def _row_of_force(self, force: Force, values: dict[str, np.ndarray], row: int) -> list[Any]:
        params = {key: float(column[row]) for key, column in values.items()}
        own = replace(force, params={**force.params, **params})
        return numbers_of(own, self.ready.packed.masses)

    def _plain(self, name: str, values: dict[str, np.ndarray]) -> Force:
        """The force with arrays in place of numbers, if they are parameters that nothing else is made of."""
        params: dict[str, Any] = {}
        for key, column in values.items():
            if column.ndim > 1:
                raise NotPatched(f"{key} of '{name}'")
            for number in (float(column.min()), float(column.max())):
                work = self.designs.copied()
                before = dict(work.forces[name].params)
                try:
                    work.change(name, **{key: number})
                except MechanismError:
                    raise NotPatched(f"some {key} of '{name}' are refused") from None
                if presses(work):
                    raise NotPatched(f"some {key} of '{name}' start pressed into its bearing")
                after = work.forces[name].params
                changed = {other for other in {*before, *after} if not _same(before.get(other), after.get(other))}
                if not changed <= {key} or after.get(key) != number:
                    raise NotPatched(f"{key} of '{name}'")
            params[key] = np.ascontiguousarray(column)
        force = self.designs.m.forces[name]
        made = replace(force, params={**force.params, **params})
        try:
            numbers_of(made, self.ready.packed.masses)
        except Exception:
            raise NotPatched(f"{', '.join(values)} of '{name}'") from None
        return made

    # -- masses --------------------------------------------------------------------------------------------------

    def _take_masses(self, name: str, values: dict[str, np.ndarray]) -> None:
        packed, count, body = self.ready.packed, self.designs.count, self.designs.m.bodies[name]
        if self.mass is None:
            self.mass = np.repeat(packed.system.mass[None], count, axis=0)
            self.inertia = np.repeat(packed.system.inertia[None], count, axis=0)
        assert self.inertia is not None
        b = packed.body_names.index(name)
        if any((column < SMALLEST).any() or column.ndim > 1 for column in values.values()):
            raise NotPatched(f"some {' or '.join(values)} of '{name}' are not above zero, or too small")
        if "mass" in values:
            self.mass[:, b] = values["mass"]
            if "inertia" in body.derived:
                assert body.length is not None
                self.inertia[:, b] = rod_inertia(values["mass"], body.length)  # pyright: ignore[reportArgumentType]
        if "inertia" in values:
            self.inertia[:, b] = values["inertia"]

    def _of_masses(self) -> Iterator[Column]:
        assert self.mass is not None
        assert self.inertia is not None
        dyn, layout, dynamics = self.dyn, self.base.layout, self.ready.dynamics
        gravity = self.ready.packed.system.gravity
        whole = np.repeat(self.mass, 3, axis=1)
        whole[:, 2::3] = self.inertia
        self._refuse_light(whole, dynamics.per_size)
        changed = np.flatnonzero((self.mass != self.mass[:1]).any(axis=0) | (self.inertia != self.inertia[:1]).any(0)
                                 | (self.mass[0] != self.ready.packed.system.mass)
                                 | (self.inertia[0] != self.ready.packed.system.inertia))  # fmt: skip
        for b in changed.tolist():
            for c in range(3):
                at, value = 3 * b + c, whole[:, 3 * b + c].copy()
                yield layout.place(dyn.inertia, at), value
                yield layout.place(dyn.weight, at), value * (gravity[c] if c < 2 else 0.0)
                if not isinstance(dyn, Embedding):
                    yield layout.place(dyn.inverse, at), 1.0 / value
                    yield layout.place(dyn.metric, at), 1.0 / value
            if isinstance(dyn, Embedding):
                yield layout.place(self.scratch.body, b, MASS), self.mass[:, b].copy()
                yield layout.place(self.scratch.body, b, INERTIA), self.inertia[:, b].copy()
            else:
                yield layout.place(dyn.system.mass, b), self.mass[:, b].copy()
                yield layout.place(dyn.system.inertia, b), self.inertia[:, b].copy()

    def _refuse_light(self, whole: np.ndarray, per_size: np.ndarray) -> None:
        """Raise NotPatched where masses are so far apart, or zero, that equations are solved otherwise."""
        moving = whole[:, 3:] / np.where(per_size > 0.0, per_size, 1.0)[3:] ** 2
        if not (moving > 0.0).all() or (moving.max(axis=1) > USUAL * moving.min(axis=1)).any():
            raise NotPatched("masses that are zero or far apart")
        for name in made_of_masses(self.ready.packed):
            raise NotPatched(f"force '{name}' is made of masses")

    # -- starts --------------------------------------------------------------------------------------------------

    def _start_places(self) -> np.ndarray:
        state, layout, scratch = self.base.arguments[2], self.base.layout, self.scratch
        places = [layout.place(state.y, part, c) for part in range(2) for c in range(state.y.shape[1])]
        if isinstance(self.dyn, Embedding):
            bodies, count = len(scratch.base), state.y.shape[1] - 3
            places += [layout.place(scratch.base, b, THETA) for b in range(bodies)]
            places += [layout.place(scratch.coordinate, k, BASE) for k in range(count)]
            if self.dyn.block[KEPT_SIZE]:
                first = int(self.dyn.block[KEPT_Q])
                places += [layout.place(scratch.block_work, first + c) for c in range(3 * bodies)]
        return np.array(places, np.int64)

    def _start_values(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        if not isinstance(self.dyn, Embedding):
            return np.concatenate([q, v], axis=1)
        independent = self.base.run.independent
        assert independent is not None
        z = coordinates_along(self.base.run.coordinates, q, v)
        parts = [z[:, 0], z[:, 1], q[:, 2::3], z[:, 0, 3:]]
        if self.dyn.block[KEPT_SIZE]:
            parts.append(q)
        return np.concatenate(parts, axis=1)


def coordinates_along(coordinates: list[Any], q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(R, 2, 3 + f) independent coordinates and their rates at q, v (R, 3 nb)."""
    out = np.zeros((len(q), 2, 3 + len(coordinates)))
    for k, coordinate in enumerate(coordinates):
        if coordinate.slide is None:
            i, j = 3 * coordinate.body + 2, 3 * coordinate.other + 2
            out[:, 0, 3 + k], out[:, 1, 3 + k] = q[:, i] - q[:, j], v[:, i] - v[:, j]
        else:
            out[:, 0, 3 + k] = [coordinate.at(row) for row in q]
            out[:, 1, 3 + k] = [coordinate.rate(*row) for row in zip(q, v, strict=True)]
    return out


def _same(a: Any, b: Any) -> bool:
    try:
        return bool(a == b)
    except Exception:
        return a is b


def agrees(patches: Patches, row: int, fresh: np.ndarray, content_of: Callable[[], np.ndarray]) -> bool:
    """Whether the block of a row is the one that preparing it in full makes."""
    value, _, reasons = patches(range(row, row + 1))
    if reasons[0] is not None:
        return True
    mine, other = fresh.copy(), content_of()
    mine[patches.place] = value[0]
    for first, end in _overwritten(patches.base):
        mine[first:end] = other[first:end]
    rounding = 0.0 if patches.designs.exact else ROUNDING
    with np.errstate(invalid="ignore"):  # infinite bounds
        close = np.abs(mine - other) <= rounding * np.maximum(np.abs(other), 1.0)
    return bool((close | (np.isnan(mine) & np.isnan(other)) | (mine == other)).all())


def _overwritten(base: Base) -> list[tuple[int, int]]:
    """Where in the block what every evaluation overwrites stands, and what preparing has left of the last one.

    So does the lift of coordinates without inertia, of which any small one serves.
    """
    ws = getattr(base.arguments[1], "ws", None)
    parts = [base.arguments[0].loads.law]
    if ws is not None:
        parts += [part for name, part in zip(ws._fields, ws, strict=True) if name != "relative" and part.size]
    places = [(first, first + part.size) for part in parts for first in [base.layout.place(part)]]
    dyn = base.arguments[0]
    if not isinstance(dyn, Embedding):
        massless = [int(c) for c in np.flatnonzero(dyn.inertia == 0)]
        lifted = [base.layout.place(part, c) for part in (dyn.inverse, dyn.metric) for c in massless]
        places += [(first, first + 1) for first in lifted]
    return places
