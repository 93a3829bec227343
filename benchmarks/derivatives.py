"""Gradients in ten numbers beside the motions that they are of.

A door that bounces to rest on a stop, eleven impacts in 0.9 s, by its hinge, spring, stop, masses and start: the
integral of its angle. A four-bar that a spring and gravity drive for 1 s, without an event: the angle at its end. A
sweep of a slider-crank: the largest effort of its motor. Errors are those against central differences of fourth order
of whole motions.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

import mbsd
from benchmarks.harness import best_in_turns
from benchmarks.rows import Bar, Row
from mbsd.measures import Measure, final, integral, largest
from mbsd.numbers.names import number_named, with_values

DOOR = "gradient in 10 numbers, door with 11 impacts"
LINKAGE = "gradient in 10 numbers, four-bar simulated for 1 s"
SWEEP = "gradient in 10 numbers, sweep of a slider-crank"
MOST = 4.0
"""Simulations that a gradient of the door takes at most."""
TURNS = 24
STEPS = 100
LARGEST_ERROR = 1e-4
"""Error of a gradient, as part of each derivative."""
TIME = "; processor time"
WEIGHTS = {-2.0: 1 / 12, -1.0: -8 / 12, 1.0: 8 / 12, 2.0: -1 / 12}


def door() -> mbsd.Mechanism:
    """It falls on a stop and bounces to rest."""
    m = mbsd.Mechanism("door")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.torsion_spring("k", m.ground, rod, stiffness=2.0, damping=0.3, free_angle=-2.0)
    m.angle_stop("end", m.ground.at(0, 0), rod.start, at=-1.2, restitution=0.4)
    m.start_near(rod=0)
    return m


def linkage() -> mbsd.Mechanism:
    """A four-bar that nothing drives."""
    m = mbsd.Mechanism("four_bar")
    a, b, c = m.bar("a", 0.04, mass=0.2), m.bar("b", 0.12, mass=0.3), m.bar("c", 0.09, mass=0.2)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(0.12, 0), c.start)
    m.spring("s", m.ground.at(0.05, 0.2), b.end, 300.0, damping=1.0, free_length=0.1)
    m.start_near(a=20, b=45, c=100)
    m.start_moving(a=30.0)
    return m


def slider_crank() -> mbsd.Mechanism:
    """Driven."""
    m = mbsd.Mechanism("slider_crank")
    a, b, slider = m.bar("a", 0.05, mass=0.2), m.bar("b", 0.15, mass=0.3), m.body("slider", mass=0.5)
    m.revolute("O", m.ground.at(0, 0), a.start)
    m.revolute("A", a.end, b.start)
    m.revolute("B", b.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0.01), slider.origin)
    m.drive_angle("motor", a, mbsd.constant_rate(100.0))
    m.spring("s", m.ground.at(-0.1, 0.1), slider.origin, 200.0, damping=3.0, free_length=0.05)
    m.start_near(a=0, b=0)
    return m


Problem = tuple[Callable[[], mbsd.Mechanism], list[str], float, Measure]
PROBLEMS: dict[str, Problem] = {
    DOOR: (
        door,
        ["end.restitution", "end.at", "gravity.y", "rod.mass", "rod.length", "rod.inertia", "k.stiffness", "k.damping",
         "k.free_angle", "rod.start.angle"],
        0.9, integral("rod.theta"),
    ),
    LINKAGE: (
        linkage,
        ["a.mass", "a.length", "b.length", "D.x", "s.stiffness", "s.damping", "s.free_length", "gravity.y", "b.mass",
         "a.moving.omega"],
        1.0, final("a.theta"),
    ),
    SWEEP: (
        slider_crank,
        ["a.mass", "a.length", "b.length", "guide.y", "s.stiffness", "s.damping", "s.free_length", "slider.mass",
         "b.mass", "motor.rate"],
        math.tau / 100.0, largest("motor.effort"),
    ),
}  # fmt: skip


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows by problem, and how many simulations a gradient of the door takes."""
    rows, bars = [], []
    for problem, (make, numbers, duration, measure) in PROBLEMS.items():
        m, word = make(), "sweep" if problem == SWEEP else "simulate"

        def motion(m: mbsd.Mechanism = m, duration: float = duration, word: str = word) -> object:
            if word == "sweep":
                return m.sweep(duration, steps=STEPS)
            return m.simulate(duration, steps=STEPS, tolerance=1e-9)

        def gradient(
            m: mbsd.Mechanism = m, numbers: list[str] = numbers, duration: float = duration, measure: Measure = measure
        ) -> np.ndarray:
            return m.sensitivities({"of": measure}, numbers, duration, STEPS)["of"]

        (own, _), (alone, _) = best_in_turns([gradient, motion], TURNS)
        wrong = error(m, numbers, duration, measure, gradient())
        rows.append(Row(problem, "mbsd", mbsd.__version__, f"m.sensitivities(){TIME}", own, wrong))
        rows.append(Row(problem, f"its m.{word}()", mbsd.__version__, f"one motion{TIME}", alone, 0.0))
        if problem != SWEEP:
            ratio = own / alone
            met = ratio <= MOST and wrong < LARGEST_ERROR
            bars.append(Bar(f"{problem}, simulations", MOST, ratio, "", "tolerance 1e-9", met, most=True))
    return rows, bars


def error(
    m: mbsd.Mechanism, numbers: list[str], duration: float, measure: Measure, gradient: np.ndarray, step: float = 1e-5
) -> float:
    """Return the largest difference from central differences of whole motions.

    It is a part of the largest derivative by each number.
    """
    worst = 0.0
    for k, name in enumerate(numbers):
        number, total = number_named(m, name), 0.0
        h = step * (abs(number.value) or 1.0)
        for offset, weight in WEIGHTS.items():
            other = with_values(m, [number], [number.value + offset * h])
            free = not other.drivers
            sol = other.simulate(duration, steps=STEPS, tolerance=1e-13) if free else other.sweep(duration, steps=STEPS)
            column = next(c for c in sol.columns() if c.startswith(f"{measure.quantity} ["))
            total += weight * float(measure.of("x", sol.t, {measure.quantity: sol.columns()[column][None]})["x"][0]) / h
        scale = max(abs(total), 1e-3)
        worst = max(worst, abs(gradient[k] - total) / scale)
    return worst
