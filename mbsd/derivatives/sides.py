"""A smooth mechanism in independent coordinates on both sides of a number: the arrays that its kernels read."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.packing import Packed
from mbsd.derivatives.forces_beside import ForcesBeside
from mbsd.derivatives.near_numbers import Near, NearNumbers
from mbsd.derivatives.smooth_motion import NotSmooth
from mbsd.derivatives.start_tangents import StartTangents
from mbsd.derivatives.variants import SECOND, TINY, Variant, Variants, Variation
from mbsd.dynamics.embedding.arrays import Embedding
from mbsd.dynamics.embedding.coordinates import choices
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.embed import Embedded
from mbsd.kinematics.groups.carrying.columns import AVOID, SIGN
from mbsd.kinematics.groups.groups import KIND
from mbsd.kinematics.groups.tables import rows_of
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.model.numbers import Number


@dataclass
class Sides:
    """K values of a number around its own."""

    size: float
    """What steps of the number are parts of."""
    away: np.ndarray
    """(K,) from its own, in its unit."""
    weights: np.ndarray
    """(K,) for a derivative: per its unit."""
    mass: np.ndarray
    """(K, nb) kg."""
    moment: np.ndarray
    """(K, nb) of inertia (kg m^2)."""
    com: np.ndarray
    """(K, nb, 2) in the author's frames (m)."""
    traces: dict[str, np.ndarray]
    """(K, 2) by how much traced points are elsewhere on their bodies (m)."""
    begun: tuple[np.ndarray, np.ndarray]
    """(3 nb,) q' and v' at the start."""
    make: Callable[[], list[Embedding]]
    near: Near | None = None
    """What they go on from, where that is masses and forces alone."""

    @cached_property
    def arrays(self) -> list[Embedding]:
        """(K,) that kernels read. Raises NotSmooth where the groups are others."""
        return self.make()


