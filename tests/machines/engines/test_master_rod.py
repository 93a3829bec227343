"""Rods on a master rod: where their pistons are, when they fire, what shakes, and what is refused."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, four_stroke
from mbsd.machines.engines.block import Block, mounts_of_frequency
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.layout import named
from mbsd.machines.engines.master_rod import MasterRod

BORE, STROKE, ROD, SPEED = 0.1, 0.1, 0.22, 100.0
THROW, AROUND = STROKE / 2, 0.056
SIZE: dict[str, Any] = {"bore": BORE, "stroke": STROKE, "rod": ROD, "speed": SPEED}
MASS: dict[str, Any] = {"piston_mass": 0.5, "rod_mass": 0.6}
CYCLE = four_stroke(8.0, heat_density=2e6)


def height(pin: np.ndarray, bank: float, angle: float, around: float = AROUND, master: float = 0.0) -> np.ndarray:
    """The wrist pin along its bank, where circles about the knuckle pin meet it; ``pin``: the crank pin (complex)."""
    own, leader = 1j * cmath.exp(1j * bank), 1j * cmath.exp(1j * master)
    x, y = (pin / leader).real, (pin / leader).imag
    rod = leader * (x + np.sqrt(ROD**2 - y**2)) - pin
    knuckle = (pin + around * cmath.exp(1j * angle) * rod / ROD) / own
    # s^2 - 2 s Re K + |K|^2 - (l - k)^2 = 0, the larger root
    length = ROD - around
    return knuckle.real + np.sqrt(knuckle.real**2 - np.abs(knuckle) ** 2 + length**2)


def heights(m: Mechanism, number: int, bank: float, steps: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """(T,) the crank pin (complex) and the piston along its bank."""
    sol = m.sweep(steps=steps)
    piston = sol.body(f"piston_{number}")
    along = (piston.x + 1j * piston.y) / (1j * cmath.exp(1j * bank))
    assert np.abs(along.imag).max() < 1e-12
    return THROW * 1j * np.exp(1j * sol.body("crank").theta), along.real


@pytest.mark.parametrize("name", ["radial-3", "radial-5", "radial-7", "radial-9"])
def test_pistons_of_a_radial_engine_are_where_the_closed_form_puts_them(name: str) -> None:
    m = engine(name, **SIZE)
    count = len(named(name).cylinders)
    assert [joint for joint in m.joints if joint.startswith("pin")] == ["pin_1"]
    assert {body.z for key, body in m.bodies.items() if key not in ("ground", "crank")} == {0.0}
    assert not m.check()
    assert m.mobility().dof == 1
    for k in range(1, count):
        bank = 2 * math.pi * k / count
        pin, along = heights(m, k + 1, bank)
        assert along == pytest.approx(height(pin, bank, bank), abs=1e-12)


def test_knuckle_pins_are_where_they_are_wished() -> None:
    own = MasterRod(radius=0.05, angles=(70, 145, 215, 290), cylinder=3)
    m = engine("radial-5", **SIZE, rods=own)
    leader = 2 * 2 * math.pi / 5
    for number, angle in ((1, 70), (2, 145), (4, 215), (5, 290)):
        bank = 2 * math.pi * (number - 1) / 5
        pin, along = heights(m, number, bank)
        assert along == pytest.approx(height(pin, bank, math.radians(angle), 0.05, leader), abs=1e-12)
    assert "pin_3" in m.joints


def test_without_a_master_rod_all_rods_are_on_the_pin() -> None:
    m = engine("radial-5", **SIZE, rods="pin")
    pin, along = heights(m, 3, 2 * 2 * math.pi / 5)
    x = pin / (1j * cmath.exp(2j * 2 * math.pi / 5))
    assert along == pytest.approx(x.real + np.sqrt(ROD**2 - x.imag**2), abs=1e-12)
    assert sorted({body.z for body in m.bodies.values() if body.z is not None})[0] == pytest.approx(-0.04)


@pytest.mark.parametrize("name", ["V2", "W3", "W12"])
def test_other_engines_have_master_rods_where_they_are_wished(name: str) -> None:
    assert not any(joint.startswith("knuckle") for joint in engine(name, **SIZE).joints)
    m = engine(name, **SIZE, rods="master")
    of = named(name)
    pins = [int(joint[4:]) for joint in m.joints if joint.startswith("pin")]
    assert len(pins) == len({round(c.z, 6) for c in of.cylinders})
    cylinder, leader = of.cylinders[1], of.cylinders[0]
    pin, along = heights(m, 2, cylinder.bank)
    between = cylinder.bank - leader.bank
    assert along == pytest.approx(height(pin, cylinder.bank, between, master=leader.bank), abs=1e-12)


def test_articulated_pistons_fire_1_3_5_2_4_each_near_its_own_top_dead_centre() -> None:
    m = engine("radial-5", **SIZE, **MASS, gas=CYCLE)
    sol = m.sweep(duration=4 * math.pi / SPEED, steps=2880)
    angle = sol.body("crank").theta
    order = (1, 3, 5, 2, 4)
    assert firing(named("radial-5")).order == order
    peaks = np.array([angle[int(np.argmax(sol.force(f"gas_{k}").pressure))] for k in order])
    late = np.degrees(np.mod(peaks - peaks[0], 4 * math.pi) - 4 * math.pi / 5 * np.arange(5))
    assert np.abs(late).max() < 6.0
    fires = np.array([m.forces[f"gas_{k}"].params["fires_at"] for k in order])
    ideal = 4 * math.pi / 5 * np.arange(5)
    assert fires[1:] - ideal[1:] == pytest.approx(-(fires - ideal)[:0:-1], abs=1e-9), "one side lags, the other leads"
    assert np.degrees(np.abs(fires - ideal)[1:].min()) > 1.0
    work = sum(float(sol.force(f"gas_{k}").indicated_work[0]) for k in order)
    assert -np.trapezoid(sol.driver("motor").power, sol.t) == pytest.approx(work, rel=1e-3)


def test_the_strokes_of_articulated_pistons_are_a_little_longer() -> None:
    m = engine("radial-5", **SIZE)
    strokes = [np.ptp(heights(m, k, 2 * math.pi * (k - 1) / 5, steps=3600)[1]) for k in (1, 2, 3, 4, 5)]
    assert strokes[0] == pytest.approx(STROKE, rel=1e-6)
    assert strokes[1] == pytest.approx(strokes[4], rel=1e-6)
    assert strokes[2] == pytest.approx(strokes[3], rel=1e-6)
    assert all(1.0 < stroke / STROKE < 1.03 for stroke in strokes[1:])


def test_the_residue_of_knuckle_pins_is_that_of_the_closed_form() -> None:
    """With rods as masses at their ends: a second order turns with the shaft, twice as fast, and rods on one pin have
    none of it.
    """
    end, count = 0.3 * 0.6, 5
    unit = (0.5 + end) * THROW * SPEED**2
    theta = np.linspace(0, 2 * math.pi, 256, endpoint=False)
    pin, moment = THROW * 1j * np.exp(1j * theta), 0j
    for k in range(count):
        bank = 2 * math.pi * k / count
        own = 1j * cmath.exp(1j * bank)
        moment = moment + (0.5 + end) * height(pin, bank, bank if k else 0.0, AROUND if k else 0.0) * own
        lean = 1j * np.sqrt(1 - (pin.real / ROD) ** 2) - pin.real / ROD
        moment = moment + 0.7 * 0.6 * (pin + (AROUND * cmath.exp(1j * bank) * lean if k else 0.0))
    harmonics = np.fft.fft(moment) / 256
    left = {}
    for rods in ("pin", "master"):
        sol = engine("radial-5", **SIZE, **MASS, rods=rods, counterweight="none").sweep(steps=256)
        orders = sol.orders(sol.shaking().force, turns=1)
        left[rods] = orders
        couple = np.abs(sol.shaking().mx).max() + np.abs(sol.shaking().my).max()
        assert (couple < 1e-6 * unit) == (rods == "master"), "rods side by side leave a couple, one plane leaves none"
    orders = left["master"]
    for n in (1, 2, 3, 4):
        row = orders.index(n)
        assert orders.forward[row] == pytest.approx(n**2 * SPEED**2 * harmonics[n], abs=1e-9 * unit)
        assert orders.backward[row] == pytest.approx(n**2 * SPEED**2 * harmonics[-n], abs=1e-9 * unit)
    row = orders.index(2)
    assert abs(left["pin"].forward[row]) < 1e-9 * unit
    assert 0.3 < abs(orders.forward[row]) / unit < 0.5
    assert abs(orders.backward[row]) < 0.02 * unit


def test_a_ring_turns_with_the_pin_and_is_balanced() -> None:
    plain = engine("radial-5", **SIZE, **MASS)
    ringed = engine("radial-5", **SIZE, **MASS, rods=MasterRod(ring_mass=0.8))
    rod, heavy = plain.bodies["rod_1"], ringed.bodies["rod_1"]
    assert heavy.mass == pytest.approx(rod.mass + 0.8)
    about = [body.inertia + body.mass * body.com[0] ** 2 for body in (rod, heavy)]  # about the crank pin
    assert about[1] == pytest.approx(about[0] + 0.8 * AROUND**2)
    shaken = [np.abs(m.sweep(steps=90).shaking().force) for m in (plain, ringed)]
    assert shaken[1] == pytest.approx(shaken[0], rel=1e-6, abs=1e-6 * shaken[0].max())


def test_an_engine_on_mounts_has_a_master_rod() -> None:
    mounts = mounts_of_frequency(80.0, 12.0, [(-0.3, -0.2), (0.3, -0.2)])
    m = engine("radial-5", **SIZE, **MASS, gas=CYCLE, block=Block(80.0, 3.0, mounts))
    sol = m.simulate(0.02)
    block, rod, pin = sol.body("block"), sol.body("rod_1"), sol.body("rod_3")
    turned = rod.theta + 2 * 2 * math.pi / 5
    assert pin.x == pytest.approx(rod.x + AROUND * np.cos(turned), abs=1e-9)
    assert 0.0 < np.abs(block.y).max() < 0.01


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"rods": "fork"}, "rods 'fork'; they are 'master', 'pin' or MasterRod"),
        ({"layout": "I4", "rods": "master"}, "rods 'master', but no throw has two rods"),
        ({"rods": MasterRod(radius=-0.1)}, "radius of the knuckle pins is -0.1 m; it must be positive"),
        ({"rods": MasterRod(radius=0.2)}, "knuckle pins are 200 mm from the crank pin.*less than 170 mm"),
        ({"rods": MasterRod(angles=(72, 144))}, "2 angles for knuckle pins; a master rod here carries 4 other rods"),
        (
            {"rods": MasterRod(angles=(72, 72, 216, 288))},
            "knuckle pins of cylinders 2 and 3 are in one place, 72 degrees",
        ),
        (
            {"rods": MasterRod(radius=0.15, angles=(180, 270, 90, 0))},
            "does not let the shaft go round.*turn the knuckle",
        ),
        ({"rods": MasterRod(cylinder=6)}, "cylinder 6 of a throw has the master rod, and a throw has 5"),
        ({"rods": MasterRod(ring_mass=-1.0), **MASS}, "ring_mass of a master rod is -1 kg; it cannot be negative"),
        ({"rods": MasterRod(ring_mass=1.0)}, "ring_mass without rod_mass"),
        ({"bank_offset": 0.02}, "bank_offset is 20 mm, but rods on a master rod are in one plane"),
    ],
)
def test_invalid_requests_are_refused(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        engine(**({"layout": "radial-5"} | SIZE | arguments))
