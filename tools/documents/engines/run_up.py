"""One run of the study: an engine on mounts, simulated from rest through its resonances, beside linear theory.

Mass, inertia and mounts are those of the mount study of docs/engines.md. The cylinders compress and do not burn, as on
a test bench that drives the engine; the bench stands on ground, so that the torque of gas and inertia rocks the block.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.block import Block, mounts_of_frequency
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.mount_response import mount_response
from mbsd.machines.engines.run_up import run_up

PLACES = ((-0.30, -0.10), (0.30, -0.10), (0.0, 0.20))
MASS, INERTIA = 150.0, 4.0
SIZE: dict[str, Any] = {"bore": 0.08, "stroke": 0.08, "rod": 0.14, "piston_mass": 0.5, "rod_mass": 0.6}
TORQUE_ORDER = {"I2": 1.0, "I3": 1.5, "I4": 2.0, "V8": 4.0}
"""The layouts, and the lowest order of each one's torque: half of its cylinders."""
GRID = {
    "layout": list(TORQUE_ORDER),
    "frequency": [8.0, 25.0],
    "damping_ratio": [0.05, 0.1, 0.2],
    "rate": [100.0, 200.0, 500.0, 1000.0, 2000.0],
}
"""Natural frequency of the mass on its mounts (Hz), damping ratio, and how fast the speed rises (rpm/s)."""
BEYOND = 1.6
"""The run ends at so many times the speed at which the lowest order of the torque meets the rocking mode."""
ROWS = 144
"""Rows of the last turn, which every other turn has more of."""
RPM = 30 / math.pi
"""Times rad/s."""
SPEEDS = np.linspace(0.02, 1.0, 491)
"""Parts of the last speed at which the steady response is computed."""


def build(layout: str, frequency: float, damping_ratio: float, rate: float) -> Mechanism:
    """The engine whose speed rises by ``rate`` (rpm/s) from rest, without weight, which only moves where it rests."""
    mounts = mounts_of_frequency(MASS, frequency, PLACES, damping_ratio)
    block = Block(MASS, INERTIA, mounts, motor_on="ground")
    m = engine(layout, **SIZE, gas=four_stroke(10.0), block=block, acceleration=rate / RPM, name=layout)
    m.gravity = None
    return m


def measure(m: Mechanism) -> dict[str, float]:
    """Largest displacement of the shaft's axis (mm) and angle of the block (mrad), and the speeds at which they come.

    ``steady``: the same at constant speed by linear theory. ``expected``: what of it a single mode run through at this
    rate reaches in closed form. Speeds in rpm.
    """
    law = m.drivers["motor"].motion
    assert law is not None  # of a driver
    rate = float(law(np.zeros(1))[0, 2])
    last = last_speed(m)
    duration = last / rate
    sol = m.simulate(duration, steps=math.ceil(ROWS * last * duration / (2 * math.pi)))
    block, speed = sol.body("block"), sol.body("crank").omega
    steady = mount_response(m, SPEEDS * last)
    moved, turned = steady.largest_displacement(), steady.largest_angle()
    out = {}
    for name, unit, now, always, of, excitation in (
        ("displacement", 1e3, np.hypot(block.x, block.y), moved, slice(0, 2), "inertia"),
        ("angle", 1e3, np.abs(block.theta), turned, slice(2, 3), "constant"),
    ):
        row, peak = int(now.argmax()), int(always.argmax())
        alone = np.linalg.norm(steady.displacement[peak, :, of], axis=1)
        order = float(steady.order[alone.argmax()])
        at = order * float(steady.speed[peak])
        mode = min(steady.modes, key=lambda mode: abs(mode.omega - at))
        passed = run_up(mode.frequency, mode.damping_ratio, rate, order, excitation)
        out |= {
            name: unit * float(now[row]),
            f"speed of {name}": RPM * float(speed[row]),
            f"steady {name}": unit * float(always[peak]),
            f"speed of steady {name}": RPM * float(steady.speed[peak]),
            f"order of {name}": order,
            f"expected {name}": unit * float(always[peak]) * passed.reached,
            f"speed of expected {name}": RPM * passed.peak_speed,
        }
    return out


def last_speed(m: Mechanism) -> float:
    """Where a run ends (rad/s)."""
    return BEYOND * mount_response(m, [1.0]).modes[-1].omega / TORQUE_ORDER[m.name]