class BothSides:
    """Makes the sides of numbers of a mechanism made ``ready``, with ``arrays`` of one run of ``made``."""

    def __init__(self, ready: PreparedDynamics, made: Embedded, arrays: Embedding) -> None:
        self.ready, self.made, self.arrays = ready, made, arrays

    def of(self, m: Model, variation: Variation, numbers: Sequence[Number]) -> list[Sides]:
        """Those of all numbers of ``m``, which ``variation`` varies. Raises NotSmooth where the groups are others."""
        near = NearNumbers(variation, StartTangents(m, self.ready), self.arrays.loads)
        out: list[Sides] = []
        for number in numbers:
            own = near.of(number)
            if own is None:
                out.append(self.packed(variation.of(number, SECOND, TINY), m.traces))
            else:
                out.append(self.straight(own))
        return out

    def straight(self, near: Near) -> Sides:
        """Two, on which all arrays go on straight."""
        system = self.ready.packed.system
        away = np.array([-1.0, 1.0]) * TINY * near.size
        far = away[:, None]
        return Sides(
            near.size,
            away,
            0.5 / away,
            system.mass + far * near.mass,
            system.inertia + far * near.moment,
            self.ready.packed.com + far[:, None] * near.com,
            {name: far * slope for name, slope in near.traces.items()},
            near.begun,
            partial(self._straight, near, away.tolist()),
            near if near.packed is None else None,
        )

    def _straight(self, near: Near, away: list[float]) -> list[Embedding]:
        system, arrays = self.ready.packed.system, self.arrays
        slopes = {"inertia": near.inertia, "weight": near.weight(system.gravity, system.mass), "gravity": near.gravity}
        rows: Sequence[np.ndarray | None] = [None for _ in away]
        if near.packed is not None:
            rows = self._rows_beside(near.packed, near.away, away)
        out: list[Embedding] = []
        for h, row in zip(away, rows, strict=True):
            own: dict[str, Any] = {name: getattr(arrays, name) + h * slope for name, slope in slopes.items()}
            if row is not None:
                own["number"] = row
            parts = {name: getattr(arrays.loads, name) + h * slope for name, slope in near.loads.items()}
            out.append(arrays._replace(**own, loads=arrays.loads._replace(**parts)))
        return out

    def _rows_beside(self, packed: Packed, near: float, away: list[float]) -> list[np.ndarray]:
        """(g, 21) those of the groups for changes ``away``, from a mechanism whose number is larger by ``near``.

        Numbers of groups are linear in places, rows that are made of them are not.
        """
        plan, arrays = self.made.plan, self.arrays
        numbers = plan.remade(packed)
        if numbers is None:
            slope = (self._rows_found(packed) - arrays.number) / near
            slope[:, SIGN:] = 0.0
            return [arrays.number + h * slope for h in away]
        own = plan.numbers()
        slope = (numbers - own) / near
        rows = rows_of(arrays.group[:, KIND], own + np.array(away)[:, None, None] * slope)
        rows[..., SIGN:] = arrays.number[:, SIGN:]
        return list(rows)

    def packed(self, variants: Variants, traces: Mapping[str, Marker]) -> Sides:
        """Those that were packed each by itself, of a mechanism with ``traces``. Raises NotSmooth likewise."""
        own = variants.variants
        systems = [variant.terms.packed.system for variant in own]
        moved: dict[str, np.ndarray] = {}
        for name, marker in traces.items():
            places = [variant.traces[name] for variant in own]
            if any(place.angle != marker.angle for place in places):
                raise NotSmooth
            moved[name] = np.array([(place.x - marker.x, place.y - marker.y) for place in places])
        return Sides(
            variants.size,
            np.array([variant.offset for variant in own]) * variants.step,
            variants.weights / variants.step,
            np.array([system.mass for system in systems]),
            np.array([system.inertia for system in systems]),
            np.array([variant.terms.packed.com for variant in own]),
            moved,
            variants.begun(self.ready.initial.q),
            lambda: [self._arrays_of(variant) for variant in own],
        )

    def _rows(self, packed: Packed) -> np.ndarray:
        """(g, 21) those of the same groups in a mechanism with another number."""
        numbers = self.made.plan.remade(packed)
        return self._rows_found(packed) if numbers is None else rows_of(self.arrays.group[:, KIND], numbers)

    def _rows_found(self, packed: Packed) -> np.ndarray:
        """The same, where a group was not made of links: by a plan of its own. Raises NotSmooth where it is another."""
        choice = next(choices(packed, self.ready.initial.q, len(self.made.coordinates)), None)
        groups = None if choice is None else choice.plan.groups()
        if groups is None or groups.group.tobytes() != self.arrays.group.tobytes():
            raise NotSmooth
        return groups.row

    def _arrays_of(self, variant: Variant) -> Embedding:
        terms, arrays = variant.terms, self.arrays
        system = terms.packed.system
        own = {"inertia": terms.inertia, "weight": terms.weight, "numbers": system.numbers, "gravity": system.gravity}
        if terms.loads is not None and terms.laws is not None:
            own |= {"loads": terms.loads, "laws": terms.laws}
        elif any(a is not b for a, b in zip(terms.packed.motions, self.ready.packed.motions, strict=True)):
            own["laws"] = compiled_laws(terms.packed, self.ready.start, self.ready.end)  # of drivers alone
        if not variant.same_places:
            own["number"] = self._rows(terms.packed)
            own["number"][:, AVOID] = arrays.number[:, AVOID]
        return arrays._replace(**own)


def forces_beside(arrays: Embedding, gravity: np.ndarray, mass: np.ndarray, every: Sequence[Near]) -> ForcesBeside:
    """Numbers near those of ``arrays``, with gravity (2,) and masses (nb,)."""
    inertia, weight = np.zeros((2, len(every), 3 * len(mass)))
    which: list[int] = []
    for k, near in enumerate(every):
        inertia[k], weight[k] = near.inertia, near.weight(gravity, mass)
        if near.loads:
            which.append(k)
    loads, shape = arrays.loads, (len(which), 2)
    place, number = (np.broadcast_to(part, (*shape, *part.shape)).copy() for part in (loads.place, loads.number))
    per = np.zeros(len(which))
    for f, k in enumerate(which):
        h = TINY * every[k].size
        per[f] = 0.5 / h
        for part, name in ((place, "place"), (number, "number")):
            if name in every[k].loads:
                part[f, 0] -= h * every[k].loads[name]
                part[f, 1] += h * every[k].loads[name]
    return ForcesBeside(inertia, weight, np.array(which, np.int64), per, place, number)
