"""Numbers that vary, put straight into the block of a prepared run: nothing is prepared anew for a row.

Known are numbers of forces that are plain parameters of them or of their laws, restitution and friction of contacts,
masses and moments of inertia, poses and velocities at the start. What a row then differs by is found for all rows at
once. Some rows are prepared in full, too, and all numbers of their blocks compared: where any differs, all rows are
prepared one by one.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mbsd.arrays.directory import directory, made_of_masses, numbers_of
from mbsd.base.arguments import SMALLEST
from mbsd.base.codes import CYCLOIDAL, HARMONIC, POLYNOMIAL
from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.single_run import Base
from mbsd.dynamics.batch.starts import Starts, starts_of
from mbsd.dynamics.events.arrays import ARGUMENTS, FRICTION_ARGUMENTS
from mbsd.dynamics.events.packing import entries_of
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.independent.block import KEPT_Q, KEPT_SIZE
from mbsd.dynamics.independent.coordinates import coordinates_along
from mbsd.dynamics.prepare.inertia import USUAL
from mbsd.dynamics.prepare.refusals import presses
from mbsd.kinematics.groups.carried import BASE, INERTIA, MASS, THETA
from mbsd.model.body import rod_inertia
from mbsd.model.laws import Motion
from mbsd.model.laws.numbers import Compiled
from mbsd.numbers.names import put_together

ROUNDING = 1e-12
"""Part of a number by which it may differ from that of a row prepared in full."""
FIXED = {POLYNOMIAL: slice(0), HARMONIC: slice(0), CYCLOIDAL: slice(1, 3)}
"""Numbers of a law, by its kind, that say where steps end: of a cycloidal one its duration and when it begins."""
Column = tuple[int, np.ndarray]
"""Place in the block, and values (n,) of all rows."""


class NotPatched(Exception):
    """Why rows must be prepared one by one."""


def _other(name: str, keys: Iterable[str]) -> NotPatched:
    return NotPatched(f"{', '.join(keys)} of '{name}'")


class Patches:
    """Numbers of all rows of ``designs`` by their places in the block of ``base``. Raises NotPatched."""

    def __init__(self, designs: Designs, base: Base, starts: bool = True) -> None:
        self.designs, self.base, self.ready = designs, base, base.run.ready
        self.mass: np.ndarray | None = None
        self.inertia: np.ndarray | None = None
        columns: list[Column] = []
        m = designs.m
        if self.ready.packed.states:
            raise NotPatched("states of forces are found with the start")
        if presses(m):
            raise NotPatched("a journal starts pressed into its bearing")
        columns += self._of_laws()
        for name, values in designs.changes.items():
            if name in m.forces:
                columns += self._of_force(name, values)
            elif name in m.bodies and set(values) <= {"mass", "inertia"}:
                self._take_masses(name, values)
            elif name in m.contacts and set(values) <= {*ARGUMENTS, *FRICTION_ARGUMENTS}:
                columns += self._of_contact(name, values)
            else:
                raise _other(name, values)
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
        out.base, out.ready = base, base.run.ready
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
        force, masses = self.designs.m.forces[name], self.ready.packed.masses
        for key, column in values.items():
            if column.ndim > 1:
                raise _other(name, [key])
            if self._followers(name, [{key: float(column.min())}, {key: float(column.max())}]):
                raise _other(name, [key])
        own = {key: np.ascontiguousarray(column) for key, column in values.items()}
        try:
            numbers = numbers_of(replace(force, params={**force.params, **own}), masses)
        except Exception:
            raise _other(name, values) from None
        if force.kind.of_reactions or force.kind.oil or force.kind.chamber or "function" in force.params:
            raise NotPatched(f"force '{name}'")
        entries = directory(self.ready.packed)[name].entries(self.base.parts.dyn.loads)
        places = [self.base.layout.place(array, *index) for array, index in entries]
        if len(numbers) != len(places):
            raise _other(name, values)
        varying = [k for k, value in enumerate(numbers) if isinstance(value, np.ndarray)]
        if self.designs.exact and varying:  # arrays may be rounded otherwise than single numbers
            rows = [{key: float(column[row]) for key, column in own.items()} for row in range(self.designs.count)]
            made = [numbers_of(replace(force, params={**force.params, **row}), masses) for row in rows]
            numbers = [np.array(column, float) for column in zip(*made, strict=True)]
        yield from ((places[k], numbers[k]) for k in varying)

    def _followers(self, name: str, rows: Sequence[dict[str, float]]) -> set[str]:
        """Return the parameters of a force or contact that change with those given; NotPatched if one is refused."""
        out = set[str]()
        for given in rows:
            work = self.designs.copied()
            table = work.forces if name in work.forces else work.contacts
            before = dict(table[name].params)
            try:
                work.change(name, **given)
            except MechanismError:
                raise NotPatched(f"some {', '.join(given)} of '{name}' are refused") from None
            if presses(work):
                raise NotPatched(f"some {', '.join(given)} of '{name}' start pressed into its bearing")
            after = table[name].params
            if any(after.get(key) != value for key, value in given.items()):
                raise _other(name, given)
            out |= {key for key in {*before, *after} - {*given} if not _same(before.get(key), after.get(key))}
        return out

    # -- laws of forces ------------------------------------------------------------------------------------------

    def _of_laws(self) -> Iterator[Column]:
        """Yield the columns of numbers of laws, on which neither the start nor the end of a step may depend."""
        designs, laws = self.designs, self.base.parts.dyn.laws
        refused = NotPatched(" and ".join(f"{each.key} of '{each.whole}'" for each, _ in designs.numbers))
        for each, number in designs.numbers:
            at, force = number.within, designs.m.forces.get(each.whole)
            if at is None or force is None or at.key not in force.laws or each.whole in designs.changes:
                raise refused
        for name in dict.fromkeys(each.whole for each, _ in designs.numbers):
            rows = self._laws_of(name)
            if not rows:
                raise refused
            for k, *compiled in zip(directory(self.ready.packed)[name].law, *rows, strict=True):
                begin, end = int(laws.first[k]), int(laws.first[k + 1])
                if any(kind != laws.kind[k] or len(numbers) != end - begin for kind, numbers in compiled):
                    raise refused
                numbers = np.array([numbers for _, numbers in compiled])
                fixed = FIXED.get(int(laws.kind[k]), slice(None))
                if (numbers[:, fixed] != laws.numbers[begin:end][fixed]).any():
                    raise refused
                for c in range(end - begin):
                    yield self.base.layout.place(laws.numbers, begin + c), numbers[:, c].copy()

    def _laws_of(self, name: str) -> list[list[Compiled]]:
        """Return all laws of a force as kernels evaluate them, for each row; none where a row is refused."""
        work, span = self.designs.copied(), (self.ready.start, self.ready.end)
        columns, numbers = zip(*(own for own in self.designs.numbers if own[0].whole == name), strict=True)
        before, out = work.forces[name].params, []
        for row in range(self.designs.count):
            try:
                put_together(work, numbers, [float(each.values[row]) for each in columns])
                laws = work.forces[name].laws.values()
                ready = [law.as_load(*span) if isinstance(law, Motion) else law for law in laws]
                out.append([law.compiled(*span) for law in ready])
            except MechanismError:
                return []
            if work.forces[name].params != before:
                return []
        return out

    # -- contacts ------------------------------------------------------------------------------------------------

    def _of_contact(self, name: str, values: dict[str, np.ndarray]) -> Iterator[Column]:
        """Yield the columns of restitution and friction."""
        if any(column.ndim > 1 for column in values.values()):
            raise _other(name, values)
        columns = {key: np.ascontiguousarray(column) for key, column in values.items()}
        extremes = {int(at) for column in columns.values() for at in (column.argmin(), column.argmax())}
        try:
            followers = self._followers(
                name, [{key: float(column[row]) for key, column in columns.items()} for row in extremes]
            )
        except NotPatched:
            raise _other(name, values) from None
        if "friction" in columns and followers == {"static_friction"}:  # it was not given
            columns["static_friction"] = columns["friction"]
            followers = set()
        none = dict.fromkeys(FRICTION_ARGUMENTS, 0.0)
        numbers: dict[str, Any] = {**none, **self.designs.m.contacts[name].params, **columns}
        friction, static = np.asarray(numbers["friction"]), np.asarray(numbers["static_friction"])
        if followers or (static < friction).any() or ("friction" in columns and not (friction > 0.0).all()):
            raise _other(name, values)
        contacts = getattr(self.base.parts, "contacts", None)
        if contacts is None:  # parts of a loop that meets none
            return
        entries = entries_of(self.ready, contacts, name)
        for key, column in columns.items():
            if key not in entries:
                raise _other(name, values)
            array, index = entries[key]
            yield self.base.layout.place(array, *index), column

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
        dyn, scratch, place = self.base.parts.dyn, self.base.parts.scratch, self.base.layout.place
        system, embedded = self.ready.packed.system, isinstance(self.base.parts.dyn, Embedding)
        whole, gravity = np.repeat(self.mass, 3, axis=1), [*system.gravity, 0.0]
        whole[:, 2::3] = self.inertia
        self._refuse_light(whole, self.ready.dynamics.per_size)
        changed = (self.mass != system.mass) | (self.inertia != system.inertia)
        for b in np.flatnonzero(changed.any(axis=0)).tolist():
            for at in range(3 * b, 3 * b + 3):
                value = whole[:, at].copy()
                yield place(dyn.inertia, at), value
                yield place(dyn.weight, at), value * gravity[at % 3]
                if not embedded:
                    yield from ((place(part, at), 1.0 / value) for part in (dyn.inverse, dyn.metric))
            if embedded:
                places = place(scratch.body, b, MASS), place(scratch.body, b, INERTIA)
            else:
                places = place(dyn.system.mass, b), place(dyn.system.inertia, b)
            yield from zip(places, (self.mass[:, b].copy(), self.inertia[:, b].copy()), strict=True)

    def _refuse_light(self, whole: np.ndarray, per_size: np.ndarray) -> None:
        """Raise NotPatched where masses are so far apart, or zero, that equations are solved otherwise."""
        moving = whole[:, 3:] / np.where(per_size > 0.0, per_size, 1.0)[3:] ** 2
        if not (moving > 0.0).all() or (moving.max(axis=1) > USUAL * moving.min(axis=1)).any():
            raise NotPatched("masses that are zero or far apart")
        for name in made_of_masses(self.ready.packed):
            raise NotPatched(f"force '{name}' is made of masses")

    # -- starts --------------------------------------------------------------------------------------------------

    def _start_places(self) -> np.ndarray:
        state, scratch, layout = self.base.parts.state, self.base.parts.scratch, self.base.layout
        places = [layout.place(state.y, part, c) for part in range(2) for c in range(state.y.shape[1])]
        if isinstance(self.base.parts.dyn, Embedding):
            bodies, count = len(scratch.base), state.y.shape[1] - 3
            places += [layout.place(scratch.base, b, THETA) for b in range(bodies)]
            places += [layout.place(scratch.coordinate, k, BASE) for k in range(count)]
            if self.base.parts.dyn.block[KEPT_SIZE]:
                first = int(self.base.parts.dyn.block[KEPT_Q])
                places += [layout.place(scratch.block_work, first + c) for c in range(3 * bodies)]
        return np.array(places, np.int64)

    def _start_values(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        if not isinstance(self.base.parts.dyn, Embedding):
            return np.concatenate([q, v], axis=1)
        independent = self.base.run.independent
        assert independent is not None
        z = coordinates_along(self.base.run.coordinates, q, v)
        parts = [z[:, 0], z[:, 1], q[:, 2::3], z[:, 0, 3:]]
        if self.base.parts.dyn.block[KEPT_SIZE]:
            parts.append(q)
        return np.concatenate(parts, axis=1)


def _same(a: Any, b: Any) -> bool:
    try:
        return np.array_equal(a, b) if isinstance(a, np.ndarray) else bool(a == b)
    except Exception:
        return a is b


def agrees(patches: Patches, row: int, fresh: np.ndarray, content_of: Callable[[], np.ndarray]) -> bool:
    """Return True if the block of a row is the one that preparing it in full makes."""
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
    dyn, ws = base.parts.dyn, getattr(base.parts.scratch, "ws", None)
    parts = [dyn.loads.law]
    if ws is not None:
        parts += [part for name, part in zip(ws._fields, ws, strict=True) if name != "relative" and part.size]
    places = [(first, first + part.size) for part in parts for first in [base.layout.place(part)]]
    if not isinstance(dyn, Embedding):
        massless = [int(c) for c in np.flatnonzero(dyn.inertia == 0)]
        lifted = [base.layout.place(part, c) for part in (dyn.inverse, dyn.metric) for c in massless]
        places += [(first, first + 1) for first in lifted]
    return places
