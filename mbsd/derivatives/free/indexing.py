"""Tangents of a Geneva: its wheel's acceleration jumps where the pin enters or leaves a slot.

    x - r = 0       x: the wheel's centre along the crank's axis, r: radius of the pin

A copy of the mechanism has an event of its own there, so that the simulation stops and tangents jump. Between two such
events the pin is held in its slot, or out of it, so that no difference goes from one side to the other.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.relative import FIRST_OWN
from mbsd.derivatives.numbers.terms import Along, Terms
from mbsd.derivatives.numbers.variants import Variants
from mbsd.equations.relative.equation import AT
from mbsd.model.event import Event
from mbsd.model.mechanism import Model
from mbsd.results.solution import Solution

KIND = "geneva"
LIMIT = FIRST_OWN + 2
"""Place of the x beyond which the pin is in a slot, among the numbers of a Geneva."""
PASSES = 20
"""Times at most that joint friction and multipliers are solved for in turn at an event."""
SETTLED = 1e-13
"""Part of the largest multiplier by which they may still change."""


@dataclass(frozen=True)
class PinAtSlot:
    """The value of an event: how far the pin of a Geneva is in its slot (m), below zero where it is out of it."""

    joint: str

    def __call__(self, t: float, moment: Any) -> float:
        """Its value at a moment."""
        return float(_depths(moment.packed, moment.q[None], self.joint)[0])


def watched(m: Model) -> Model:
    """Return a copy with an event wherever a pin meets or leaves its slot; the mechanism itself without Genevas."""
    names = [name for name, joint in m.joints.items() if joint.kind.name == KIND]
    if not names:
        return m
    out = copy.deepcopy(m)
    for joint in names:
        name = f"pin of {joint}"
        while name in out.events:
            name += " again"
        out.events[name] = Event(name, PinAtSlot(joint))
    return out


def unwatched(sol: Solution, m: Model) -> Solution:
    """Return a solution of what is ``watched`` as one of the mechanism itself."""
    own = [event for event in sol.events if not is_index(sol.mechanism.events.get(event.name))]
    return sol if len(own) == len(sol.events) and sol.mechanism is m else replace(sol, events=own, mechanism=m)


def is_index(event: Any) -> bool:
    """Return True if an event is that of a pin at its slot."""
    return isinstance(event, Event) and isinstance(event.value, PinAtSlot)


def _depths(packed: Packed, q: np.ndarray, joint: str) -> np.ndarray:
    """(T,) x - r of a Geneva at poses q (T, 3 nb)."""
    specials, system = packed.specials, packed.system
    [k] = [k for k, own in enumerate(specials.joints) if own.name == joint]
    i, j = specials.places[k][:2]

    def turned(marker: int, vector: np.ndarray) -> np.ndarray:
        theta = q[:, 3 * int(system.marker_body[marker]) + 2]
        c, s = np.cos(theta), np.sin(theta)
        return np.stack([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]], axis=1)

    def place(marker: int) -> np.ndarray:
        body = 3 * int(system.marker_body[marker])
        return q[:, body : body + 2] + turned(marker, system.marker_arm[marker])

    along = ((place(j) - place(i)) * turned(i, system.marker_axis[i])).sum(axis=1)
    return along - specials.joints[k].params["radius"]


def held_between(terms: Terms, every: Sequence[Variants], along: Along) -> tuple[Terms, list[Variants]]:
    """Equations, and those of variants, with pins held in or out of their slots as they are along a stretch."""
    packed = terms.packed
    sides: dict[int, float] = {}
    for k, (name, joint) in enumerate(zip(packed.specials.names, packed.specials.joints, strict=True)):
        if name == KIND:
            depths = _depths(packed, along.q, joint.name)
            inside = depths[int(np.argmax(np.abs(depths)))] > 0.0
            sides[k] = -np.inf if inside else np.inf
    if not sides:
        return terms, list(every)

    def held(of: Terms) -> Terms:
        numbers = of.packed.system.numbers.copy()
        for k, limit in sides.items():
            numbers[int(of.packed.system.special[k, AT]) + LIMIT] = limit
        return replace(of, packed=replace(of.packed, system=of.packed.system.changed(numbers=numbers)))

    moved = [
        replace(own, variants=[replace(variant, terms=held(variant.terms)) for variant in own.variants])
        for own in every
    ]
    return held(terms), moved


def solve_ends(terms: Terms, along: Along, rows: np.ndarray, a: int, b: int) -> None:
    """Fill accelerations and multipliers at rows ``a`` and ``b`` - 1, where the pin may be on either side of its slot.

    ``rows`` are those that hold.
    """
    for k in {a, b - 1}:
        here = along.take(slice(k, k + 1))
        _, gamma, compact = terms.rows(here)
        jac = terms.packed.spread(compact)[0, rows]
        n, count = jac.shape[1], len(rows)
        matrix = np.zeros((n + count, n + count))
        matrix[:n, :n], matrix[:n, n:], matrix[n:, :n] = np.diag(terms.inertia[3:]), jac.T, jac
        others = np.setdiff1d(np.arange(along.lam.shape[1]), rows)
        slides = terms.packed.spread(compact)[0, others].T @ here.lam[0, others]
        for _ in range(PASSES):
            load = (terms.forces(here, compact) + terms.weight)[0, 3:] - slides
            solved = np.linalg.solve(matrix, np.concatenate([load, gamma[0, rows]]))
            change = np.abs(solved[n:] - here.lam[0, rows]).max(initial=0.0)
            here.lam[0, rows] = solved[n:]
            if not terms.rough or change <= SETTLED * np.abs(solved[n:]).max(initial=0.0):
                break
        along.a[k, 3:], along.lam[k, rows] = solved[:n], solved[n:]
