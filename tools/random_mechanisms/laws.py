"""Laws of drivers: turns and swings of every kind, and laws with right and wrong derivatives."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd import Mechanism, constant_rate, cycloidal, function, harmonic, polynomial, table
from mbsd.model.laws import Motion
from mbsd.model.laws.splines import recorded
from tools.random_mechanisms.subject import Subject, family

# Laws of drivers: turns and swings of every kind, each over a known time.


TURN = 2 * math.pi


@dataclass(frozen=True)
class Drive:
    """A law over ``duration`` (s), with ``turn`` seconds a turn or a swing."""

    law: Motion
    duration: float
    turn: float


def turning(rng: np.random.Generator, start: float) -> Drive:
    """Return a law of whole turns from ``start`` (rad).

    Mostly at constant speed, sometimes speeding up, or by another law.
    """
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


# Laws of drivers with given derivatives: those of rises between dwells are taken, wrong ones refused by all.


def _taken(sol: object) -> list[str]:
    return ["a law whose derivatives are not its own was taken"]


@family("law with wrong derivatives", weight=0.3)
def wrong(rng: np.random.Generator) -> Subject:
    """Return a crank whose law errs in f' or f'' by a factor, a sign, or a part of 1e-5 to 1."""
    m, rate, size = Mechanism("wrong law", gravity=(0.0, -9.81)), float(10 ** rng.uniform(-0.5, 1.5)), 0.7
    off = 1.0 + float(rng.choice([-2.0, 1.0, -1.0, *(10.0 ** rng.uniform(-5, 0, 3) * rng.choice([-1, 1], 3))]))
    slope, bend = (off, off) if rng.random() < 0.5 else (1.0, off)
    law = function(
        lambda t: size * math.sin(rate * t),
        lambda t: slope * size * rate * math.cos(rate * t),
        lambda t: -bend * size * rate**2 * math.sin(rate * t),
    )
    crank, duration = m.bar("crank", 0.3, 1.0), 2 * math.pi / rate
    m.revolute("O", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, law)
    if rng.random() < 0.5:
        rod, block = m.bar("rod", 1.0, 1.0), m.body("block", 1.0, inertia=0.1)
        m.revolute("A", crank.end, rod.start)
        m.revolute("B", rod.end, block.origin)
        m.prismatic("rail", m.ground.origin, block.origin)
        m.start_near(rod=0.0, block=(1.3, 0.0, 0.0))
        return Subject(m, duration, bool(rng.random() < 0.5), duration, _taken, possible=False)
    bob = m.bar("bob", 0.4, 0.5)
    m.revolute("A", crank.end, bob.start)
    m.start_near(bob=-60.0)
    return Subject(m, duration, False, truth=_taken, possible=False)


@family("rise with given derivatives", weight=0.3)
def rise(rng: np.random.Generator) -> Subject:
    """A cycloidal or 3-4-5 rise between dwells, right or with f' or f'' that errs on a part of the rise."""
    m, begin, length = (
        Mechanism("rise", gravity=(0.0, -9.81)),
        float(rng.uniform(0, 0.5)),
        float(10 ** rng.uniform(-2, -0.4)),
    )
    size, turn = float(rng.uniform(0.1, 2.0)), 2 * math.pi
    laws = (
        (lambda u: u - math.sin(turn * u) / turn, lambda u: 1 - math.cos(turn * u), lambda u: turn * math.sin(turn * u))
        if rng.random() < 0.5
        else (
            lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5,
            lambda u: 30 * (u**2 - 2 * u**3 + u**4),
            lambda u: 60 * u - 180 * u**2 + 120 * u**3,
        )
    )
    errs, off = int(rng.integers(0, 3)), 1.0 + float(10 ** rng.uniform(-3, 0))

    def of_order(order: int):
        def law(t: float) -> float:
            u = min(max((t - begin) / length, 0.0), 1.0)
            wrong = order > 0 and order == errs and 0.3 < u < 0.7
            return size / length**order * laws[order](u) * (off if wrong else 1.0)

        return law

    crank, bob = m.bar("crank", 0.3, 1.0), m.bar("bob", 0.4, 0.5)
    m.revolute("O", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, function(of_order(0), of_order(1), of_order(2)))
    m.start_near(bob=-60.0)
    if rng.random() < 0.5:
        m.weld("A", crank.end, bob.start)
        return Subject(m, 1.0, True, 1.0, _taken if errs else None, possible=not errs)
    m.revolute("A", crank.end, bob.start)
    return Subject(m, 1.0, False, truth=_taken if errs else None, possible=not errs)
