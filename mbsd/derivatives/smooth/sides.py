"""A smooth mechanism in independent coordinates on both sides of a number: the arrays that its kernels read."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.packing import Packed
from mbsd.derivatives.numbers.near_numbers import Near, NearNumbers
from mbsd.derivatives.numbers.number_steps import step_of
from mbsd.derivatives.numbers.start_tangents import StartTangents
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variant, Variants, Variation
from mbsd.derivatives.smooth.forces_beside import ForcesBeside
from mbsd.derivatives.smooth.smooth_motion import NotSmooth
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.independent.coordinates import choices
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.embedding import Embedded
from mbsd.kinematics.groups.carried import AVOID, SIGN
from mbsd.kinematics.groups.groups import KIND
from mbsd.kinematics.groups.tables import rows_of
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number


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
    """Makes the sides of numbers of a mechanism made ``ready``, with ``arrays`` of one run of ``made``.

    ``variation`` makes the mechanism with other values of them.
    """

    def __init__(self, ready: PreparedDynamics, made: Embedded, arrays: Embedding, variation: Variation) -> None:
        self.ready, self.made, self.arrays, self.variation = ready, made, arrays, variation
        self.numbers: Sequence[Number] = ()
        self.near: list[Near | None] = []
        """By number, how arrays change with it; None where they do not go on straight."""

    def of(self, m: Model, numbers: Sequence[Number], whole: bool) -> list[Sides]:
        """Return sides of all numbers of ``m``; ``whole``: for more than how bodies move.

        Raises NotSmooth where the groups are others.
        """
        near = NearNumbers(self.variation, StartTangents(m, self.ready), self.arrays.loads, whole)
        self.numbers, self.near = numbers, [near.of(number) for number in numbers]
        straight = iter(self.straight([own for own in self.near if own is not None]))
        return [
            next(straight) if own is not None else self.packed(self.variation.of(number, SECOND, TINY), m.traces)
            for number, own in zip(numbers, self.near, strict=True)
        ]

    def nearer(self, p: int, step: float, traces: Mapping[str, Marker]) -> Sides:
        """Return sides of number p that are ``step`` of its size away, less than usual. Raises NotSmooth likewise."""
        near = self.near[p]
        if near is not None:
            return self.straight([near], step)[0]
        return self.packed(self.variation.of(self.numbers[p], SECOND, step), traces)

    def straight(self, every: Sequence[Near], step: float = TINY) -> list[Sides]:
        """Return sides of numbers, ``step`` of their sizes away, on both of which all arrays go on straight."""
        if not every:
            return []
        system, com = self.ready.packed.system, self.ready.packed.com
        away = np.array([step_of(step, near.size) for near in every])[:, None] * np.array([-1.0, 1.0])
        far, weights = away[:, :, None], 0.5 / away
        mass = system.mass + far * np.array([near.mass for near in every])[:, None]
        moment = system.inertia + far * np.array([near.moment for near in every])[:, None]
        coms = com + far[..., None] * np.array([near.com for near in every])[:, None]
        moved = [p for p, near in enumerate(every) if near.packed is not None]
        rows = cache(lambda: dict(zip(moved, self._rows_beside([every[p] for p in moved], away[moved]), strict=True)))
        return [
            Sides(
                near.size,
                away[p],
                weights[p],
                mass[p],
                moment[p],
                coms[p],
                {name: far[p] * slope for name, slope in near.traces.items()},
                near.begun,
                partial(self._straight, near, away[p].tolist(), None if near.packed is None else partial(_at, rows, p)),
                near if near.packed is None else None,
            )
            for p, near in enumerate(every)
        ]

    def _straight(self, near: Near, away: list[float], rows: Callable[[], np.ndarray] | None) -> list[Embedding]:
        """Arrays for changes ``away`` of a number, with (2, g, 21) ``rows`` of the groups, if these change."""
        system, arrays = self.ready.packed.system, self.arrays
        slopes: dict[str, np.ndarray] = {}
        heavier, pulled = near.mass.any(), near.gravity.any()
        if heavier or near.moment.any():
            slopes["inertia"] = near.inertia
        if heavier or pulled:
            slopes["weight"] = near.weight(system.gravity, system.mass)
        if pulled:
            slopes["gravity"] = near.gravity
        number = None if rows is None else rows()
        out: list[Embedding] = []
        for side, h in enumerate(away):
            own: dict[str, Any] = {name: getattr(arrays, name) + h * slope for name, slope in slopes.items()}
            if number is not None:
                own["number"] = number[side]
            if near.loads:
                parts = {name: getattr(arrays.loads, name) + h * slope for name, slope in near.loads.items()}
                own["loads"] = arrays.loads._replace(**parts)
            out.append(arrays._replace(**own))
        return out

    def _rows_beside(self, every: Sequence[Near], away: np.ndarray) -> np.ndarray:
        """(n, 2, g, 21) those of the groups for changes ``away`` (n, 2) of numbers that change places.

        Numbers of groups are linear in places, rows that are made of them are not.
        """
        plan, arrays = self.made.plan, self.arrays
        own = plan.numbers()
        numbers = np.repeat(own[None], 2 * len(every), axis=0).reshape(len(every), 2, *own.shape)
        apart: dict[int, np.ndarray] = {}
        for k, near in enumerate(every):
            assert near.packed is not None
            remade = plan.remade(near.packed)
            if remade is None:
                slope = (self._rows_found(near.packed) - arrays.number) / near.away
                slope[:, SIGN:] = 0.0
                apart[k] = arrays.number + away[k, :, None, None] * slope
            else:
                numbers[k] += away[k, :, None, None] * ((remade - own) / near.away)
        rows = rows_of(arrays.group[:, KIND], numbers)
        rows[..., SIGN:] = arrays.number[:, SIGN:]
        for k, row in apart.items():
            rows[k] = row
        return rows

    def packed(self, variants: Variants, traces: Mapping[str, Marker]) -> Sides:
        """Return sides that were packed each by itself, of a mechanism with ``traces``. Raises NotSmooth likewise."""
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


def _at(rows: Callable[[], Mapping[int, np.ndarray]], p: int) -> np.ndarray:
    return rows()[p]


def forces_beside(arrays: Embedding, gravity: np.ndarray, mass: np.ndarray, every: Sequence[Near]) -> ForcesBeside:
    """Numbers near those of ``arrays``, with gravity (2,) and masses (nb,)."""
    by, moment, field = (np.array([getattr(near, name) for near in every]) for name in ("mass", "moment", "gravity"))
    inertia = np.stack([by, by, moment], axis=-1).reshape(len(every), -1)
    weight = np.zeros((len(every), len(mass), 3))
    weight[..., :2] = by[..., None] * gravity + mass[:, None] * field[:, None]
    weight = weight.reshape(len(every), -1)
    which = [k for k, near in enumerate(every) if near.loads]
    loads, shape = arrays.loads, (len(which), 2)
    place, number = (np.broadcast_to(part, (*shape, *part.shape)).copy() for part in (loads.place, loads.number))
    per = np.zeros(len(which))
    for f, k in enumerate(which):
        h = step_of(TINY, every[k].size)
        per[f] = 0.5 / h
        for part, name in ((place, "place"), (number, "number")):
            if name in every[k].loads:
                part[f, 0] -= h * every[k].loads[name]
                part[f, 1] += h * every[k].loads[name]
    return ForcesBeside(inertia, weight, np.array(which, np.int64), per, place, number)
