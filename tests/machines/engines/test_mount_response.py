"""The steady vibration of a block on its mounts by linear theory, against simulation and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import ModelError, four_stroke
from mbsd.machines.engines.block import Block, Mount, mount_response, mounts_of_frequency
from mbsd.machines.engines.engine import engine

MASS, INERTIA, FREQUENCY, ZETA = 150.0, 4.0, 8.0, 0.1
PLACES = ((-0.30, -0.10), (0.30, -0.10), (0.0, 0.20))
SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.14, "piston_mass": 0.5, "rod_mass": 0.6}
LIGHT = {"piston_mass": 1e-6, "rod_mass": 1e-6}


def block(com: tuple[float, float] = (0.0, 0.0), motor_on: str = "block") -> Block:
    return Block(MASS, INERTIA, mounts_of_frequency(MASS, FREQUENCY, PLACES, ZETA), com, motor_on)


def test_the_modes_of_the_mount_study() -> None:
    """Centre of stiffness in the centre of mass: 8 Hz along x and y, and sqrt(k sum(a^2 + b^2) / I) in turning."""
    m = engine("I1", **(SIZE | LIGHT), speed=0.0, block=block())
    m.gravity = None
    stiffness = MASS * (2 * math.pi * FREQUENCY) ** 2 / 3
    turning = math.sqrt(stiffness * sum(x * x + y * y for x, y in PLACES) / INERTIA) / (2 * math.pi)
    assert turning == pytest.approx(math.sqrt(3) * FREQUENCY)
    modes = m.modes()
    assert [mode.frequency for mode in modes] == pytest.approx([FREQUENCY, FREQUENCY, turning], rel=1e-5)
    assert [mode.damping_ratio for mode in modes] == pytest.approx([ZETA, ZETA, ZETA * math.sqrt(3)], rel=1e-5)


def test_a_single_shakes_along_its_bore_as_one_mass_does() -> None:
    """|Y| = (1 - f) m r w^2 / |k - M w^2 + i c w|, f what counterweights take, and far above, (1 - f) m r / M."""
    m = engine("I1", **SIZE, speed=1.0, block=block())
    speeds = np.array([20.0, 50.0, 1e5])
    response = mount_response(m, speeds, orders=[1])
    total = MASS + sum(body.mass or 0.0 for name, body in m.bodies.items() if name not in ("ground", "block"))
    omega = 2 * math.pi * FREQUENCY
    force = 0.5 * (0.5 + 0.3 * 0.6) * 0.04 * speeds**2
    expected = force / np.abs(MASS * omega**2 - total * speeds**2 + 2j * ZETA * MASS * omega * speeds)
    assert np.abs(response.displacement[:, 0, 1]) == pytest.approx(expected, rel=1e-6)
    on_ground = expected * np.abs(MASS * omega**2 + 2j * ZETA * MASS * omega * speeds)
    assert np.abs(response.force[:, 0, 1]) == pytest.approx(on_ground, rel=1e-6)


@pytest.mark.parametrize("layout", ["I1", "I4", "V2"])
@pytest.mark.parametrize("burns", [False, True])
def test_simulated_engines_settle_to_the_response(layout: str, burns: bool) -> None:
    """Displacement, angle and force with a centre of mass beside the shaft and the torque on ground."""
    gas = four_stroke(10.0, heat_density=1e5) if burns else None
    omega = 480 * math.pi / 30
    m = engine(layout, **SIZE, block=block((0.02, 0.05), "ground"), speed=omega, gas=gas)
    response = mount_response(m, [omega])
    assert response.turns == (2 if burns else 1)
    sol = m.simulate(28 * 2 * math.pi / omega, steps=28 * 180)
    last = slice(-360, None)
    body = sol.body("block")
    mounts = sum(sol.force(f"mount_{k}").on("block").force[last] for k in (1, 2, 3))
    moved = np.stack([body.x, body.y], axis=1)[last]
    angle = body.theta[last]
    assert response.largest_displacement()[0] == pytest.approx(_largest(moved), rel=0.01)
    assert response.largest_angle()[0] == pytest.approx(_largest(angle[:, None]), rel=0.01)
    assert response.largest_force()[0] == pytest.approx(_largest(np.asarray(mounts)), rel=0.01)


def _largest(values: np.ndarray) -> float:
    return float(np.linalg.norm(values - values.mean(axis=0), axis=1).max())


def test_gas_shakes_a_block_only_whose_motor_stands_elsewhere() -> None:
    gas = four_stroke(10.0, heat_density=1e6)
    within, across = (
        mount_response(engine("I4", **SIZE, block=block(motor_on=on), speed=50.0, gas=gas), [50.0])
        for on in ("block", "ground")
    )
    assert across.largest_angle()[0] > 1e-3
    assert within.largest_angle()[0] < 1e-3 * across.largest_angle()[0]


def test_models_without_a_response_are_refused() -> None:
    on_ground = engine("I1", **SIZE, speed=10.0)
    with pytest.raises(ModelError, match="I1: mount_response: the engine stands on ground; make it with block="):
        mount_response(on_ground, [10.0])
    free = engine("I1", **SIZE, block=block())
    with pytest.raises(ModelError, match="nothing drives the shaft; make the engine with a speed"):
        mount_response(free, [10.0])
    driven = engine("I1", **SIZE, block=block(), speed=10.0)
    for speeds in ([], [0.0], [[1.0]], 10.0):
        with pytest.raises(ModelError, match="give a list of positive numbers"):
            mount_response(driven, speeds)  # pyright: ignore[reportArgumentType]
    for orders in ([0.5], [0], [65], []):
        with pytest.raises(ModelError, match="a cycle of 1 turn has those from 1 by 1; give some of them up to 64"):
            mount_response(driven, [10.0], orders)
    with pytest.raises(ModelError, match="motor_on of the block is 'floor'; it is 'block' or 'ground'"):
        Block(1.0, 1.0, (Mount((0.0, 0.0), (1.0, 1.0)),), motor_on="floor")


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
