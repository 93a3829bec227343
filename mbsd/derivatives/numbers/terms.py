"""Residuals of the equations of a known motion, at other states and numbers than those that solve them.

    Phi,   J v - nu,   J a - gamma,   Q + F(lam) + m g - M a - J^T lam        a and lam held

They are zero along the motion. How they change with a number, and along a direction of the motion, is all that a
derivative needs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from mbsd.arrays.curve_branches import tabulate_along
from mbsd.arrays.friction_along import friction_along
from mbsd.arrays.inertias import inertia_of, weight_of
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import approached_along, loads_along, pack_loads
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import times_compact
from mbsd.dynamics.switches import standing
from mbsd.equations.laws import Laws
from mbsd.equations.loads import Loads
from mbsd.equations.products import leave
from mbsd.results.solution import Solution


@dataclass
class Along:
    """A motion at T times."""

    t: np.ndarray
    q: np.ndarray
    """(T, 3 nb), as v and a."""
    v: np.ndarray
    a: np.ndarray
    lam: np.ndarray
    """(T, m)"""
    states: np.ndarray | None = None
    """(T, s) of forces (SI)."""
    approached: np.ndarray | None = None
    """(T, n) of contacts that remember."""
    spread: np.ndarray | None = None
    """(T, 3 nb) load whose work the rows of redundant joints share; see tangents.py."""
    held: np.ndarray | None = None
    """(T, m) rows that hold, of a simulation."""
    pairs: np.ndarray | None = None
    """(T, o) pairs of outlines that rows kept, of a simulation."""

    def parts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """q, v and a."""
        return self.q, self.v, self.a

    def moved(self, q: np.ndarray, v: np.ndarray | None = None) -> Along:
        """The same but for positions and velocities."""
        return replace(self, q=q, v=self.v if v is None else v)

    def tiled(self, times: int) -> Along:
        """One after the other, so many times."""
        parts = {key: np.concatenate([part] * times) for key, part in self.__dict__.items() if part is not None}
        return replace(self, **parts)

    def beside(self, q: np.ndarray, v: np.ndarray, whole: bool) -> Along:
        """The motion at states q, v (D T, 3 nb), D times one after the other; a, lam and what holds if ``whole``."""
        times = len(q) // len(self.t)
        if whole:
            return self.tiled(times).moved(q, v)
        known = {"states": self.states, "approached": self.approached, "pairs": self.pairs}
        met = {key: np.concatenate([part] * times) for key, part in known.items() if part is not None}
        return Along(np.tile(self.t, times), q, v, self.a, self.lam, **met)

    def take(self, at: slice | np.ndarray) -> Along:
        """Some of its times."""
        return replace(self, **{key: part[at] for key, part in self.__dict__.items() if part is not None})


class Left(NamedTuple):
    """Residuals."""

    position: np.ndarray
    """(T, m) Phi."""
    velocity: np.ndarray
    """(T, m) J v - nu."""
    acceleration: np.ndarray
    """(T, m) J a - gamma."""
    load: np.ndarray
    """(T, 3 nb) Q + F + m g - M a - J^T lam; ground's mean nothing."""
    spread: np.ndarray | None
    """(T, m) J w of ``Along.spread``, where that is given."""

    def each(self, of: Callable[[np.ndarray], np.ndarray]) -> Left:
        """Return what ``of`` makes of each."""
        return Left(
            of(self.position), of(self.velocity), of(self.acceleration), of(self.load),
            None if self.spread is None else of(self.spread),
        )  # fmt: skip


class Change(NamedTuple):
    """How it changes along D directions of the motion."""

    velocity: np.ndarray
    """(D, T, m)"""
    acceleration: np.ndarray
    load: np.ndarray
    """(D, T, 3 nb)"""


def stacked(lefts: Sequence[Left], of: Callable[[list[np.ndarray]], np.ndarray]) -> Left:
    """Return what ``of`` makes of each part of all of them."""
    spread = [left.spread for left in lefts if left.spread is not None]
    return Left(
        of([left.position for left in lefts]), of([left.velocity for left in lefts]),
        of([left.acceleration for left in lefts]), of([left.load for left in lefts]),
        of(spread) if spread else None,
    )  # fmt: skip


