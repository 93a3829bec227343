"""A02, the N-four-bar of the IFToMM benchmark library: N loops of rods, 1 m and 1 kg each.

They swing through y = 0.

N + 1 vertical rods stand on pins one metre apart, N couplers join their tops; the tops start at 1 m/s. Whenever all
rods lie in one line each loop could leave its parallelogram, so energy alone may look right on a wrong branch. Errors:
largest drift of the energy over 10 s (J), accepted below 0.1, and the vertical rods' worst angle at 10 s (rad) from the
exact motion with one degree of freedom,

    ((N + 1)/3 + N) theta'' = -((N + 1)/2 + N) g cos(theta),  theta(0) = pi/2,  theta'(0) = -1 rad/s.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from benchmarks.dynamics.pins import GROUND, Pin, Pinned, Record, Solid, energy_drift

LENGTH = 1.0
MASS = 1.0
INERTIA = MASS * LENGTH**2 / 12
GRAVITY = 9.81
SPEED = 1.0
DURATION = 10.0
LIMITS = {"energy drift (J)": 0.1, "angle (rad)": 1e-3}
BAR = 20.0
"""How many times our time the best peer that meets both limits takes at least."""


def name(loops: int) -> str:
    """Name of the problem with this many loops."""
    return f"A02 N={loops}"


def model(loops: int) -> Pinned:
    """Return bodies in turn: vertical rod 0, coupler 0, vertical rod 1, ...

    Each rod's frame is at its middle, x along it.
    """
    solids: list[Solid] = []
    pins: list[Pin] = []
    start, end = (-LENGTH / 2, 0.0), (LENGTH / 2, 0.0)
    for k in range(loops + 1):
        upright = (k * LENGTH, LENGTH / 2, math.pi / 2)
        solids.append(Solid(MASS, INERTIA, upright, (SPEED / 2, 0.0, -SPEED / LENGTH)))
        pins.append(Pin(GROUND, (k * LENGTH, 0.0), 2 * k, start))
        if k > 0:
            pins.append(Pin(2 * k, end, 2 * k - 1, end))
        if k < loops:
            solids.append(Solid(MASS, INERTIA, ((k + 0.5) * LENGTH, LENGTH, 0.0), (SPEED, 0.0, 0.0)))
            pins.append(Pin(2 * k, end, 2 * k + 1, start))
    return Pinned(tuple(solids), tuple(pins), GRAVITY)


@cache
def exact_angle(loops: int) -> float:
    """Angle of the vertical rods at 10 s, rad."""
    from scipy.integrate import solve_ivp

    inertia, load = (loops + 1) / 3 + loops, GRAVITY * ((loops + 1) / 2 + loops)
    solved = solve_ivp(
        lambda t, y: (y[1], -load * math.cos(y[0]) / inertia),
        (0, DURATION), (math.pi / 2, -SPEED / LENGTH), method="DOP853", rtol=1e-13, atol=1e-14,
    )  # fmt: skip
    return float(solved.y[0, -1])


def errors(loops: int, record: Record) -> dict[str, float]:
    """By the names of LIMITS; an angle is right only within the whole turns that the rods really made."""
    angle = float(np.abs(record.poses[-1, ::2, 2] - exact_angle(loops)).max())
    if abs(record.times[-1] - DURATION) > 1e-6 or not np.isfinite(angle):
        angle = float("inf")
    return {"energy drift (J)": energy_drift(model(loops), record), "angle (rad)": angle}
