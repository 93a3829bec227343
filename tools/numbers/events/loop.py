"""Recorded runs beside one row of the compiled loop over many simulations."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.measures import final, samples
from tools.numbers.events.case import TOLERANCE, Case
from tools.numbers.events.record import Outcome, Sizes, read
from tools.numbers.events.table import cases

PARTS = ("x", "y", "theta", "vx", "vy", "omega")
IN_LOOP = "loop"


class Beside(NamedTuple):
    """A run beside its row."""

    name: str
    way: str
    """"loop", or why it is simulated by itself."""
    apart: float
    """Largest difference of all bodies' motion, in parts of its sizes."""
    within: float


def beside(only: str) -> Iterator[Beside]:
    """Yield runs whose names contain ``only`` beside one row of the loop each; refused runs have no motion."""
    records = read()
    for case in cases():
        record = records[case.name]
        own = records[record.same_as] if record.same_as else record
        if only in case.name and own.outcome is not None:
            yield _beside(case, own.outcome, own.within)


def _beside(case: Case, outcome: Outcome, within: float) -> Beside:
    m, given = case.build(), dict(case.options)
    rows = given.pop("event_rows", False)
    times = [moment.t for moment in outcome.between]
    names = {f"{name}.{part}": (name, part) for name, body in m.bodies.items() if body != m.ground for part in PARTS}
    steps = int(given.pop("steps", case.steps))
    measure = {name: final(name) for name in names} | {"work": final("work")}
    grid = np.linspace(0.0, case.duration, steps + 1)
    if times and outcome.end is not None and outcome.end.t == case.duration:
        grid = np.unique(np.concatenate([grid, times]))
        measure |= {f"{name} between": samples(name, times) for name in names}
    try:
        with warnings.catch_warnings(action="ignore"):
            many = m.simulate_many(
                times=grid, vary=_same(m), measure=measure, threads=1, **{"tolerance": TOLERANCE, **given}
            )
    except MechanismError as error:
        return Beside(case.name, "refused before any row", 0.0 if str(error) == outcome.text else math.inf, within)
    way = many.alone[0] or IN_LOOP
    if rows:
        way += " (without rows beside events)"
    if outcome.error or many.reason[0] is not None:
        same = bool(outcome.error) and many.reason[0] is not None and outcome.text in str(many.reason[0])
        return Beside(case.name, way, 0.0 if same else math.inf, within)
    assert outcome.sizes is not None
    assert outcome.end is not None
    apart = abs(float(many["work"][0]) - outcome.work) / outcome.sizes.energy
    alone = _places(case, times)
    for name, (body, part) in names.items():
        scale = _scale(outcome.sizes, part)
        ends, between = alone[body, part]
        apart = max(apart, abs(float(many[name][0]) - ends) / scale)
        if f"{name} between" in measure:
            apart = max(apart, float(np.abs(many[f"{name} between"][0] - between).max(initial=0.0)) / scale)
    return Beside(case.name, way, apart, within)


def _places(case: Case, times: list[float]) -> dict[tuple[str, str], tuple[float, np.ndarray]]:
    """Parts of bodies' motion at the end and between events, by a single simulation."""
    sol = case.simulate()
    after = sol.at(times) if times else sol
    return {
        (name, part): (float(getattr(sol.body(name), part)[-1]), np.asarray(getattr(after.body(name), part)))
        for name in sol.mechanism.bodies
        for part in PARTS
    }


def _scale(sizes: Sizes, part: str) -> float:
    places, rates = sizes.of_bodies()
    return (places + rates)[PARTS.index(part)]


def _same(m: Mechanism) -> dict[str, dict[str, list[float]]]:
    """A number that varies over one row, as it is: a mass, else a number of a contact."""
    for name, body in m.bodies.items():
        if body.mass:
            return {name: {"mass": [body.mass]}}
    raise ValueError(f"{m.name} has no mass")


def show(only: str) -> None:
    """Print a table of all, a line as soon as it is known."""
    print("| run | way | difference | bound |\n|---|---|--:|--:|")
    for each in beside(only):
        print(f"| {each.name} | {each.way} | {each.apart:.1e} | {each.within:.0e} |", flush=True)
