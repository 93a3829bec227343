"""A smooth mechanism in independent coordinates on both sides of a number: the arrays that its kernels read."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.packing import Packed
from mbsd.derivatives.numbers.near_numbers import Near, NearNumbers
from mbsd.derivatives.numbers.start_tangents import StartTangents
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variant, Variants, Variation, step_of
from mbsd.derivatives.smooth.held_motion import ForcesBeside
from mbsd.derivatives.smooth.smooth_motion import NotSmooth
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.independent.coordinates import choices
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.embedding import Embedded
from mbsd.kinematics.groups.carried import AVOID, SIGN
from mbsd.kinematics.groups.groups import KIND
from mbsd.kinematics.groups.tables import rows_of
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number


@dataclass
class Sides:
    """K values of a number around its own."""

    size: float
    """Size of the number, of which steps are parts."""
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

    @cached_property
    def arrays(self) -> list[Embedding]:
        """(K,) that kernels read. Raises NotSmooth where the groups are others."""
        return self.make()


class BothSides:
    """Sides of ``numbers`` of ``m``, made ``ready``, with ``arrays`` of one run of ``made``.

    ``variation`` makes the mechanism with other values of them; ``whole``: for more than how bodies move. Raises
    NotSmooth where the groups are others.
    """

    def __init__(
        self, m: Model, ready: PreparedDynamics, made: Embedded, arrays: Embedding, variation: Variation,
        numbers: Sequence[Number], whole: bool,
    ) -> None:  # fmt: skip
        self.ready, self.made, self.arrays, self.variation, self.numbers = ready, made, arrays, variation, numbers
        near = NearNumbers(variation, StartTangents(m, ready), arrays.loads, whole)
        self.near = [near.of(number) for number in numbers]
        """By number, how arrays change with it; None where they do not go on straight."""
        self.light = [p for p, near in enumerate(self.near) if near is not None and near.packed is None]
        """Numbers that change masses and forces alone."""
        self.every: dict[int, Sides] = {}
        """By number; those of light ones once their steps are set."""
        self._slopes: dict[int, np.ndarray] = {}
        """(g, 14) slopes of the numbers of the groups by a number that changes places, or (g, 21) of their rows."""
        self.set_steps({p: TINY for p in range(len(numbers)) if p not in self.light})
        self.sizes = [self.every[p].size if near is None else near.size for p, near in enumerate(self.near)]
        """Sizes of the numbers, of which steps are parts."""

    def begun(self, part: int) -> np.ndarray:
        """(P, 3 nb) q' at the start; v' as ``part`` 1."""
        return np.array([(self.every[p] if near is None else near).begun[part] for p, near in enumerate(self.near)])

    def set_steps(self, steps: Mapping[int, float]) -> None:
        """Take sides of some numbers that are so many of their sizes away. Raises NotSmooth likewise."""
        straight = {p: near for p, near in enumerate(self.near) if p in steps and near is not None}
        if straight:
            self.every.update(self._straight_sides(straight, [steps[p] for p in straight]))
        for p in steps.keys() - straight.keys():
            self.every[p] = self._packed(self.variation.of(self.numbers[p], SECOND, steps[p]))

    def _straight_sides(self, straight: Mapping[int, Near], steps: Sequence[float]) -> dict[int, Sides]:
        """Return sides of numbers on both sides of which all arrays go on straight."""
        system, com, every = self.ready.packed.system, self.ready.packed.com, list(straight.values())
        away = np.outer([step_of(step, near.size) for step, near in zip(steps, every, strict=True)], [-1.0, 1.0])
        far, weights = away[:, :, None], 0.5 / away
        mass = system.mass + far * np.array([near.mass for near in every])[:, None]
        moment = system.inertia + far * np.array([near.moment for near in every])[:, None]
        coms = com + far[..., None] * np.array([near.com for near in every])[:, None]
        rows = self._rows_beside({p: away[k] for k, p in enumerate(straight) if p not in self.light})
        return {
            p: Sides(
                near.size,
                away[k],
                weights[k],
                mass[k],
                moment[k],
                coms[k],
                {name: far[k] * slope for name, slope in near.traces.items()},
                near.begun,
                partial(self._straight, near, away[k].tolist(), rows.get(p)),
            )
            for k, (p, near) in enumerate(straight.items())
        }

    def _straight(self, near: Near, away: list[float], rows: np.ndarray | None) -> list[Embedding]:
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
        out: list[Embedding] = []
        for side, h in enumerate(away):
            own: dict[str, Any] = {name: getattr(arrays, name) + h * slope for name, slope in slopes.items()}
            if rows is not None:
                own["number"] = rows[side]
            if near.loads:
                parts = {name: getattr(arrays.loads, name) + h * slope for name, slope in near.loads.items()}
                own["loads"] = arrays.loads._replace(**parts)
            out.append(arrays._replace(**own))
        return out

    def _rows_beside(self, away: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
        """(2, g, 21) rows of the groups for changes ``away`` (2,) of numbers that change places.

        Numbers of groups are linear in places, rows that are made of them are not.
        """
        if not away:
            return {}
        own, row = self.made.plan.numbers(), self.arrays.number
        slopes = {p: self._slope_of_groups(p, own) for p in away}
        straight = [p for p, slope in slopes.items() if slope.shape == own.shape]
        out = {p: row + h[:, None, None] * slopes[p] for p, h in away.items() if p not in straight}
        numbers = np.array([own + away[p][:, None, None] * slopes[p] for p in straight]).reshape(-1, 2, *own.shape)
        rows = rows_of(self.arrays.group[:, KIND], numbers)
        rows[..., SIGN:] = row[:, SIGN:]
        return out | dict(zip(straight, rows, strict=True))

    def _slope_of_groups(self, p: int, own: np.ndarray) -> np.ndarray:
        near = self.near[p]
        if p not in self._slopes and near is not None and near.packed is not None:
            remade = self.made.plan.remade(near.packed)
            if remade is None:
                slope = (self._rows_found(near.packed) - self.arrays.number) / near.away
                slope[:, SIGN:] = 0.0
            else:
                slope = (remade - own) / near.away
            self._slopes[p] = slope
        return self._slopes[p]

    def _packed(self, variants: Variants) -> Sides:
        """Return sides that were packed each by itself. Raises NotSmooth likewise."""
        own = variants.variants
        systems = [variant.terms.packed.system for variant in own]
        moved: dict[str, np.ndarray] = {}
        for name, marker in self.variation.saved.traces.items():
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
