"""An engine on mounts: natural frequencies of the block, and its response against linear theory."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import ModelError
from mbsd.machines.engines.block import Block, Mount, mounts_of_frequency
from mbsd.machines.engines.engine import engine

MASS, INERTIA, FREQUENCY, ZETA = 150.0, 4.0, 8.0, 0.3
PLACES = ((-0.30, 0.0), (0.30, 0.0))
SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.16, "piston_mass": 0.45, "rod_mass": 0.5}


def block() -> Block:
    return Block(MASS, INERTIA, mounts_of_frequency(MASS, FREQUENCY, PLACES, ZETA))


def test_the_natural_frequencies_of_the_block() -> None:
    """Without gravity, crank and pistons near massless: f along x and y, f_turn = (1 / 2 pi) sqrt(k sum a^2 / I)."""
    m = engine("I1", **(SIZE | {"piston_mass": 1e-6, "rod_mass": 1e-6}), flywheel=1e-6, speed=0.0, block=block())
    m.gravity = None
    stiffness = MASS * (2 * math.pi * FREQUENCY) ** 2 / 2
    turning = math.sqrt(2 * stiffness * 0.3**2 / INERTIA) / (2 * math.pi)
    frequencies = sorted({round(mode.frequency, 3) for mode in m.modes()})
    assert frequencies[0] == pytest.approx(FREQUENCY, rel=1e-4)
    assert frequencies[-1] == pytest.approx(turning, rel=1e-3)


def test_a_running_engine_shakes_its_block_as_linear_theory_says() -> None:
    """A block that moves by 0.1 mm: |Y| = F / |k - M w^2 + i c w|, M with all that moves along, order by order."""
    omega = 2 * math.pi * 20
    m = engine("I2", throws=(0, 0), **SIZE, flywheel=0.01, speed=omega, block=block())
    m.gravity = None
    sol = m.simulate(0.6, steps=12 * 72)
    oscillating = 2 * (0.45 + 0.3 * 0.5)
    total = MASS + sum(body.mass for name, body in m.bodies.items() if name not in ("ground", "block"))
    orders = sol.orders(sol.body("block").y, crank="crank", turns=1)
    first = 0.5 * oscillating * 0.04 * omega**2  # half of the first order is balanced
    stiffness, damping = MASS * (2 * math.pi * FREQUENCY) ** 2, 2 * ZETA * MASS * 2 * math.pi * FREQUENCY
    expected = first / abs(stiffness - total * omega**2 + 1j * damping * omega)
    assert orders.amplitude[orders.index(1)] == pytest.approx(expected, rel=0.02)


def test_bad_blocks_are_refused() -> None:
    with pytest.raises(ModelError, match="mass of the block is 0 kg"):
        Block(0.0, 1.0, mounts_of_frequency(1.0, 1.0, PLACES))
    with pytest.raises(ModelError, match="needs a list of Mount"):
        Block(1.0, 1.0, ())
    with pytest.raises(ModelError, match="stiffness of the mount"):
        Mount((0.0, 0.0), (-1.0, 0.0))
    with pytest.raises(ModelError, match="frequency of the mounts is -8"):
        mounts_of_frequency(1.0, -8.0, PLACES)
    assert np.isfinite(mounts_of_frequency(1.0, 8.0, PLACES)[0].stiffness[0])
