"""A mechanism with other values of a number, packed beside the one that moves: nothing is solved for them.

A derivative by a number at a held state is a difference between these packings. Their steps are so short that what is
left out is lost in rounding, and where a number cannot go one way (a mass below zero) all of them go the other.

How far a number is moved for a derivative: a part of what its mechanism notices, whatever its own value is.

    places, coordinates                  the size of the mechanism
    angles                               1 rad
    lengths                              themselves, from a hundredth of the size to the size
    components of a vector               the vector
    masses, moments of inertia           themselves, or those of the heaviest body where they are next to nothing
    numbers of a law                     what changes the law by as much as it is over the motion, or by a size or 1 rad
    arguments of the author's function   themselves, from a hundredth of their bounds to their bounds
    others                               themselves, or 1 SI unit where they are zero

So a place of 1e-17 m has the step of one of 0.1 m, and so has one at 1 km. Steps are powers of two: what a number is
moved by is then what its difference is divided by, also far from zero.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import AssemblyError, ModelError
from mbsd.derivatives.numbers.terms import Terms, terms_of
from mbsd.model.event import Event
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, law_with, with_value, with_values
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
from mbsd.numbers.saved import SavedModel

LEAST = 1e-2
"""Least size of a length, as part of the mechanism's, and of an argument, as part of its bounds."""
NOTHING = 1e-12
"""Numbers below this (SI), masses below this part of the largest, count as zero."""
LENGTHS = ("length", "free_length", "radius", "radius_i", "radius_j")
ANGLES = ("angle", "free_angle", "direction")
LIMITS = ("at", "lower", "upper")
"""Lengths or angles."""
LOOKS = 65
"""Times at which a law is looked at."""
TRIAL = 1e-6
"""Part of a law's number, or of 1, that tells how the law changes."""
STEP, TINY = 1e-4, 1e-5
"""Steps of a number, as parts of its size: of fourth and of second order."""
FAR, ALLOWED = 1e-5, 4.0
"""A variant's motion is this far from the motion itself, in sizes and rad, where its usual step takes it farther than
so many times this: near a toggle, and after long, a small change of a number is a large one of the motion."""
SHORTER = 2.0**-8
"""Part of a step that is tried where a mechanism refuses so large a one."""
KINKED = 1e-2
"""Part of these steps where contacts yield by less than they move them."""
FOURTH = (np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0]) / 12)
"""Offsets and weights of the central difference of fourth order."""
SECOND = (np.array([-1.0, 1.0]), np.array([-0.5, 0.5]))
AHEAD = (np.arange(5.0), np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12)
"""The same to one side."""


def step_of(part: float, size: float) -> float:
    """The power of two next below this ``part`` of the ``size`` of a number: what it is changed by."""
    return 2.0 ** math.floor(math.log2(part * size))


def size_of(number: Number, m: Model, packed: Packed, span: tuple[float, float]) -> float:
    """Return the size of a number of ``m``, which is ``packed``, along a motion over ``span`` (s)."""
    own, last = abs(number.value), number.name.rpartition(".")[2]
    if number.reach:
        return float(np.clip(own, LEAST * number.reach, number.reach))
    if last in ANGLES:
        return 1.0
    if number.is_place:
        return packed.size
    if last in LIMITS:
        return min(packed.size, 1.0)
    if last in LENGTHS or (number.within is not None and number.within.key in LENGTHS):
        return float(np.clip(own, LEAST * packed.size, packed.size))
    if last in ("mass", "inertia"):
        heaviest = float(packed.system.mass.max(initial=0.0)) or 1.0
        largest = heaviest if last == "mass" else heaviest * packed.size**2
        return own if own > NOTHING * largest else largest
    own = max(own, number.vector)
    of_law = _size_in_law(number, m, packed, span)
    if of_law:
        return of_law
    return own if own > NOTHING else 1.0


