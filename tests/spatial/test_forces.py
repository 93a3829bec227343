"""Forces in space against published numbers and closed forms; each kind balances in a sweep and in a simulation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.base.errors import ModelError
from mbsd.spatial import Mechanism, constant_rate, harmonic
from mbsd.spatial.model.force import FORCE_KINDS
from tests.spatial import machines
from tests.spatial.machines import about


def test_a_flyball_governor() -> None:
    """IFToMM benchmark A05, with the start speed of its reference curve (2 pi rad/s): slider at .1, .5, 1 and 2 s."""
    m = Mechanism("governor", gravity=(0, 0, -9.81))
    shaft = m.body("shaft", 0.3, com=(0, 0, 0.5), inertia=_box(0.3, 0.01, 0.01, 1.0))
    slider = m.body("slider", 3.0, com=(0, 0, 0.5), inertia=_box(3.0, 0.1, 0.1, 0.1))
    m.revolute("bearing", m.ground, shaft, at=(0, 0, 0), axis=(0, 0, 1))
    m.prismatic("sleeve", shaft, slider, at=(0, 0, 0.5), axis=(0, 0, 1))
    for name, side in (("right", 1.0), ("left", -1.0)):
        hinge = np.array([0.05 * side, 0, 1.0])
        turned = about((0, 1, 0), side * math.radians(30))
        along = turned @ np.array([side, 0, 0])
        com = (0.3 * 0.5 + 5.0) / 5.3  # a rod of .3 kg with 5 kg at its end
        moment = _box(0.3, 1.0, 0.01, 0.01)
        moment[1:] += 0.3 * (com - 0.5) ** 2 + 5.0 * (1.0 - com) ** 2
        rod = m.body(f"rod {name}", 5.3, com=hinge + com * along, inertia=turned @ np.diag(moment) @ turned.T)
        m.revolute(f"hinge {name}", shaft, rod, at=hinge, axis=(0, 1, 0))
        foot = np.array([0.05 * side, 0, 0.5])
        m.spring(
            f"spring {name}", slider, rod, start=foot, end=hinge + 0.5 * along, stiffness=8e5, damping=4e4, length=0.5
        )
    m.start_moving({"bearing": 2 * math.pi, "sleeve": 0.0, "hinge right": 0.0, "hinge left": 0.0})
    sol = m.simulate(times=[0.0, 0.1, 0.5], tolerance=1e-6)
    height = 0.5 + sol.joint("sleeve").slide
    assert height[1:] == pytest.approx([0.5238364755695756, 0.743249424786327], abs=1e-6)
    assert sol.joint("bearing").turn_rate[1:] == pytest.approx([6.103717808830871, 5.103415421971547], abs=1e-5)


def _box(mass: float, x: float, y: float, z: float) -> np.ndarray:
    """Return the moments (3,) of a box of sides x, y, z (m)."""
    return mass / 12 * np.array([y * y + z * z, z * z + x * x, x * x + y * y])


def test_a_bevel_differential_shares_torques() -> None:
    """Closed form: torques 3 on the carrier and -1 on the left wheel against it, by Lagrange's equations."""
    m = Mechanism("bevel differential", gravity=None)
    carrier = m.body("carrier", 1.0, inertia=(2.0, 2.0, 2.0))
    m.revolute("carrier bearing", m.ground, carrier, at=(0, 0, 0), axis=(1, 0, 0))
    for name, axis in (("left", (1, 0, 0)), ("right", (1, 0, 0))):
        wheel = m.body(name, 1.0, inertia=(1.0, 1.0, 1.0))
        m.revolute(f"{name} bearing", carrier, wheel, at=(0, 0, 0), axis=axis)
    planet = m.body("planet", 1.0, com=(0, 0.1, 0), inertia=(0.1, 0.1, 0.1))
    m.revolute("planet bearing", carrier, planet, at=(0, 0.1, 0), axis=(0, 1, 0))
    m.gear_pair("left teeth", "left bearing", "planet bearing", teeth=(20, 12), internal=True)
    m.gear_pair("right teeth", "right bearing", "planet bearing", teeth=(20, 12))
    m.torque("motor", "carrier bearing", 3.0)
    whole = m.body("load", 1.0, inertia=(1e-9, 1e-9, 1e-9))
    m.revolute("load bearing", m.ground, whole, at=(0, 0, 0), axis=(1, 0, 0))
    m.fixed("coupling", m.bodies["left"], whole, at=(0, 0, 0))
    m.torque("brake", "load bearing", -1.0)
    sol = m.simulate(times=[0.0, 0.01], tolerance=1e-9)
    assert sol.joint("carrier bearing").turn_acceleration[0] == pytest.approx(0.4866180048661798, abs=1e-7)
    assert sol.joint("left bearing").turn_acceleration[0] == pytest.approx(-0.43902439024390205, abs=1e-7)
    assert sol.joint("right bearing").turn_acceleration[0] == pytest.approx(0.43902439024390205, abs=1e-7)
    assert abs(sol.joint("planet bearing").turn_acceleration[0]) == pytest.approx(0.7317073170731705, abs=1e-7)


