"""How far a run moves when its numbers move a little, which says how near another solver can come to it.

Gravity, masses, velocities at the start, restitution and friction are moved by parts of 1e-13, some five hundred
roundings, and the tolerance by a tenth, which ends steps elsewhere. A run moves by its own condition: each bounce
divides a speed and multiplies the error of its time, friction has kinks where something begins to stick. Its bound is

    within = max(1e-9, 10 moved), in powers of ten;   a run that moved by more than 1e-6 is too long to be recorded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from mbsd import Mechanism
from mbsd.dynamics.simulate import integrator_named
from tools.numbers.events.case import TOLERANCE, Case
from tools.numbers.events.difference import Difference, difference
from tools.numbers.events.record import Outcome, run

PART = 1e-13
LEAST, MOST = 1e-9, 1e-6
MARGIN = 10.0
TOLERANCES = (0.9, 1.1)
"""Factors of the tolerance."""


def moved(case: Case, outcome: Outcome) -> list[tuple[str, Difference]]:
    """Return what each small change does to a run."""
    times = [moment.t for moment in outcome.between]
    out = [
        (name, difference(outcome, run(case, times, change(case.build())))) for name, change in _changes(case).items()
    ]
    tolerance = float(case.options.get("tolerance", TOLERANCE))
    fixed = integrator_named(case.name, case.options.get("method", "dop853")).fixed_step
    for factor in () if fixed else TOLERANCES:
        out.append((f"tolerance {factor:g}", difference(outcome, run(case, times, tolerance=factor * tolerance))))
    return out


def bound(moved: float) -> float:
    """Return the bound for a run that moved so far."""
    return max(LEAST, 10.0 ** math.ceil(math.log10(max(MARGIN * moved, 1e-300)) - 1e-9))


def _changes(case: Case) -> dict[str, Callable[[Mechanism], Mechanism]]:
    return {
        "gravity and speeds": lambda m: _speeds(m, 1.0 + PART),
        "masses": lambda m: _masses(m, even=case.even),
        "contacts": lambda m: _contacts(m, 1.0 - PART),
    }


def _speeds(m: Mechanism, factor: float) -> Mechanism:
    if m.gravity is not None:
        m.gravity = (m.gravity[0] * factor, m.gravity[1] * factor)
    for name, given in m.velocities.items():
        place = None if given.place is None else (factor * given.place[0], factor * given.place[1])
        m.velocities[name] = replace(given, omega=factor * given.omega, place=place)
    return m


def _masses(m: Mechanism, even: bool) -> Mechanism:
    for k, (name, body) in enumerate(m.bodies.items()):
        if body.mass:
            m.change(name, mass=body.mass * (1.0 + PART * (1 if even else 1 + k % 3)))
    return m


def _contacts(m: Mechanism, factor: float) -> Mechanism:
    for name, contact in m.contacts.items():
        new = dict(_numbers(contact.params, factor))
        if new:
            m.change(name, **new)
    return m


def _numbers(params: Mapping[str, Any], factor: float) -> Iterator[tuple[str, float]]:
    for key in ("restitution", "friction", "static_friction"):
        if params.get(key):
            yield key, params[key] * factor
