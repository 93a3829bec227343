"""Order and cost of every integrator that is installed here."""

from __future__ import annotations

import importlib
import math
import pkgutil
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import mbsd.dynamics.integrators
from mbsd import Mechanism, SimulationError
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.motion import integrate
from mbsd.dynamics.state import ACCEPTED
from tools.documents.integrators.mechanisms import four_bar, pendulum, pendulum_angle, stiff_four_bar

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
    """Seconds for an error of TARGET, between two rungs; or those of the longest run, where none gets there."""
    before = None
    for rung in rungs:
        if rung.error <= TARGET:
            if before is None or not math.isfinite(before.error):
                return rung.seconds, True
            part = math.log(before.error / TARGET) / math.log(before.error / rung.error)
            return before.seconds ** (1 - part) * rung.seconds**part, True
        before = rung
    return max(rung.seconds for rung in rungs), False


def measured(tell: Callable[[str], None]) -> dict[str, dict[str, Any]]:
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