def test_a_torsion_pendulum_swings_with_its_period() -> None:
    m = Mechanism("torsion pendulum", gravity=None)
    disc = m.body("disc", 1.0, inertia=(0.2, 0.2, 0.3))
    m.revolute("wire", m.ground, disc, at=(0, 0, 0), axis=(1, 2, 2))
    m.torsion_spring("twist", "wire", stiffness=3.0, free=0.4)
    axis = np.array([1, 2, 2]) / 3.0
    moment = axis @ np.diag([0.2, 0.2, 0.3]) @ axis
    sol = m.simulate(duration=2.0, steps=40, tolerance=1e-11)
    wanted = 0.4 * (1.0 - np.cos(math.sqrt(3.0 / moment) * sol.t))
    assert np.allclose(sol.joint("wire").turn, wanted, rtol=0, atol=1e-8)
    assert np.allclose(sol.force("twist").effort, 3.0 * (0.4 - wanted), rtol=0, atol=1e-7)
    assert np.ptp(sol.energy.total) < 1e-9


def test_drivers_hold_against_springs_and_torques() -> None:
    """In a sweep at rest, efforts are those of statics."""
    m = Mechanism("held", gravity=None)
    arm = m.rod("arm", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.05)
    m.revolute("hinge", m.ground, arm, at=(0, 0, 0), axis=(0, 0, 1))
    m.drive_turn("hand", "hinge", constant_rate(0.0))
    m.spring("spring", m.ground, arm, start=(1, -2, 0), end=(1, 0, 0), stiffness=10.0, length=1.5)
    m.actuator("jack", m.ground, arm, harmonic(0.0, 1.0, mean=4.0), start=(1, 0, 1), end=(1, 0, 0))
    m.torque("motor", "hinge", 2.0)
    sol = m.sweep(duration=1.0, steps=4)
    assert np.allclose(sol.force("spring").effort, -5.0, rtol=0, atol=1e-12)
    assert np.allclose(sol.driver("hand").torque, 5.0 - 2.0, rtol=0, atol=1e-12)
    assert np.allclose(sol.joint("hinge").force, [0.0, 5.0, 4.0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("kind", FORCE_KINDS)
def test_work_of_every_force_is_the_energy_that_is_gained(kind: str) -> None:
    m = Mechanism("energy", gravity=(0, 0, -9.81))
    first = m.body("first", 1.0, com=(0.1, 0, 0), inertia=(0.3, 0.4, 0.5))
    second = m.body("second", 2.0, com=(0.4, 0.3, 0.2), inertia=(0.5, 0.4, 0.3))
    FORCE_KINDS[kind].example(m, first, second)
    m.start_moving({"first": (0.3, 0.2, -0.4), "second": (0.1, -0.5, 0.3)})
    sol = m.simulate(duration=0.5, steps=10, tolerance=1e-11)
    energy = sol.energy
    spring = energy.total - energy.kinetic
    weight = -sum(body.mass * sol.place(body.marker(body.com)).place @ np.array(m.gravity) for body in (first, second))
    gained = energy.kinetic + weight
    assert sol.work is not None
    assert np.allclose(gained - gained[0], sol.work, rtol=0, atol=1e-8)
    assert np.isfinite(spring).all()
    assert sol.stats.power_residual < 1e-8


def test_forces_that_cannot_be_are_refused() -> None:
    m = Mechanism("forces")
    a = m.rod("a", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.1)
    with pytest.raises(ModelError, match="stiffness is -1; it cannot be negative"):
        m.spring("spring", m.ground, a, start=(0, 0, 1), end=(0, 0, 0), stiffness=-1.0)
    with pytest.raises(ModelError, match="no joint 'hinge'"):
        m.torque("motor", "hinge", 1.0)
    with pytest.raises(ModelError, match="must be finite"):
        m.drag("air", a, damping=math.nan)


def test_a_block_slides_down_with_the_friction_of_its_guide() -> None:
    """Closed forms: a = g (sin - mu cos), and with a guide of length L under a moment N = 2 |M| / L."""
    tilt, mu = math.radians(30), 0.2
    down, normal = np.array([math.cos(tilt), 0, -math.sin(tilt)]), np.array([math.sin(tilt), 0, math.cos(tilt)])
    for length, lever in ((0.0, 0.0), (0.1, 0.3)):
        m = Mechanism("incline", gravity=(0, 0, -9.81))
        block = m.body("block", 2.0, com=tuple(lever * down), inertia=(0.1, 0.1, 0.1))
        m.prismatic("guide", m.ground, block, at=(0, 0, 0), axis=down)
        m.friction("brakes", "guide", mu, length=length)
        m.start_moving({"guide": 0.5})
        sol = m.simulate(duration=0.5, steps=10, tolerance=1e-11)
        weight = 2.0 * 9.81 * math.cos(tilt)
        pressed = weight if lever == 0.0 else 2.0 * weight * lever / length
        wanted = 9.81 * math.sin(tilt) - mu * pressed / 2.0
        assert np.allclose(sol.joint("guide").slide_acceleration[:2], wanted, rtol=0, atol=1e-9)
        assert np.allclose(sol.joint("guide").force @ normal, weight, rtol=0, atol=1e-9)
        assert np.allclose(sol.force("brakes").effort[:2], -mu * pressed, rtol=0, atol=1e-9)


def test_a_pendulum_loses_its_swing_to_the_friction_of_its_pin() -> None:
    """Against scipy: I x'' = -m g c cos x - mu r |R| sign(x'), R from weight and acceleration of the mass."""
    from scipy.integrate import solve_ivp

    mass, c, inertia, mu, radius, slip = 2.0, 0.6, 0.15, 0.3, 0.05, 0.02
    m = Mechanism("pendulum", gravity=(0, 0, -9.81))
    rod = m.body("rod", mass, com=(c, 0, 0), inertia=(0.1, inertia, 0.1))
    m.revolute("pin", m.ground, rod, at=(0, 0, 0), axis=(0, -1, 0))
    m.friction("brakes", "pin", mu, radius=radius, static=0.5, stribeck=0.1, viscous=0.02, slip_speed=slip)
    sol = m.simulate(duration=3.0, steps=30, tolerance=1e-10)
    whole = inertia + mass * c * c

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, w = y
        s = radius * w
        size = (mu + 0.2 * math.exp(-((s / 0.1) ** 2))) * math.tanh(s / slip) * radius
        bend = 0.0
        for _ in range(200):
            along = mass * (-c * w * w + 9.81 * math.sin(x))
            across = mass * (c * bend + 9.81 * math.cos(x))
            bend = (-mass * 9.81 * c * math.cos(x) - size * math.hypot(along, across) - 0.02 * w) / whole
        return [w, bend]

    exact = solve_ivp(rates, (0, 3), [0.0, 0.0], t_eval=sol.t, rtol=1e-10, atol=1e-12).y[0]
    assert np.allclose(sol.joint("pin").turn, exact, rtol=0, atol=1e-7)
    gained = sol.energy.total - sol.energy.total[0]
    assert sol.work is not None
    assert np.allclose(gained, sol.work, rtol=0, atol=1e-7)
    assert sol.stats.power_residual < 1e-8


def test_a_sweep_has_the_friction_of_a_simulation() -> None:
    m = machines.slider_crank()
    m.friction("rail friction", "rail", 0.2, length=0.05)
    m.friction("pin friction", "bearing", 0.1, radius=0.01, slip_speed=0.01)
    swept = m.sweep(duration=0.3, steps=6)
    simulated = m.simulate(duration=0.3, steps=6, tolerance=1e-11)
    assert np.allclose(swept.driver("motor").torque, simulated.driver("motor").torque, rtol=0, atol=1e-7)
    assert np.allclose(swept.force("rail friction").effort, simulated.force("rail friction").effort, rtol=0, atol=1e-7)
    rail = swept.joint("rail")
    moment = 2 * np.linalg.norm(rail.moment, axis=1) / 0.05
    pressed = np.maximum(rail.magnitude, moment)
    assert np.allclose(np.abs(swept.force("rail friction").effort[1:]), 0.2 * pressed[1:], rtol=0, atol=1e-9)
    assert swept.stats.power_residual < 1e-9
    loop = machines.bennett()
    loop.friction("brakes", "hinge 0", 0.1, radius=0.01)
    with pytest.raises(ModelError, match="'brakes' is friction, and joints repeat each other"):
        loop.sweep()
    with pytest.raises(ModelError, match="'cross' is universal; friction needs"):
        m.friction("other", "cross", 0.1)
    with pytest.raises(ModelError, match="a revolute joint needs the radius of its pin"):
        m.friction("other", "bearing", 0.1)
