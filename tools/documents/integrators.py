"""Integrators measured: docs/integrators.json and its page's tables (``make integrators``)."""

from __future__ import annotations

import importlib
import json
import math
import pkgutil
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ellipj, ellipk

import mbsd.dynamics.integrators
from mbsd import Mechanism, SimulationError
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.motion import integrate
from mbsd.dynamics.simulate import integrator_named
from mbsd.dynamics.state import ACCEPTED, EVALUATIONS
from shared.stage.console import markdown_table
from tools.documents.pages import DOCS, replaced

# Mechanisms on which integrators are measured: an open chain, a closed chain, and that with a stiff joint.


G = 9.81
AMPLITUDE = math.radians(100)
"""Amplitude of the pendulum, whose rod of 1.5 m swings like a point on a string of 1 m."""


def pendulum() -> Mechanism:
    """A rod hung at its end, released 100 degrees from rest."""
    m = Mechanism("pendulum", gravity=(0.0, -G))
    rod = m.bar("rod", 1.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=math.degrees(AMPLITUDE) - 90.0)
    return m


def pendulum_angle(t: np.ndarray) -> np.ndarray:
    """Angle of the rod from the x axis (rad): sin(phi/2) = k sn(K - w t)."""
    k = math.sin(AMPLITUDE / 2)
    return 2 * np.arcsin(k * ellipj(ellipk(k * k) - math.sqrt(G) * t, k * k)[0]) - math.pi / 2