def _size_in_law(number: Number, m: Model, packed: Packed, span: tuple[float, float]) -> float:
    """The size of a number of a law; 0 of any other, and of one that changes nothing."""
    law = law_with(m, number)
    if law is None:
        return 0.0
    first, last = span
    times = np.linspace(first, last if last > first else first + 1.0, LOOKS)
    away = TRIAL * (abs(number.value) or 1.0)
    values: list[Any] = []
    for value in (number.value - away, number.value, number.value + away):
        try:
            values.append(law(value)(times)[:, 0])
        except (ModelError, ArithmeticError, ValueError):
            return 0.0
    before, now, after = values
    change = float(np.abs(after - before).max()) / (2.0 * away)
    unit, largest = _unit(number, m, packed), float(np.abs(now).max())
    unit = min(unit, largest) if unit and largest else unit or largest
    return unit / change if change > 0.0 and unit > 0.0 else 0.0


def _unit(number: Number, m: Model, packed: Packed) -> float:
    """Return the usual size of the law of a driver, a length or an angle; 0 for a law of a force."""
    driver = None if number.within is None else m.drivers.get(number.within.whole)
    if driver is None:
        return 0.0
    return 1.0 if driver.kind.angular else packed.size


@dataclass
class Variant:
    """One number at one other value."""

    offset: float
    """In steps of the number."""
    terms: Terms
    traces: dict[str, Any]
    same_places: bool
    """True if all places, lengths, angles and laws of drivers are those of the motion."""
    same_masses: bool
    same_loads: bool
    """True if all loads have the numbers that they have in the motion."""
    start: Any = None
    """q, v (3 nb,) at the start, where that changes."""
    events: Mapping[str, Event] = field(default_factory=dict)
    """Events of the user, whose markers follow the ends of bars."""


