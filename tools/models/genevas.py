"""A Geneva drive for the solver's tests."""

from __future__ import annotations

import math

from mbsd import Mechanism, constant_rate


def geneva(slots: int, distance: float = 0.1, start: float = 0.0) -> Mechanism:
    """With the given slots and distance of centres (m), its crank turning at 1 rad/s from ``start`` (rad)."""
    m = Mechanism("geneva", gravity=None)
    crank, wheel = m.body("crank"), m.body("wheel", 1.0, (0, 0), 2e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(distance, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots, distance * math.sin(math.pi / slots))
    m.drive_angle("motor", crank, constant_rate(1.0, start))
    m.start_near(wheel=5)
    return m