@dataclass
class Terms:
    """The equations of a mechanism with one set of numbers."""

    packed: Packed
    laws: Laws | None
    loads: Loads | None
    inertia: np.ndarray
    weight: np.ndarray
    """(3 nb,)"""

    @property
    def rough(self) -> bool:
        """True if joints have friction."""
        return self.loads is not None and len(self.loads.friction) > 0

    def left(self, along: Along, q: np.ndarray | None = None, v: np.ndarray | None = None, pushed: bool = True) -> Left:
        """Along a motion; or at states q, v (D T, 3 nb) beside it, with a, lam and all else of the motion.

        Without ``pushed`` as if no force acted.
        """
        packed = self.packed
        beside = along if q is None or v is None else along.beside(q, v, self.rough or along.spread is not None)
        drives = packed.drives(along.t)
        phi, bend, compact = self.rows(beside, np.tile(drives, (len(beside.t) // len(along.t), 1, 1)))
        rate, load = np.empty_like(phi), self.forces(beside, compact) if pushed else np.zeros_like(beside.q)
        leave(
            packed.system.row_body, packed.driver_rows, self.inertia, self.weight, drives, compact,
            np.ascontiguousarray(beside.v), np.ascontiguousarray(along.a), np.ascontiguousarray(along.lam),
            rate, bend, load,
        )  # fmt: skip
        spread = None if beside.spread is None else times_compact(packed, compact, beside.spread)
        return Left(phi, rate, bend, load, spread)

    def forces(self, along: Along, compact: np.ndarray) -> np.ndarray:
        """(T, 3 nb) Q + F, where compact J (T, m, 6) is known."""
        load = np.ascontiguousarray(self.applied(along))
        if self.rough:
            load += self.friction(along, compact, along.lam)
        return load

    def rows(self, along: Along, drives: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Phi and gamma (T, m), compact J (T, m, 6)."""
        packed, count, rows = self.packed, len(along.t), len(self.packed.ws.phi)
        phi, gamma = np.zeros((2, count, rows))
        compact = np.empty((count, rows, 6))
        q, v = np.ascontiguousarray(along.q), np.ascontiguousarray(along.v)
        drives = packed.drives(along.t) if drives is None else drives
        tabulate_along(packed, drives, q, v, phi, compact, gamma, along.pairs)
        return phi, gamma, compact

    def applied(self, along: Along) -> np.ndarray:
        """(T, 3 nb) loads but weight and friction of joints."""
        if self.loads is None or self.laws is None:
            return np.zeros_like(along.q)
        q, v = np.ascontiguousarray(along.q), np.ascontiguousarray(along.v)
        return loads_along(self.packed, self.loads, self.laws, along.t, q, v, along.approached, along.states)

    def is_autonomous(self, along: Along) -> bool:
        """Return True if time itself changes nothing: no driver, and the same forces at all other times of a motion."""
        if self.packed.motions:
            return False
        if self.loads is None or not self.loads.total:
            return True
        here, count = self.applied(along), len(along.t)
        others = (along.t[::-1], np.roll(along.t, count // 3 + 1))
        return all(np.array_equal(here, self.applied(replace(along, t=t.copy()))) for t in others)

    def friction(self, along: Along, compact: np.ndarray, lam: np.ndarray) -> np.ndarray:
        """(T, 3 nb) friction of joints under multipliers lam (T, m)."""
        out = np.zeros_like(along.q)
        if self.loads is None or not self.rough:
            return out
        if along.held is None:
            return friction_along(self.packed, self.loads, along.q, along.v, compact, lam)
        for loads, at in standing(self.loads, along.held):
            out[at] = friction_along(self.packed, loads, along.q[at], along.v[at], compact[at], lam[at])
        return out

    def approaches(self, along: Along) -> np.ndarray | None:
        """(T, n) how fast contacts approached along a driven motion; None where none asks."""
        if self.loads is None or self.laws is None:
            return None
        return approached_along(self.packed, self.loads, self.laws, along.t, along.q, along.v)


def terms_of(
    packed: Packed, span: tuple[float, float], laws: Laws | None = None, loads: bool = True, known: Loads | None = None
) -> Terms:
    """The equations of a packed mechanism over ``span`` (s); ``laws`` and ``known`` loads: if they are known already.

    Without ``loads`` forces are left out.
    """
    inertia, weight = inertia_of(packed), weight_of(packed)
    if not packed.forces or not loads:
        return Terms(packed, None, None, inertia, weight)
    return Terms(packed, laws or compiled_laws(packed, *span), known or pack_loads(packed), inertia, weight)


def along_of(sol: Solution) -> Along:
    """A solution as arrays."""
    q, v, a = (np.ascontiguousarray(part.reshape(len(sol.t), -1)) for part in (sol.q, sol.v, sol.a))
    times = sol.t if sol.law_times is None else sol.law_times
    return Along(times, q, v, a, sol.lam, sol.states, sol.approached, pairs=sol.pairs)


def rows_of(sol: Solution, rows: np.ndarray) -> Solution:
    """Some rows of a solution."""
    keys = ("t", "q", "v", "a", "wrench", "lam", "drives", "work", "held", "law_times", "approached", "states")
    parts = {key: getattr(sol, key)[rows] for key in keys if getattr(sol, key) is not None}
    margin = sol.margin if callable(sol.margin) else sol.margin[rows]
    return replace(sol, margin=margin, between=None, **parts)