@dataclass
class Variants:
    """All that a number was tried at."""

    number: Number
    step: float
    weights: np.ndarray
    """(k,) of the variants, for a derivative by the number: / step."""
    variants: list[Variant]
    size: float
    """Size of the number, of which the step is a part."""

    def slope(self, of: Callable[[Variant], np.ndarray]) -> np.ndarray:
        """The derivative by the number of what ``of`` gives of a variant."""
        return np.sum([w * of(v) for w, v in zip(self.weights, self.variants, strict=True)], axis=0) / self.step

    def begun(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """q' and v' at the start q (3 nb,)."""
        if any(variant.start is None for variant in self.variants):
            return np.zeros_like(q), np.zeros_like(q)
        return self.slope(lambda variant: variant.start[0]), self.slope(lambda variant: variant.start[1])


def models_of(m: Model, number: Number, variants: Variants) -> list[Callable[[], Model]]:
    """Return the function that makes mechanisms with the values of a number that variants have."""
    values = [number.value + variant.offset * variants.step for variant in variants.variants]
    if number.built is not None:
        return [partial(number.built, value) for value in values]
    return [partial(with_values, m, [number], [value]) for value in values]


Close = Callable[[Model, Packed], Any]


class Variation:
    """Makes variants of a mechanism ``m`` whose motion is that of ``base``.

    ``close`` closes the start of a variant, where constants follow from it, or with ``starts`` what moves from there.
    Without ``loads`` forces are left out.
    """

    def __init__(
        self, m: Model, base: Terms, span: tuple[float, float], close: Close, contacts: list[Joint] | None = None,
        starts: bool = False, loads: bool = True,
    ) -> None:  # fmt: skip
        self.work = copy.deepcopy(m)
        self.base, self.span, self.close, self.contacts, self.starts = base, span, close, contacts or [], starts
        self.loads = loads
        self.given = dict(self.work.starts), dict(self.work.velocities)
        self.saved = SavedModel(self.work)
        self.first = pack(self.work, self._contacts(self.work))
        self.motions, self.laws = list(self.first.motions), laws_of(self.first)
        self.moving = bool(self.work.velocities) or bool(self.motions)
        self.turns = np.round((base.packed.system.angle_offset - self.first.system.angle_offset) / math.tau) * math.tau
        """Whole turns (rad) of angles that the motion has beyond those of the packed model."""

    def of(
        self, number: Number, order: tuple[np.ndarray, np.ndarray] = FOURTH, step: float = STEP, starts: bool = True
    ) -> Variants:
        """The variants of a number, with their ``starts`` or without. Raises ModelError where it cannot change."""
        size = self.size_of(number)
        usual = step_of(step, size)
        first: ModelError | None = None
        for h in (usual, SHORTER * usual):
            for (offsets, weights), sign in ((order, 1.0), (AHEAD, 1.0), (AHEAD, -1.0)):
                try:
                    made = [self._variant(number, offset * sign, h, starts) for offset in offsets]
                    return Variants(number, sign * h, weights, made, size)
                except (ModelError, AssemblyError) as error:
                    first = first or (error if isinstance(error, ModelError) else ModelError(str(error)))
        raise ModelError(f"{self.base.packed.name}: no derivative by '{number.name}': {first}") from first

    def size_of(self, number: Number) -> float:
        """Return the size of a number, of which its steps are parts."""
        return size_of(number, self.work, self.base.packed, self.span)

    def _variant(self, number: Number, offset: float, h: float, starts: bool) -> Variant:
        with with_value(self.work, number, number.value + offset * h, self.saved) as m:
            packed, lawful = self._packed(m)
            first = self.first
            if packed.first_row is not first.first_row and packed.first_row.tolist() != first.first_row.tolist():
                raise ModelError(f"{m.name}: '{number.name}' changes which joints there are")
            places = alike(packed.system, first.system, PLACES) and packed.com.tobytes() == first.com.tobytes()
            places = places and same_laws(packed.motions, self.base.packed.motions)
            masses = alike(packed.system, first.system, MASSES)
            begins = starts and self.starts and not (places and (masses or not self.moving) and self._starts_alike(m))
            start = self._decide(m, packed, begins)
            if packed.specials.phased:  # what rolls follows the start
                places = places and alike(packed.system, self.base.packed.system, ("numbers",))
            known = self.base.loads if lawful and self._pushes_alike(m, packed) else None
            terms = terms_of(packed, self.span, self.base.laws if lawful else None, self.loads, known)
            same_loads = lawful and alike(terms.loads, self.base.loads, TABLES_OF_LOADS + NUMBERS_OF_LOADS)
            return Variant(offset, terms, dict(m.traces), places, masses, same_loads, start, dict(m.events))

    def _starts_alike(self, m: Model) -> bool:
        return (m.starts, m.velocities) == self.given

    def _pushes_alike(self, m: Model, packed: Packed) -> bool:
        """Return True if forces are clearly those of the motion: elements alone, without masses, at the same arms."""
        loads = self.base.loads
        if loads is None or len(loads.interaction) or len(loads.user) or len(loads.friction):
            return False
        return unchanged(m.forces, self.saved) and packed.com.tobytes() == self.first.com.tobytes()

    def _packed(self, m: Model) -> tuple[Packed, bool]:
        """The mechanism packed, and whether its laws are those of the motion."""
        packed = repacked(m, self.first, self.saved)
        if packed is None or (self.moving and not alike(packed.system, self.first.system, MASSES)):
            packed = pack(m, self._contacts(m))
        same = same_laws(packed.motions, self.motions)
        if same:
            packed.motions[:] = self.base.packed.motions
        else:
            packed.settle_laws(*self.span)
        return packed, same and same_laws(laws_of(packed), self.laws)

    def _contacts(self, m: Model) -> list[Joint]:
        return [m.contacts.get(joint.name) or self._limit(m, joint) for joint in self.contacts]

    @staticmethod
    def _limit(m: Model, joint: Joint) -> Joint:
        """A stop at a limit of a joint, between the markers that this has in ``m``."""
        limited = m.joints[joint.name.rpartition(" ")[0]]
        return replace(joint, i=limited.i, j=limited.j)

    def _decide(self, m: Model, packed: Packed, begins: bool) -> Any:
        """Turns of angles as in the motion; what rolls, as the start of the variant says. The start, if it is found."""
        mine, start = packed.system.angle_offset, None
        if packed.specials.phased or begins:
            start = self.close(m, packed)
        packed.system = packed.system.changed(angle_offset=mine + self.turns)
        return start
