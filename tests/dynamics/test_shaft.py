"""A shaft that twists: torsional vibration and twist by textbook formulas, sizes that vary, refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError
from mbsd.measures import largest

LENGTH, DIAMETER, BORE, G = 0.4, 0.02, 0.01, 79.3e9
ROTOR, WHEEL = 0.02, 0.05


def drive_train(**shaft: Any) -> Mechanism:
    """A rotor and a flywheel on one axis."""
    m = Mechanism("drive_train", gravity=None)
    rotor, wheel = m.body("rotor", mass=5.0, inertia=ROTOR), m.body("wheel", mass=8.0, inertia=WHEEL)
    m.revolute("front", m.ground.at(0, 0), rotor.origin)
    m.revolute("rear", m.ground.at(0, 0), wheel.origin)
    m.shaft("shaft", rotor, wheel, **({"length": LENGTH, "diameter": DIAMETER} | shaft))
    return m


def stiffness(diameter: float = DIAMETER, bore: float = 0.0) -> float:
    return G * math.pi / 2.0 * ((diameter / 2.0) ** 4 - (bore / 2.0) ** 4) / LENGTH


@pytest.mark.parametrize("bore", [0.0, BORE])
def test_two_masses_on_a_shaft_swing_at_their_natural_frequency(bore: float) -> None:
    m = drive_train(bore=bore)
    m.start_moving(rotor=1.0)
    natural = math.sqrt(stiffness(bore=bore) * (1.0 / ROTOR + 1.0 / WHEEL))
    sol = m.simulate(6.0 * math.pi / natural, tolerance=1e-11)
    common = ROTOR / (ROTOR + WHEEL)
    expected = common + (1.0 - common) * np.cos(natural * sol.t)
    assert np.abs(sol.body("rotor").omega - expected).max() < 1e-7
    m.starts.clear()
    assert max(mode.frequency for mode in m.modes() if mode.frequency) == pytest.approx(natural / 2 / math.pi, rel=1e-6)


def test_it_twists_by_its_torque_and_counts_its_energy() -> None:
    m = drive_train()
    m.weld("hold", m.ground.at(0, 0), m.bodies["rotor"].origin)
    del m.joints["front"]
    m.torque("load", m.bodies["wheel"], 100.0)
    rest = m.equilibrium()
    twist = 100.0 * LENGTH / (G * math.pi * DIAMETER**4 / 32.0)
    assert rest.body("wheel").theta == pytest.approx(twist, rel=1e-9)
    assert rest.force("shaft").potential == pytest.approx(0.5 * 100.0 * twist, rel=1e-9)


def test_its_diameter_varies_in_many_simulations() -> None:
    m = drive_train()
    m.start_moving(rotor=1.0)
    thick = np.array([0.018, 0.02, 0.022])
    many = m.simulate_many(0.02, {"shaft": {"diameter": thick}}, measure={"T": largest("rotor.omega")})
    assert "in the compiled loop" in many.way
    m.change("shaft", diameter=0.022)
    alone = m.simulate(0.02)
    assert many["T"][2] == pytest.approx(alone.body("rotor").omega.max(), abs=1e-9)
    assert alone.force("shaft").effort == pytest.approx(
        -stiffness(0.022) * (alone.body("wheel").theta - alone.body("rotor").theta), rel=1e-9, abs=1e-9
    )


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"length": 0.0}, "length is 0; it must be positive"),
        ({"diameter": -0.1}, "diameter is -0.1; it must be positive"),
        ({"bore": 0.02}, "bore is 0.02 m in a shaft of 0.02 m diameter; it must be smaller"),
        ({"shear_modulus": 0.0}, "shear_modulus is 0; it must be positive"),
        ({"damping": -1.0}, "damping"),
    ],
)
def test_bad_numbers_are_refused_by_name(given: dict[str, float], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        drive_train(**given)
