"""Batches whose rows differ in numbers of all kinds, beside each row alone: every quantity.

Rows of one chunk differ in lengths, positions, masses, laws, traced points, starts and velocities at once, so that a
number which the compiled loop reads from another row shows. Bounds are those of two free motions (agreement.py):
a nudged single simulation tells how errors grow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.simulate_many import Simulations
from mbsd.dynamics.measures.quantities import Quantity, quantity_named
from mbsd.measures import samples
from mbsd.model.mechanism import connections
from mbsd.numbers.names import Number, known_numbers, number_in, number_named, with_values
from mbsd.results.columns import FRAME
from mbsd.results.solution import Solution
from tools.hunt.agreement import NUDGE, SLACK, USELESS
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome
from tools.random_mechanisms.subject import attempt

MOST_NUMBERS = 6
"""Numbers that vary at once."""
PARTS = (1.0, 1.0007, 0.9991, 1.0013)
"""Rows, as parts of each number in an order of its own; of numbers that are zero, FEW times what is over 1."""
FEW = 0.1
SAME_STEPS = 1e-11
"""Part of the largest value that rounding of the same steps leaves."""
OUTPUTS = 12
ANGLE = 1e-10
"""rad, and sizes, by which designs may differ from their sweeps, over the least margin."""


@dataclass
class Rows:
    """Numbers that vary together."""

    m: Mechanism
    varied: list[tuple[str, str, Number]]
    """Return what is varied, by the two names that ``vary`` takes."""
    values: np.ndarray
    """(rows, numbers)"""

    def alone(self, row: int) -> Mechanism:
        """The mechanism of one row. Raises ModelError for numbers that it refuses."""
        return with_values(self.m, [number for _, _, number in self.varied], self.values[row].tolist())

    def together(self, names: list[str], times: np.ndarray, tolerance: float) -> Simulations:
        """Values of the quantities of these names at all times, of all rows."""
        vary: dict[str, dict[str, list[float]]] = {}
        for (whole, key, _), column in zip(self.varied, self.values.T, strict=True):
            vary.setdefault(whole, {})[key] = column.tolist()
        measure = {name: samples(name, times.tolist()) for name in names}
        return self.m.simulate_many(vary=vary, measure=measure, times=times, tolerance=tolerance, threads=1)


def mixed_rows(m: Mechanism, rng: np.random.Generator) -> Rows | None:
    """Random numbers of different things of a mechanism; None where it has none that may vary."""
    things = dict.fromkeys([*(name for table in connections(m) for name in table), *m.traces, *m.bodies, "gravity"])
    held = {name for driver in m.drivers.values() for name in driver.bodies}
    chosen: list[tuple[str, str, Number]] = []
    for whole in rng.permutation(list(things)).tolist():
        keys = [key for key in known_numbers(m, whole) if not (whole in held and key.startswith(("start", "moving")))]
        if keys and len(chosen) < MOST_NUMBERS:
            key = str(rng.choice(keys))
            chosen.append((whole, key, number_in(m, whole, key, "vary")))
    columns = []
    for _, _, number in chosen:
        parts = rng.permutation(PARTS)
        columns.append(number.value * parts if number.value else FEW * (parts - 1.0))
    return Rows(m, chosen, np.array(columns).T) if chosen else None


def quantity_names(sol: Solution) -> dict[str, Quantity]:
    """Every quantity that a measure may read of a mechanism like that of a solution."""
    known = list(sol.columns())
    names = ["t", "work", *(column.rpartition(" [")[0] for column in known)]
    m, other = sol.mechanism, {*sol.mechanism.joints, *sol.mechanism.drivers, *sol.mechanism.forces}
    for name in m.traces:
        whole = f"trace {name}" if name in other or name in m.bodies else name
        names += [f"{whole}.{component}" for component in FRAME]
    return {name: quantity_named(m, name, known) for name in dict.fromkeys(names)}


def beside_single_ones(
    name: str, rows: Rows, duration: float, tolerance: float, nudged: Callable[[Mechanism], Mechanism]
) -> Outcome:
    """Compare all quantities of all rows with single simulations.

    ``nudged`` gives the mechanism with other velocities.
    """
    times = np.linspace(0.0, duration, OUTPUTS + 1)
    first = next((sol for sol in map(_simulated(rows, times, tolerance), range(len(rows.values))) if sol), None)
    if first is None:
        return Outcome(name, UNCLEAR, "no row can be simulated")
    quantities = quantity_names(first)
    compiled = [key for key, quantity in quantities.items() if quantity.of_motions is not None]
    many, error = attempt(lambda: rows.together(compiled, times, tolerance))
    if error is not None:
        return Outcome(name, UNCLEAR, "what varies is refused", str(error))
    others = rows.together([key for key in quantities if key not in compiled] or compiled[:1], times, tolerance)
    for row in range(len(rows.values)):
        problem = _of_row(rows, row, (many, others), quantities, times, tolerance, nudged)
        if problem:
            return Outcome(name, WRONG, "differs", f"row {row} of {_words(rows)}: {problem}")
    if all(why is not None for why in many.alone):
        return Outcome(name, UNCLEAR, "each row by itself", many.way)
    return Outcome(name, AGREED if many.good.any() else REFUSED, "" if many.good.any() else "each row fails")


def _simulated(rows: Rows, times: np.ndarray, tolerance: float) -> Callable[[int], Solution | None]:
    def run(row: int) -> Solution | None:
        try:
            return rows.alone(row).simulate(times=times, tolerance=tolerance)
        except MechanismError:
            return None

    return run


def _of_row(
    rows: Rows, row: int, many: tuple[Simulations, Simulations], quantities: dict[str, Quantity], times: np.ndarray,
    tolerance: float, nudged: Callable[[Mechanism], Mechanism],
) -> str:  # fmt: skip
    """Return how a row differs from its single simulation; "" if it does not."""
    sol, error = attempt(lambda: rows.alone(row).simulate(times=times, tolerance=tolerance))
    if error is not None:
        whole = str(error).partition(". ")[0]
        is_known = all(whole in str(table.reason[row]) for table in many)
        return "" if is_known else f"reasons {[table.reason[row] for table in many]}, alone: {error}"
    assert sol is not None
    if any(table.reason[row] is not None for table in many):
        return f"reasons {[table.reason[row] for table in many]}, alone it is solved"
    moved, _ = attempt(lambda: nudged(rows.alone(row)).simulate(times=times, tolerance=tolerance))
    at = np.searchsorted(times, sol.t)
    for name, quantity in quantities.items():
        alone, table = quantity.of_solution(sol), many[0] if name in many[0].columns else many[1]
        largest = float(np.abs(alone).max(initial=0.0))
        grown = np.zeros(len(alone))
        if moved is not None and len(moved.t) == len(sol.t):
            grown = np.maximum.accumulate(np.abs(quantity.of_solution(moved) - alone)) / NUDGE
        bound = SLACK * tolerance * (grown + max(largest, _usual(name, sol))) + SAME_STEPS * largest
        bound = np.where(bound < USELESS * max(largest, 1e-6), bound, np.inf)
        mine = table[name][row][at]
        gap = np.where(np.isnan(mine) & np.isnan(alone), 0.0, np.abs(mine - alone))
        odd = np.flatnonzero(~(gap <= bound))
        if len(odd):
            k = int(odd[np.argmax(gap[odd])])
            return f"{name} at t = {sol.t[k]:.6g} s is {mine[k]:.9g}, alone {alone[k]:.9g}"
    return ""


def _usual(name: str, sol: Solution) -> float:
    """Return the size to which rounding of a quantity is relative: forces are differences of larger ones."""
    component = name.rpartition(".")[2]
    if component in ("fx", "fy", "torque", "effort", "power"):
        return float(np.abs(sol.wrench).max(initial=0.0))
    return float(np.abs(sol.a).max(initial=0.0)) if component in ("ax", "ay", "alpha") else 1.0


def _words(rows: Rows) -> str:
    return ", ".join(f"{whole}: {key}" for whole, key, _ in rows.varied)


def designs_beside_sweeps(name: str, m: Mechanism, rng: np.random.Generator, duration: float, margin: float) -> Outcome:
    """Designs of a batch, which differ in lengths and positions, beside a sweep of each.

    Designs are compared where none comes nearer to a singular pose than ``margin``.
    """
    bars = [body.name for body in m.bodies.values() if body.length is not None]
    placed = [*m.joints, *(name for name in m.traces if name not in m.joints)]
    chosen = [rng.permutation(part)[:2].tolist() if len(part) else [] for part in (bars, placed)]
    numbers = {f"{bar}.length": m.bodies[bar].length or 0.0 for bar in chosen[0]}
    numbers |= {f"{place}.{axis}": number_named(m, f"{place}.{axis}").value for place in chosen[1] for axis in "xy"}
    if not numbers:
        return Outcome(name, UNCLEAR, "nothing to vary")
    size = max(map(abs, numbers.values()), default=0.0)
    values = {key: value + 1e-3 * size * rng.normal(size=len(PARTS)) for key, value in numbers.items()}
    lengths = {bar: values[f"{bar}.length"] for bar in chosen[0]}
    places = {place: np.stack([values[f"{place}.x"], values[f"{place}.y"]], axis=1) for place in chosen[1]}
    angles = [body for body in m.bodies if body != "ground"]
    batch, error = attempt(lambda: m.batch(lengths, places, angles, duration, OUTPUTS))
    if error is not None:
        return Outcome(name, UNCLEAR, "a batch does not take it", str(error))
    assert batch is not None
    compared = 0
    for row in range(len(PARTS)):
        named = [number_named(m, key) for key in values]
        alone, _ = attempt(
            lambda row=row, named=named: with_values(m, named, [column[row] for column in values.values()]).sweep(
                times=batch.t
            )
        )
        if alone is None or not batch.closes[row] or alone.singularity_margin.min() < margin:
            continue
        compared += 1
        for body in angles:
            gap = float(np.abs(batch.angles[body][row] - alone.body(body).theta).max())
            if not gap < ANGLE / margin:
                return Outcome(name, WRONG, "differs", f"design {row}: angle of '{body}' is off by {gap:.3g} rad")
        for point in m.traces:
            there = np.stack([alone.point(point).x, alone.point(point).y], axis=1)
            gap = float(np.abs(batch.points[point][row] - there).max()) / alone.packed.size
            if not gap < ANGLE / margin:
                return Outcome(name, WRONG, "differs", f"design {row}: point '{point}' is off by {gap:.3g} sizes")
    return Outcome(name, AGREED) if compared else Outcome(name, UNCLEAR, "no design away from singular poses")
