"""How arrays of a mechanism change with a number, by one mechanism whose number is a little larger.

    A(p + h) = A(p) + h A',   A' = (A(p + d) - A(p)) / d

Arrays are linear in most numbers; of others, as an inertia in a length, d leaves a ten-millionth of A'. So a number is
changed and packed once, and both sides of a difference, farther from the motion, go on straight.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import AssemblyError, ModelError
from mbsd.derivatives.numbers.start_tangents import StartTangents
from mbsd.derivatives.numbers.terms import Terms
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variant, Variants, Variation, step_of
from mbsd.equations.loads import Loads
from mbsd.equations.system import workspace
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, with_value
from mbsd.numbers.placed import (
    MASSES,
    NUMBERS_OF_LOADS,
    PLACES,
    TABLES_OF_LOADS,
    alike,
    laws_of,
    repacked,
    same_laws,
    unchanged,
)

NEAR = 1e-7
"""Part of its size by which a number is larger."""


@dataclass
class Near:
    """Arrays by a number: their slopes, in SI units by that of the number."""

    number: Number
    size: float
    """Size of the number, of which steps are parts."""
    mass: np.ndarray
    """(nb,)"""
    moment: np.ndarray
    gravity: np.ndarray
    com: np.ndarray
    """(nb, 2)"""
    loads: dict[str, np.ndarray]
    """Arrays of the loads that change."""
    traces: dict[str, np.ndarray]
    """(2,) places of traced points that change."""
    packed: Packed | None
    """The mechanism with the larger number, if it changes places."""
    away: float
    """By how much it is larger."""
    begun: tuple[np.ndarray, np.ndarray]
    """(3 nb,) q' and v' at the start."""
    replaced: bool
    """True if joints, forces or traced points are made anew for another value."""

    @property
    def inertia(self) -> np.ndarray:
        """(3 nb,) diagonal of M."""
        out = np.repeat(self.mass, 3)
        out[2::3] = self.moment
        return out

    def weight(self, gravity: np.ndarray, mass: np.ndarray) -> np.ndarray:
        """(3 nb,) M g, with gravity (2,) and masses (nb,)."""
        out = np.zeros((len(mass), 3))
        out[:, :2] = self.mass[:, None] * gravity + mass[:, None] * self.gravity
        return out.ravel()


class NearNumbers:
    """Numbers of the mechanism of a ``variation``, whose start moves as ``starts`` says."""

    def __init__(self, variation: Variation, starts: StartTangents, loads: Loads, whole: bool) -> None:
        """With ``whole`` it is found as well whether joints, forces or traced points are made anew."""
        self.variation, self.starts, self.loads, self.whole = variation, starts, loads, whole

    def of(self, number: Number) -> Near | None:
        """The slopes by a number; None where arrays do not go on straight, or what is given leaves the start open."""
        size = self.variation.size_of(number)
        step = step_of(NEAR, size)
        for away in (step, -step):
            try:
                return self._slopes(number, size, away)
            except (ModelError, AssemblyError):
                continue
        return None

    def _slopes(self, number: Number, size: float, away: float) -> Near | None:
        own, first = self.variation, self.variation.first
        value = number.value + away
        away = value - number.value  # as far as the number itself has so many digits
        with with_value(own.work, number, value, own.saved) as m:
            packed = repacked(m, first, own.saved) or pack(m)
            rows_kept = packed.first_row is first.first_row or packed.first_row.tolist() == first.first_row.tolist()
            if not rows_kept or packed.body_names != first.body_names:
                return None
            if not (same_laws(packed.motions, own.motions) and same_laws(laws_of(packed), own.laws)):
                return None
            com = _slope(packed.com, first.com, away)
            moved = not alike(packed.system, first.system, PLACES)
            if own.turns.any():
                offset = packed.system.angle_offset + own.turns
                packed = replace(packed, system=packed.system.changed(angle_offset=offset))
            masses = alike(packed.system, first.system, MASSES)
            begun = self.starts.of(m, packed, away, moved or bool(com.any()), not masses)
            traces = _slopes_of_traces(m, own, away)
            if begun is None or traces is None:
                return None
            loads = self._loads(m, packed, away)
            if loads is None:
                return None
            system, base = packed.system, first.system
            mass, moment, gravity = (
                _slope(getattr(system, name), getattr(base, name), away) for name in ("mass", "inertia", "gravity")
            )
            there, anew = packed if moved else None, not self._tables_kept(m)
            return Near(number, size, mass, moment, gravity, com, loads, traces, there, away, begun, anew)

    def _tables_kept(self, m: Model) -> bool:
        saved = self.variation.saved
        return not self.whole or (
            m is saved.m and all(unchanged(table, saved) for table in (m.joints, m.drivers, m.forces, m.traces))
        )

    def _loads(self, m: Model, packed: Packed, away: float) -> dict[str, np.ndarray] | None:
        """Slopes of numbers of forces; None where forces are made otherwise."""
        base, first = self.loads, self.variation.first
        if not packed.forces:
            return {}
        plain = not (len(base.interaction) or len(base.user) or len(base.friction))
        if plain and unchanged(m.forces, self.variation.saved):
            at, (own, before) = packed.force_markers.ravel(), (packed.system, first.system)
            pairs = (own.marker_arm, before.marker_arm), (own.marker_axis, before.marker_axis)
            if all(a is b or a[at].tobytes() == b[at].tobytes() for a, b in pairs):
                return {}
        loads = pack_loads(packed)
        if not alike(loads, base, TABLES_OF_LOADS):
            return None
        names = [name for name in NUMBERS_OF_LOADS if getattr(base, name).size]
        slopes = {name: _slope(getattr(loads, name), getattr(base, name), away) for name in names}
        return {name: slope for name, slope in slopes.items() if slope.any()}


def _slope(array: np.ndarray, base: np.ndarray, away: float) -> np.ndarray:
    return np.zeros_like(base) if array is base else (array - base) / away


def _slopes_of_traces(m: Model, own: Variation, away: float) -> dict[str, np.ndarray] | None:
    """(2,) of those that change; None where one turns."""
    out: dict[str, np.ndarray] = {}
    for name, before in own.saved.traces.items():
        marker: Marker = m.traces[name]
        if marker is before:
            continue
        if marker.angle != before.angle or marker.body.name != before.body.name:
            return None
        out[name] = np.array([marker.x - before.x, marker.y - before.y]) / away
    return out


def variants_beside(variation: Variation, numbers: Sequence[Number], known: Sequence[Near | None]) -> list[Variants]:
    """Return variants of all numbers; numbers that act nonlinearly are packed separately."""
    return [
        variation.of(number, SECOND, TINY, starts=False)
        if near is None
        else Variants(
            number,
            step_of(TINY, near.size),
            SECOND[1],
            [_variant(variation, near, side) for side in SECOND[0]],
            near.size,
        )
        for number, near in zip(numbers, known, strict=True)
    ]


def _variant(variation: Variation, near: Near, offset: float) -> Variant:
    base, h = variation.base, offset * step_of(TINY, near.size)
    packed, system = base.packed, base.packed.system
    slopes = {"mass": near.mass, "inertia": near.moment, "gravity": near.gravity, **_slopes_of_places(variation, near)}
    changes = {name: getattr(system, name) + h * slope for name, slope in slopes.items() if slope.any()}
    more: dict[str, Any] = {}
    traces = dict(variation.saved.traces)
    if near.replaced:
        with with_value(variation.work, near.number, near.number.value + h, variation.saved) as m:
            more = {"forces": list(m.forces.values()), "joints": [*m.joints.values(), *m.drivers.values()]}
            traces = dict(m.traces)
    system = system.changed(**changes)
    if near.packed is not None:
        more["ws"] = workspace(system, len(packed.ws.phi))  # it holds markers on ground
    made = replace(packed, system=system, com=packed.com + h * near.com, constant=None, **more)
    inertia = base.inertia + h * near.inertia
    weight = base.weight + h * near.weight(packed.system.gravity, packed.system.mass)
    loads = base.loads
    if loads is not None and near.loads:
        loads = loads._replace(**{name: getattr(loads, name) + h * slope for name, slope in near.loads.items()})
    terms = Terms(made, base.laws, loads, inertia, weight)
    same_places, same_masses = near.packed is None and not near.com.any(), not (near.mass.any() or near.moment.any())
    return Variant(offset, terms, traces, same_places, same_masses, not near.loads)


def _slopes_of_places(variation: Variation, near: Near) -> dict[str, np.ndarray]:
    """How arrays of markers, offsets and lengths change."""
    if near.packed is None:
        return {}
    own, first = near.packed.system, variation.first.system
    slopes = {name: (getattr(own, name) - getattr(first, name)) / near.away for name in PLACES}
    turns = variation.turns
    slopes["angle_offset"] = (own.angle_offset - (first.angle_offset + turns)) / near.away
    return slopes
