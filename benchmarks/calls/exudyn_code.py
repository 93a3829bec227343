"""Exudyn: its static solver along the crank's angle, and a tree by an explicit method.

Its static solver starts from the reference pose, so a sweep is of a fresh system. A call again is ``Assemble`` and the
solver: it puts the system back to its start. Sensors of calls record.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks import calls, exudyn_systems
from benchmarks.exudyn_systems import STATIC, System, exu, hinge, sensor, settings
from benchmarks.harness import Fresh

VERSION = exudyn_systems.VERSION
SPAN = calls.ANGLES[-1]


def four_bar(law: Callable[[float], float]) -> System:
    """Return the linkage at crank angle 0, not yet assembled.

    ``law``: crank angle (rad) at a time or load factor.
    """
    system = System()
    for key, (*pose, length) in enumerate(calls.POSES):
        system.body(key, pose, mass=length, inertia=length**3 / 12)
    for first, place, second, other in calls.PINS:
        system.pin(first, place, second, other)
    system.drive(0, law)
    return system


def run(problem: str) -> tuple[str, Fresh, Callable[[Any], float]]:
    """Return settings, a fresh run and the error of its result."""
    return {calls.FOUR_BAR: _sweep, calls.SIMULATION: _simulation}.get(problem, lambda: _call(problem))()


def _sweep() -> tuple[str, Fresh, Callable[[Any], float]]:
    steps = len(calls.ANGLES)
    chosen = settings(steps)

    def fresh() -> Callable[[], Any]:
        system = four_bar(lambda t: SPAN * t)
        system.own.Assemble()
        return lambda: system.own.SolveStatic(chosen)

    def error(_: Any) -> float:
        system = four_bar(lambda t: SPAN * t)
        sensors = system.sensors((1, 2))
        system.own.Assemble()
        system.own.SolveStatic(settings(steps, 1 / steps))
        out = 0.0
        for k, rows in enumerate(map(system.recorded, sensors)):
            out = max(out, calls.worst(rows[:, 3] + calls.START[k], calls.exact(SPAN * rows[:, 0])[k]))
        return out

    return STATIC, fresh, error


def _call(problem: str) -> tuple[str, Fresh, Callable[[Any], float]]:
    turns, speeds = [1.0], itertools.count()
    system = four_bar(lambda t: 2 * math.pi * turns[0] * t)
    sensors = system.sensors((0, 2))
    chosen = settings(calls.STEPS, 0.5 / calls.STEPS)

    def call() -> list[np.ndarray]:
        if problem == calls.CHANGED:
            turns[0] = 1.0 + 1e-6 * next(speeds)
        system.own.Assemble()
        system.own.SolveStatic(chosen)
        return [system.recorded(number) for number in sensors]

    def error(result: list[np.ndarray]) -> float:
        return calls.rocker_error(result[0][:, 3], result[1][:, 3] + calls.START[1])

    return f"Assemble, {STATIC}", lambda: call, error


def _simulation() -> tuple[str, Fresh, Callable[[Any], float]]:
    system = exu.SystemContainer().AddSystem()
    node = hinge(system, calls.LENGTH / 2, calls.MASS, calls.MASS * calls.LENGTH**2 / 12, calls.GRAVITY)
    sensors = [sensor(system, node, kind) for kind in ("Coordinates", "Coordinates_t")]
    chosen = settings(calls.OUTPUTS, 0.5 * calls.DURATION / calls.OUTPUTS, calls.DURATION)

    def call() -> list[np.ndarray]:
        system.Assemble()
        system.SolveDynamic(chosen, solverType=exu.DynamicSolverType.RK44)
        return [np.array(system.GetSensorStoredData(number))[:, 1] for number in sensors]

    words = f"Assemble, tree, RK44, steps {calls.OUTPUTS}"
    return words, lambda: call, lambda result: calls.energy_drift(*result)
