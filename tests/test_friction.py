"""Friction of joints on their actual reactions: closed forms, sweeps against simulations, jamming, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError, constant_rate, polynomial, table
from mbsd.joint_friction import friction_along, pack_friction
from mbsd.packing import pack


def block(mu: float, slope: float = 0.0, **more: float) -> Mechanism:
    """A block of 2 kg on a plane."""
    m = Mechanism("block", gravity=(0.0, -10.0))
    body = m.body("block", 2.0, inertia=0.1)
    m.prismatic("plane", m.ground.at(0, 0, slope), body.origin)
    m.friction("rub", "plane", mu, **more)
    return m


def slider_crank(mu: float) -> Mechanism:
    """Friction in all four joints and a load on the slider."""
    m = Mechanism("slider_crank", gravity=(0.0, -9.81))
    crank, rod = m.bar("crank", 0.1, mass=1.0), m.bar("rod", 0.3, mass=1.0)
    slider = m.body("slider", 2.0, inertia=0.01)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("D", m.ground.at(0, 0), slider.origin)
    for pin in "ABC":
        m.friction(f"rub {pin}", pin, mu, static=1.3 * mu, radius=0.01, viscous=0.002)
    m.friction("rub D", m.joints["D"], mu, guide=0.05, preload=3.0)
    m.force("load", slider.origin, -100.0)
    m.start_near(crank=30, rod=-10, slider=(0.35, 0, 0))
    return m


def pushed_off_centre(mu: float, offset: float) -> Mechanism:
    """A block in a guide of 0.1 m, pushed against 100 N by a rod beside its middle."""
    m = Mechanism("drawer", gravity=None)
    body = m.body("block", 1.0, inertia=0.1)
    m.prismatic("guide", m.ground.at(0, 0), body.origin)
    m.friction("rub", "guide", mu, guide=0.1)
    m.force("load", body.origin, -100.0)
    m.drive_distance("push", m.ground.at(-1.0, offset), body.at(0.0, offset), polynomial(1.0, 0.5))
    m.start_near(block=(0.0, 0.0, 0.0))
    return m


def test_a_sliding_block_stops_after_its_way() -> None:
    m = block(0.3)
    m.start_moving(block=(3.0, 0.0, 0.0))
    sol = m.simulate(1.5, steps=15, tolerance=1e-9)
    before = sol.t < 0.99
    np.testing.assert_allclose(sol.body("block").x[before], (3.0 * sol.t - 1.5 * sol.t**2)[before], atol=1e-7)
    assert sol.body("block").x[-1] == pytest.approx(1.5, abs=1e-6)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-9
    assert sol.work is not None
    assert sol.work[-1] == pytest.approx(-9.0, abs=1e-6)


def test_a_block_slides_down_a_slope_and_a_steady_one_creeps() -> None:
    slope = 0.5
    sol = block(0.3, slope).simulate(1.0, steps=4, tolerance=1e-9)
    along = -10.0 * (math.sin(slope) - 0.3 * math.cos(slope))
    assert sol.body("block").vx[-1] == pytest.approx(along * math.cos(slope), abs=1e-3)
    steady = block(0.3, 0.2).simulate(1.0, steps=4, tolerance=1e-9).body("block")
    creep = 0.001 * math.atanh(math.tan(0.2) / 0.3)
    assert steady.vx[-1] == pytest.approx(-creep * math.cos(0.2), rel=1e-6)


def test_a_disc_spins_down_by_dry_and_viscous_friction_of_its_pin() -> None:
    m = Mechanism("spin", gravity=(0.0, -10.0))
    disc = m.body("disc", 5.0, inertia=0.2)
    m.revolute("pin", m.ground.at(0, 0), disc.origin)
    m.friction("rub", "pin", 0.2, radius=0.02, viscous=0.1, preload=10.0)
    m.start_moving(disc=10.0)
    sol = m.simulate(2.0, steps=10, tolerance=1e-10)
    dry, decay = 0.2 * 0.02 * 60.0 / 0.1, 0.1 / 0.2
    np.testing.assert_allclose(sol.body("disc").omega, (10.0 + dry) * np.exp(-decay * sol.t) - dry, atol=1e-6)


@pytest.mark.parametrize("rate", [1e-4, 0.02, 0.5, 5.0])
def test_the_driver_feels_stribecks_curve(rate: float) -> None:
    m = Mechanism("curve", gravity=(0.0, -10.0))
    disc = m.body("disc", 5.0, inertia=0.2)
    m.revolute("pin", m.ground.at(0, 0), disc.origin)
    m.friction("rub", "pin", 0.1, static=0.25, radius=0.05, stribeck_speed=0.02, smoothing=0.002)
    m.drive_angle("motor", disc, constant_rate(rate))
    speed = 0.05 * rate
    mu = (0.1 + 0.15 * math.exp(-((speed / 0.02) ** 2))) * math.tanh(speed / 0.002)
    sol = m.sweep(1.0, steps=3)
    np.testing.assert_allclose(sol.driver("motor").torque, 0.05 * 50.0 * mu, rtol=1e-12)
    np.testing.assert_allclose(sol.joint("pin").fy, 50.0, rtol=1e-12)


def test_couple_on_a_guide_bears_at_its_ends() -> None:
    sol = pushed_off_centre(0.2, 0.03).sweep(0.1, steps=4)
    # F = 100 + 0.2 * 2 F 0.03 / 0.1
    np.testing.assert_allclose(sol.driver("push").force, 100.0 / (1 - 0.12), rtol=1e-12)
    assert sol.stats.power_residual < 1e-10


def test_a_drawer_that_jams_is_told() -> None:
    with pytest.raises(SimulationError, match=r"drawer: at t = 0 s friction 'rub' .* jams"):
        pushed_off_centre(0.2, 0.3).sweep(0.1, steps=4)
    with pytest.raises(SimulationError, match=r"drawer: .* stops at t = 0 s"):
        pushed_off_centre(0.2, 0.3).simulate(0.1, steps=4)


@pytest.mark.parametrize("mu", [0.05, 0.4])
def test_sweep_and_simulation_agree(mu: float) -> None:
    m = slider_crank(mu)
    m.drive_angle("motor", m.bodies["crank"], constant_rate(10.0))
    swept = m.sweep(steps=24)
    simulated = m.simulate(float(swept.t[-1]), steps=24, tolerance=1e-10)
    np.testing.assert_allclose(simulated.lam, swept.lam, atol=1e-9 * np.abs(swept.lam).max())
    assert swept.stats.power_residual < 1e-10
    assert simulated.stats.power_residual < 1e-8
    m.forces.clear()
    m.force("load", m.bodies["slider"].origin, -100.0)
    assert (swept.driver("motor").torque[1:] > m.sweep(steps=24).driver("motor").torque[1:]).all()


def test_efforts_of_the_sweep_return_the_motion() -> None:
    driven = slider_crank(0.2)
    driven.drive_angle("motor", driven.bodies["crank"], constant_rate(10.0))
    swept = driven.sweep(0.3, steps=600)
    free = slider_crank(0.2)
    effort = swept.driver("motor").torque
    free.torque("motor", free.bodies["crank"], table(swept.t, effort))
    free.start_near(crank=math.degrees(swept.body("crank").theta[0]))
    free.start_moving(crank=10.0)
    sol = free.simulate(0.3, steps=30, tolerance=1e-6)
    np.testing.assert_allclose(sol.body("crank").theta, swept.body("crank").theta[::20], atol=2e-3)


def test_friction_only_takes_energy() -> None:
    m = slider_crank(0.3)
    m.forces.pop("load")
    m.start_moving(crank=20.0)
    sol = m.simulate(0.5, tolerance=1e-8)
    assert sol.audit is not None
    assert sol.work is not None
    assert np.ptp(sol.audit) < 1e-5
    assert (np.diff(sol.work) < 1e-9).all()
    assert sol.work[-1] < -0.1


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "pin_in_slot"])
def test_bodies_of_a_joint_take_opposite_friction(kind: str) -> None:
    random = np.random.default_rng(4)
    m = Mechanism("pair")
    first, second = (m.body(name, 1.0, random.normal(size=2).tolist(), 1.0) for name in ("first", "second"))
    joint = getattr(m, kind)("joint", first.at(*random.normal(size=3)), second.at(*random.normal(size=3)))
    guide = 0.2 if kind == "prismatic" else 0.0
    m.friction("rub", joint, 0.3, radius=0.1 if kind == "revolute" else 0.0, guide=guide, viscous=0.2)
    packed = pack(m)
    q, v = random.normal(size=(2, 5, 9))
    lam = random.normal(size=(5, joint.kind.rows))
    q[:, :3] = v[:, :3] = 0.0
    load = friction_along(packed, pack_friction(packed), q, v, lam).reshape(5, 3, 3)
    place = q.reshape(5, 3, 3)
    moment = load[..., 2] + place[..., 0] * load[..., 1] - place[..., 1] * load[..., 0]
    assert np.abs(load[:, 1:]).max() > 0.01
    np.testing.assert_allclose(load[..., :2].sum(axis=1), 0.0, atol=1e-13)
    np.testing.assert_allclose(moment.sum(axis=1), 0.0, atol=1e-13)
    assert ((load * v.reshape(5, 3, 3)).sum(axis=(1, 2)) < 0).all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("pin", -0.1), "coefficient is -0.1"),
        (("pin", math.nan), "finite"),
        (("pin", 0.1), "needs its radius"),
        (("pin", 0.0, 0.2), "needs its radius"),
        (("pin", 0.1, 0.05, 0.01), "static is 0.05; it cannot be below"),
        (("pin", 0.1, None, 0.01, 0.02), "a revolute joint has no guide"),
        (("slide", 0.1, None, 0.01), "a prismatic joint has no radius"),
        (("weld", 0.1), "'weld' is a weld"),
        (("hinge", 0.1), "there is no joint 'hinge'; there is: pin, slide, weld"),
    ],
)
def test_wrong_friction_is_refused_when_built(arguments: tuple, words: str) -> None:
    m = Mechanism("refused")
    body = m.body("body", 1.0)
    for kind, name in (("revolute", "pin"), ("prismatic", "slide"), ("weld", "weld")):
        getattr(m, kind)(name, m.ground.origin, body.origin)
    with pytest.raises(ModelError, match=words):
        m.friction("rub", *arguments)
    other = Mechanism("other")
    with pytest.raises(ModelError, match="needs a joint of this mechanism"):
        other.friction("rub", m.joints["pin"], 0.1, radius=0.01)
    assert not m.forces


def test_a_long_chain_with_friction_settles_too() -> None:
    m = Mechanism("chain")
    before = m.ground.at(0, 0)
    for k in range(40):
        link = m.bar(f"link{k}", 0.1, mass=0.1)
        m.revolute(f"pin{k}", before, link.start)
        m.friction(f"rub{k}", f"pin{k}", 0.2, radius=0.005)
        m.start_near(**{link.name: -80.0})
        before = link.end
    sol = m.simulate(0.2, steps=2, tolerance=1e-6)
    assert sol.audit is not None
    assert sol.work is not None
    assert sol.stats.power_residual < 1e-8
    assert np.ptp(sol.audit) < 1e-4
    assert sol.work[-1] < -1e-4
