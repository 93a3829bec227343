"""Calls of a user, timed: ``python -m benchmarks.user_calls NAME`` prints seconds as JSON.

Each runs in a process of its own.

first_* begin with ``import mbsd``; again_* are the best of many calls of a model that was solved before.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

CALLS = 60


def _four_bar() -> Any:
    from mbsd import Mechanism, constant_rate

    m = Mechanism("four_bar")
    crank, coupler, rocker = m.bar("crank", 0.04, 0.1), m.bar("coupler", 0.12, 0.2), m.bar("rocker", 0.08, 0.15)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.1, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(6.0))
    m.start_near(crank=0, coupler=45, rocker=100)
    return m


def _pendulum() -> Any:
    from mbsd import Mechanism

    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.3, mass=0.2)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=-30)
    return m


def _ball() -> Any:
    from mbsd import Mechanism

    m = Mechanism("ball")
    ball = m.body("ball", mass=0.2, inertia=1e-5)
    m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.01)
    m.start_near(ball=(0.0, 0.1, 0.0))
    return m


def first_sweep() -> float:
    """A four-bar's sweep."""
    begun = time.perf_counter()
    _four_bar().sweep()
    return time.perf_counter() - begun


def first_simulation() -> float:
    """A pendulum's simulation."""
    begun = time.perf_counter()
    _pendulum().simulate(1.0)
    return time.perf_counter() - begun


def first_contact() -> float:
    """A simulation with contact."""
    begun = time.perf_counter()
    _ball().simulate(0.5)
    return time.perf_counter() - begun


def again_sweep() -> float:
    """``m.sweep()`` of 360 steps."""
    return _best(_four_bar().sweep)


def again_changed_sweep() -> float:
    """``m.sweep()`` after a change of the motor's law."""
    from mbsd import constant_rate

    m = _four_bar()
    rates = iter(range(10**6))

    def changed() -> None:
        m.change("motor", law=constant_rate(6.0 + 1e-3 * next(rates)))
        m.sweep()

    return _best(changed)


def again_simulation() -> float:
    """``m.simulate()`` of 10 s of a pendulum."""
    m = _pendulum()
    return _best(lambda: m.simulate(10.0))


def _best(call: Callable[[], object]) -> float:
    times = []
    for _ in range(CALLS):
        begun = time.perf_counter()
        call()
        times.append(time.perf_counter() - begun)
    return min(times)


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]]()))
