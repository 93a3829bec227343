"""A mechanism on both sides of a number, its arrays going on straight, where its start is known: nothing is packed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mbsd.derivatives.numbers.near_numbers import Near
from mbsd.derivatives.numbers.number_steps import step_of
from mbsd.derivatives.numbers.terms import Terms
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variant, Variants, Variation
from mbsd.equations.system import workspace
from mbsd.numbers.names import Number, with_value
from mbsd.numbers.placed import PLACES


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
