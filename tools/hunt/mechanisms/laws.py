"""Laws of drivers: turns and swings of every kind, each over a known time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd import constant_rate, cycloidal, function, harmonic, polynomial, table
from mbsd.model.laws import Motion
from mbsd.model.laws.splines import recorded

TURN = 2 * math.pi


@dataclass(frozen=True)
class Drive:
    """A law over ``duration`` (s), with ``turn`` seconds a turn or a swing."""

    law: Motion
    duration: float
    turn: float


def turning(rng: np.random.Generator, start: float) -> Drive:
    """Whole turns from ``start`` (rad): mostly at constant speed, sometimes speeding up, or by another law."""
    turns = float(rng.choice([0.5, 1.0, 1.0, 1.0, 2.0, 3.0]))
    speed = float(rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(-0.5, 2.0))
    turn = TURN / abs(speed)
    duration, way = turns * turn, math.copysign(TURN * turns, speed)
    kind = rng.random()
    if kind < 0.7:
        return Drive(constant_rate(speed, start), duration, turn)
    if kind < 0.78:
        return Drive(cycloidal(way, duration, 0.0, start), duration, turn)
    if kind < 0.86:
        return Drive(polynomial(start, 0.4 * way / duration, 0.6 * way / duration**2), duration, turn)
    if kind < 0.93:
        t = np.linspace(0.0, duration, 60)
        return Drive(table(t, start + way * (t / duration - 0.1 * np.sin(TURN * t / duration) / TURN)), duration, turn)
    return Drive(
        function(lambda t: start + way * (t / duration + 0.05 * math.sin(TURN * t / duration))), duration, turn
    )


def swinging(rng: np.random.Generator, start: float, amplitude: float) -> Drive:
    """A swing about, or from, ``start``; rad or m."""
    rate = float(10 ** rng.uniform(-0.3, 1.3))
    turn = TURN / rate
    kind = rng.random()
    if kind < 0.6:
        phase = float(rng.uniform(-math.pi, math.pi))
        return Drive(harmonic(amplitude, rate, phase, start - amplitude * math.sin(phase)), turn, turn)
    if kind < 0.75:
        return Drive(cycloidal(amplitude, 0.7 * turn, 0.1 * turn, start), turn, turn)
    t = np.linspace(0.0, turn, 41)
    values = start + amplitude * np.sin(TURN * t / turn)
    values[-1] = values[0]
    if kind < 0.9:
        return Drive(table(t, values, periodic=bool(rng.random() < 0.5)), turn, turn)
    return Drive(recorded(t, values, noise=0.0), turn, turn)