def four_bar(pin: bool = True) -> Mechanism:
    """A crank-rocker released from rest; it swings through 283 degrees of its crank."""
    m = Mechanism("four-bar", gravity=(0.0, -G))
    crank, coupler, rocker = m.bar("crank", 0.3, 1.0), m.bar("coupler", 0.9, 0.5), m.bar("rocker", 0.7, 2.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("D", m.ground.at(0.8, 0), rocker.start)
    m.start_near(crank=50, coupler=20, rocker=80)
    if pin:
        m.revolute("C", coupler.end, rocker.end)
    return m


def stiff_four_bar() -> Mechanism:
    """Return the four-bar with a stiff bush for the pin C.

    Its damper alone asks explicit methods for steps below 0.01 ms.
    """
    m = four_bar(pin=False)
    closed = four_bar().simulate(1e-3, steps=1)
    m.start_near(**{name: math.degrees(float(closed.body(name).theta[0])) for name in ("crank", "coupler", "rocker")})
    m.bushing("C", m.bodies["coupler"].end, m.bodies["rocker"].end, (1e7, 1e7, 0.0), (1e5, 1e5, 0.0))
    return m


# Order and cost of every integrator that is installed here.


for _module in pkgutil.iter_modules(mbsd.dynamics.integrators.__path__):
    importlib.import_module(f"mbsd.dynamics.integrators.{_module.name}")

OUTPUTS = 10
ROUNDING = 1e-11
"""Errors below this (rad) tell nothing about an order."""
TARGET = 1e-5
"""The error (rad) at which costs are compared."""
RUNGS = 14
PATIENCE = 6.0
"""A run longer than this (s) ends a ladder."""


@dataclass(frozen=True)
class Rung:
    """One run of a ladder of finer and finer ones."""

    steps: int
    error: float
    """Root mean square over the outputs (rad)."""
    seconds: float
    """Time of the processor, for the integration alone; the least of three."""


@dataclass(frozen=True)
class Case:
    """A mechanism and the angle whose error counts."""

    make: Callable[[], Mechanism]
    body: str
    duration: float
    step: float
    """The coarsest (s); each rung halves it."""
    exact: np.ndarray
    """(OUTPUTS + 1,) rad"""

    def ladder(self, method: Integrator, enough: float) -> list[Rung]:
        """Runs from coarse to fine, until the error is below ``enough`` or time runs out."""
        self._rung(method, 1e-3, self.step, part=1e-3)  # compiled before the clock runs
        rungs: list[Rung] = []
        for k in range(RUNGS):
            rung = self._rung(method, 10.0 ** (-3 - k / 2), self.step / 2**k)
            rungs.append(rung)
            if rung.error < enough or rung.seconds > PATIENCE:
                break
        return rungs

    def _rung(self, method: Integrator, tolerance: float, step: float, part: float = 1.0) -> Rung:
        ready = prepare_dynamics(self.make(), 0.0, self.duration)
        times = part * np.linspace(0.0, self.duration, OUTPUTS + 1)
        angle = 3 * ready.packed.body_names.index(self.body) + 2
        least, rung = math.inf, Rung(0, math.inf, 0.0)
        for _ in range(3):
            begin = time.process_time()
            try:
                state, out = integrate(ready, method, times, tolerance, step)
            except SimulationError:
                return Rung(0, math.inf, 0.0)
            least = min(least, time.process_time() - begin)
            with np.errstate(over="ignore"):  # what blew up
                error = float(np.sqrt(np.mean((out.y[:, 0, angle] - self.exact) ** 2)))
            rung = Rung(int(state.count[ACCEPTED]), error, least)
            if least > 0.5:
                break
        return rung


def case(make: Callable[[], Mechanism], body: str, duration: float, step: float) -> Case:
    """With a reference far tighter than what it is compared with; exact for the pendulum."""
    times = np.linspace(0.0, duration, OUTPUTS + 1)
    if make is pendulum:
        return Case(make, body, duration, step, pendulum_angle(times))
    tight: dict[str, Any] = {"method": "radau", "tolerance": 1e-12} if make is stiff_four_bar else {"tolerance": 1e-13}
    return Case(make, body, duration, step, make().simulate(times=times, **tight).body(body).theta)


def order(rungs: list[Rung]) -> float:
    """The slope of log error over log steps between rounding and what is too coarse to show it."""
    usable = [rung for rung in rungs if ROUNDING < rung.error < 1e-2]
    steps, errors = [rung.steps for rung in usable], [rung.error for rung in usable]
    return -float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def cost(rungs: list[Rung]) -> tuple[float, bool]:
    """Return the seconds for an error of TARGET, between two rungs.

    Where none gets there: those of the longest run, and False.
    """
    before = None
    for rung in rungs:
        if rung.error <= TARGET:
            if before is None or not math.isfinite(before.error):
                return rung.seconds, True
            part = math.log(before.error / TARGET) / math.log(before.error / rung.error)
            return before.seconds ** (1 - part) * rung.seconds**part, True
        before = rung
    return max(rung.seconds for rung in rungs), False


def measure_accuracy(tell: Callable[[str], None]) -> dict[str, dict[str, Any]]:
    """By method: order on both chains, and cost on the closed one, with its pin and with the stiff bush."""
    out: dict[str, dict[str, Any]] = {}
    long, stiff = case(four_bar, "rocker", 10.0, 0.02), case(stiff_four_bar, "rocker", 1.0, 0.02)
    for fixed in (True, False):
        short = 1.0 if fixed else 10.0  # variable steps need time to be chosen freely
        open_chain, closed = case(pendulum, "rod", short, 0.04), case(four_bar, "rocker", short, 0.02)
        for name, method in INTEGRATORS.items():
            if method.fixed_step != fixed or not method.installed:
                continue
            out[name] = {
                "stated": method.order,
                "pendulum": round(order(open_chain.ladder(method, 1e-9)), 1),
                "four-bar": round(order(closed.ladder(method, 1e-9)), 1),
                "cost": cost(long.ladder(method, TARGET)),
                "stiff cost": cost(stiff.ladder(method, TARGET)),
            }
            tell(f"{name}: {out[name]}")
    for which, own in (("cost", "dop853"), ("stiff cost", "radau")):
        unit = out[own][which][0]
        for row in out.values():
            row[which] = float(f"{row[which][0] / unit:.2g}"), row[which][1]
    return dict(sorted(out.items(), key=lambda item: ("-" in item[0], item[0])))


# Energy over ten thousand periods of a pendulum and a four-bar, by the solver's own integrators.


PERIODS = 10_000
A_PERIOD = 2.653
"""Outputs in a period, so that they fall on all its phases."""
MARKS = 32
"""Along the logarithm of time, at which the largest error so far is kept."""
RUNS: dict[str, dict[str, float]] = {
    "dop853": {"tolerance": 1e-7},
    "dop853, tight": {"tolerance": 1e-11},
    "radau": {"tolerance": 1e-5},
    "rk4": {"steps": 100},
    "symplectic": {"steps": 80},
    "rattle": {"steps": 400},
    "generalized_alpha": {"steps": 100},
    "baumgarte": {"steps": 100},
}
"""Tolerance, or steps in a period: 400 evaluations of the accelerations for each explicit one. What follows a comma is
no part of the method's name."""


def swing(m: Mechanism) -> tuple[float, float]:
    """Period (s) of a motion that starts at rest, back to its start; largest kinetic energy (J)."""
    sol = m.simulate(10.0, steps=100_000, tolerance=1e-10)
    rate = sol.body(next(name for name in m.bodies if name in ("rod", "crank"))).omega
    ends = np.flatnonzero((rate[1:-1] > 0) != (rate[2:] > 0)) + 1
    where = sol.t[ends] + (sol.t[ends + 1] - sol.t[ends]) * rate[ends] / (rate[ends] - rate[ends + 1])
    return float(where[1]), float(sol.energy.kinetic.max())


def one(m: Mechanism, length: float, scale: float, name: str) -> dict[str, Any]:
    """Return the largest energy errors so far, evaluations a period and seconds of one run.

    Errors are parts of ``scale`` (J); a period is ``length`` (s).
    """
    method, setting = integrator_named(m.name, name.partition(",")[0]), RUNS[name]
    times = np.linspace(0.0, PERIODS * length, int(PERIODS * A_PERIOD) + 1)
    ready = prepare_dynamics(m, 0.0, float(times[-1]))
    tolerance, step = setting.get("tolerance", 1.0), length / setting.get("steps", 1.0)
    integrate(ready, method, times[:3], tolerance, step)  # compiled before the clock starts
    begin = time.process_time()
    state, out = integrate(ready, method, times, tolerance, step)
    seconds = time.process_time() - begin
    kinetic = 0.5 * (out.y[:, 1] ** 2 * ready.dynamics.inertia).sum(axis=1)
    energy = kinetic - out.y[:, 0] @ ready.dynamics.weight
    error = np.maximum.accumulate(np.abs(energy - energy[0])) / scale
    marks = np.unique(np.geomspace(A_PERIOD + 1, len(times) - 1, MARKS).astype(int))
    return {
        "periods": [round(float(at / length), 2) for at in times[marks]],
        "errors": [float(f"{value:.3g}") for value in error[marks]],
        "evaluations": round(float(state.count[EVALUATIONS]) / PERIODS),
        "seconds": seconds,
    }


def measure_long_runs(tell: Callable[[str], None]) -> dict[str, dict[str, dict[str, Any]]]:
    """By mechanism and name of the run."""
    out: dict[str, dict[str, dict[str, Any]]] = {}
    for make in (pendulum, four_bar):
        length, scale = swing(make())
        out[make().name] = {}
        for name in RUNS:
            out[make().name][name] = numbers = one(make(), length, scale, name)
            tell(f"{make().name}, {length:.4f} s, {name}: {numbers['errors'][-1]}, {numbers['seconds']:.1f} s")
    return out


# Integrators measured: docs/integrators.json and the tables of docs/integrators.md (``make integrators``).
#
# Orders and costs take two minutes, ten thousand periods by each method another three. The picture is drawn from the
# numbers by figures/simulations.py. Methods of packages that are not installed keep their old numbers.


FILE = DOCS / "integrators.json"
ACCURACY = "<!-- order and cost -->", "<!-- end of order and cost -->"
LONG = "<!-- long runs -->", "<!-- end of long runs -->"


def main(words: Sequence[str]) -> None:
    """Measure all integrators and write the numbers and the tables."""
    kept = json.loads(FILE.read_text())["accuracy"] if FILE.exists() else {}
    measured = {"accuracy": kept | measure_accuracy(_report), "long": measure_long_runs(_report)}
    for runs in measured["long"].values():
        unit = runs["dop853"]["seconds"]
        for run in runs.values():
            run["seconds"] = float(f"{run['seconds'] / unit:.2g}")
    FILE.write_text(json.dumps(measured, indent=1) + "\n")
    page = DOCS / "integrators.md"
    page.write_text(with_tables(page.read_text(), json.loads(json.dumps(measured))))


def _report(line: str) -> None:
    print(line, flush=True)


def with_tables(page: str, measured: dict[str, Any]) -> str:
    """Return the page with the tables of these numbers."""
    page = replaced(page, *ACCURACY, accuracy_table(measured["accuracy"]))
    return replaced(page, *LONG, long_table(measured["long"]))


def accuracy_table(rows: dict[str, dict[str, Any]]) -> str:
    """Return the table of orders and costs."""
    head = ("method", "order", "measured, pendulum", "measured, four-bar", "cost, four-bar", "cost, stiff bush")
    cells = []
    for name, row in rows.items():
        orders = row["stated"] or "varies", row["pendulum"], row["four-bar"]
        cells.append((f"`{name}`", *map(str, orders), *(_ratio(*row[which]) for which in ("cost", "stiff cost"))))
    return "\n".join(markdown_table(head, cells))


def _ratio(value: float, reached: bool) -> str:
    text = f"{value:.0f}" if value >= 10 else f"{value:.2g}"
    return text if reached else f"over {text}" if value else "none"


def long_table(runs: dict[str, dict[str, Any]]) -> str:
    """Return the table of energy errors after all periods, and costs."""
    pendulum, four_bar = runs["pendulum"], runs["four-bar"]
    errors = "energy error, pendulum", "energy error, four-bar"
    cells = []
    unit = sum(run["dop853"]["seconds"] for run in runs.values())
    for name, setting in RUNS.items():
        setting_words = (
            f"{setting['steps']} steps a period" if "steps" in setting else f"tolerance {setting['tolerance']:.0e}"
        ).replace("e-0", "e-")
        first, other = pendulum[name], four_bar[name]
        seconds = (first["seconds"] + other["seconds"]) / unit
        sizes = (f"{run['errors'][-1]:.0e}" for run in (first, other))
        evaluations = f"{first['evaluations']}, {other['evaluations']}"
        cells.append((f"`{name.partition(',')[0]}`", setting_words, *sizes, evaluations, f"{seconds:.2g}"))
    return "\n".join(markdown_table(("method", "setting", *errors, "evaluations a period", "time, both"), cells))
