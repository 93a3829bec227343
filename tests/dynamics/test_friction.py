"""Friction of joints from their actual reactions: closed forms, forward and inverse, and what cannot be."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError, constant_rate, polynomial, table
from mbsd.arrays.friction_along import normals_along
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import pack
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.equations.joint_friction import X, tabulate_friction
from mbsd.testing.forces import motion
from tools.models.rough import pusher
from tools.models.sticking import slider_crank

G = 9.80665


@pytest.mark.parametrize("joint", ["revolute", "prismatic", "pin_in_slot"])
@pytest.mark.parametrize("ground", ["i", "j", None])
def test_power_and_reaction_of_each_joint(joint: str, ground: str | None) -> None:
    random = np.random.default_rng(4)
    m = Mechanism("example")
    a = m.ground if ground == "i" else m.body("a", 1.0, (0.3, -0.2), 1.0)
    b = m.ground if ground == "j" else m.body("b", 1.0, (-0.1, 0.4), 1.0)
    getattr(m, joint)("joint", a.at(*random.normal(size=3)), b.at(*random.normal(size=3)))
    radius = 0.3 if joint == "revolute" else 0.0
    m.friction("rub", "joint", 0.3, static=0.5, stribeck=1.0, viscous=0.2, radius=radius, preload=1.0, slip_speed=0.5)
    packed = pack(m)
    loads = pack_loads(packed)
    t, q, v = motion(packed, 2)
    normal = np.abs(np.sin(3.0 * t))[:, None]
    load, power = np.zeros_like(q), np.zeros(len(t))
    tabulate_friction(packed.system, loads, q, v, normal, packed.ws, load, power)
    np.testing.assert_allclose(power, (load * v)[:, 3:].sum(axis=1), atol=1e-12)
    assert (power < 0.0).all()
    load, place = load.reshape(len(t), -1, 3), q.reshape(len(t), -1, 3)
    moment = load[..., 2] + place[..., 0] * load[..., 1] - place[..., 1] * load[..., 0]
    np.testing.assert_allclose(load[..., :2].sum(axis=1), 0.0, atol=1e-12)
    np.testing.assert_allclose(moment.sum(axis=1), 0.0, atol=1e-12)


@pytest.mark.parametrize("turned", [False, True], ids=["ground first", "ground second"])
def test_a_block_slides_down_an_incline(turned: bool) -> None:
    angle, mu = 0.5, 0.3
    m = Mechanism("incline")
    block = m.body("block", 2.0, inertia=0.1)
    if turned:
        m.prismatic("plane", block.at(0, 0, 0.0), m.ground.at(0, 0, angle))
    else:
        m.prismatic("plane", m.ground.at(0, 0, angle), block.origin)
    m.friction("rub", "plane", mu, slip_speed=1e-5)
    m.start_near(block=(0.0, 0.0, math.degrees(angle)))
    sol = m.simulate(1.0, tolerance=1e-9)
    down = G * (math.sin(angle) - mu * math.cos(angle)) * sol.t**2 / 2
    travel = -(sol.body("block").x * math.cos(angle) + sol.body("block").y * math.sin(angle))
    np.testing.assert_allclose(travel, down, atol=2e-5)
    assert sol.stats.power_residual < 1e-9
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-6


def test_a_block_on_a_gentle_incline_all_but_rests() -> None:
    angle, mu, slip = 0.2, 0.3, 1e-4
    m = Mechanism("incline")
    block = m.body("block", 2.0, inertia=0.1)
    m.prismatic("plane", m.ground.at(0, 0, angle), block.origin)
    m.friction("rub", "plane", mu, slip_speed=slip)
    m.start_near(block=(0.0, 0.0, math.degrees(angle)))
    view = m.simulate(0.05, steps=10).body("block")
    creep = slip * math.atanh(math.tan(angle) / mu)
    assert np.hypot(view.vx[-1], view.vy[-1]) == pytest.approx(creep, rel=1e-4)


def test_a_pendulum_loses_as_much_each_swing_to_the_friction_of_its_pin() -> None:
    """Small swings of a slow pendulum: the pin carries the weight, and the amplitude falls by 4 mu r m g / (m g l)."""
    length, mu, radius = 1.0, 0.05, 0.005
    m = Mechanism("pendulum")
    bob = m.body("bob", 3.0, inertia=1e-9)
    m.revolute("pin", m.ground.at(0, 0), bob.at(0.0, length))
    m.friction("rub", "pin", mu, radius=radius, slip_speed=1e-7)
    m.start_near(bob=math.degrees(0.01))
    half = math.pi * math.sqrt(length / G)
    view = m.simulate(times=half * np.arange(5), tolerance=1e-9).body("bob")
    step = 2 * mu * radius / length
    expected = (0.01 - step * np.arange(5)) * (-1.0) ** np.arange(5)
    np.testing.assert_allclose(view.theta, expected, atol=5e-7)


def test_stribeck_and_viscous_slow_a_wheel_pressed_by_a_preload() -> None:
    m = Mechanism("wheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=0.5)
    m.revolute("axle", m.ground.at(0, 0), wheel.origin)
    m.friction("rub", "axle", 0.1, static=0.4, stribeck=0.2, viscous=0.03, radius=0.05, preload=20.0, slip_speed=1e-3)
    m.start_moving(wheel=8.0)
    sol = m.simulate(0.5, tolerance=1e-10)
    omega, alpha = sol.body("wheel").omega, sol.body("wheel").alpha
    slip = 0.05 * omega
    mu = 0.1 + 0.3 * np.exp(-((slip / 0.2) ** 2))
    np.testing.assert_allclose(0.5 * alpha, -mu * np.tanh(slip / 1e-3) * 20.0 * 0.05 - 0.03 * omega, atol=1e-12)


def test_a_loaded_brake_shoe_stops_a_slider() -> None:
    """A loaded shoe on its lining, a pin in a slot."""
    m = Mechanism("brake", gravity=None)
    slider, shoe = m.body("slider", 2.0, inertia=1.0), m.body("shoe", 0.5, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), slider.origin)
    m.prismatic("press", m.ground.at(0, 0.1, math.pi / 2), shoe.origin)
    m.pin_in_slot("lining", slider.at(0, 0.1), shoe.origin)
    m.force("load", shoe.origin, 50.0, direction=(0, -1))
    m.friction("rub", "lining", 0.4, slip_speed=1e-5)
    m.start_near(slider=(0.0, 0.0, 0.0), shoe=(0.0, 0.1, 90.0))
    m.start_moving(slider=(3.0, 0.0, 0.0))
    sol = m.simulate(0.25, tolerance=1e-9)
    assert np.abs(sol.joint("lining").magnitude).max() <= 50.0 + 1e-9
    np.testing.assert_allclose(sol.body("slider").vx, 3.0 - 0.4 * 50.0 / 2.0 * sol.t, atol=1e-5)


def test_a_slider_pressed_by_a_driver_takes_its_force_and_friction() -> None:
    """The slider is driven along its slot while another driver presses it with a spring between them."""
    m = Mechanism("pressed", gravity=None)
    table_, slider, press = m.body("table", 1.0, inertia=1.0), m.body("slider", 2.0, inertia=1.0), m.body("press", 1.0)
    m.prismatic("feed", m.ground.at(0, 0), slider.origin)
    m.drive_coordinate("pull", m.ground.at(0, 0), slider.origin, polynomial(0.0, 0.5))
    m.prismatic("lift", m.ground.at(0, 0.2, math.pi / 2), press.origin)
    m.drive_coordinate("push", m.ground.at(0, 0.2, math.pi / 2), press.origin, polynomial(0.5, -0.3))
    m.prismatic("ground", m.ground.at(0, 0.1, math.pi / 2), table_.origin)
    m.spring("spring", table_.at(0, 0, 0), press.origin, 400.0, free_length=0.6)
    m.pin_in_slot("lining", slider.at(0, 0.1), table_.origin)
    m.friction("rub", "lining", 0.3, slip_speed=1e-6)
    m.start_near(slider=(0, 0, 0), press=(0, 0.7, 90), table=(0, 0.1, 90))
    sol = m.sweep(0.5, steps=5)
    pressed = 400.0 * 0.3 * sol.t
    np.testing.assert_allclose(sol.driver("push").force, -pressed, atol=1e-9)
    np.testing.assert_allclose(sol.driver("pull").force, 0.3 * pressed, atol=1e-9)


def test_a_slider_that_tilts_is_held_by_its_edges() -> None:
    """A force off the guide's line presses the two edges; the friction on them belongs to the same equation."""
    mu, length, lever, force = 0.2, 0.1, 0.06, 40.0
    m = Mechanism("tilted", gravity=None)
    slider = m.body("slider", 2.0, inertia=0.3)
    m.prismatic("rail", m.ground.at(0, 0), slider.origin)
    m.friction("rub", "rail", mu, length=length, slip_speed=1e-6)
    m.force("push", slider.at(0, lever), force)
    m.start_moving(slider=(0.5, 0.0, 0.0))
    sol = m.simulate(0.3)
    rub = mu * 2 * force * lever / length
    np.testing.assert_allclose(sol.body("slider").ax, (force - rub) / 2.0, rtol=1e-9)


@pytest.mark.parametrize("lever", [-0.6, -0.12, 0.02, 0.12])
def test_friction_that_presses_its_own_joint_is_found_at_once(lever: float) -> None:
    """A shoe on a lever l, pivoted h below its lining (self-energising) or above it: N = F l / (l - mu h).

    At h = -0.6 m plain repetition would diverge.
    """
    mu, arm = 0.4, 0.2
    normal = 30.0 * arm / (arm - mu * lever)
    m = Mechanism("shoe brake", gravity=None)
    belt, shoe = m.body("belt", 1.0, inertia=1.0), m.body("shoe", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), belt.origin)
    m.revolute("pivot", m.ground.at(-arm, -lever), shoe.at(-arm, -lever))
    m.pin_in_slot("lining", belt.origin, shoe.origin)
    m.force("load", shoe.origin, 30.0, direction=(0, -1))
    m.friction("rub", "lining", mu, slip_speed=1e-6)
    m.start_near(belt=(0.0, 0.0, 0.0), shoe=(0.0, 0.0, 0.0))
    m.start_moving(belt=(2.0, 0.0, 0.0))
    sol = m.simulate(0.01, steps=5)
    np.testing.assert_allclose(sol.joint("lining").magnitude, normal, rtol=1e-9)
    np.testing.assert_allclose(sol.body("belt").ax, -mu * normal, rtol=1e-9)


def _slider_crank() -> Mechanism:
    m = slider_crank()
    for pin in "OAB":
        m.friction(f"rub {pin}", pin, 0.15, static=0.2, radius=0.02, viscous=1e-3)
    m.friction("rub", m.joints["rail"], 0.2, length=0.08, preload=2.0)
    return m


def test_a_sweep_feels_what_a_simulation_feels() -> None:
    driven = _slider_crank()
    driven.drive_angle("motor", driven.bodies["crank"], constant_rate(20.0, math.radians(30)))
    swept, run = driven.sweep(0.2, steps=40), driven.simulate(0.2, steps=40, tolerance=1e-10)
    assert swept.stats.power_residual < 1e-9 * np.abs(swept.driver("motor").power).max()
    np.testing.assert_allclose(run.driver("motor").torque, swept.driver("motor").torque, atol=1e-5)
    for joint in driven.joints:
        np.testing.assert_allclose(run.joint(joint).reaction, swept.joint(joint).reaction, atol=1e-4)
    assert run.stats.power_residual < 1e-8
    free = Mechanism("without")
    free.__dict__.update({k: v for k, v in driven.__dict__.items() if k != "forces"})
    gap = swept.driver("motor").torque - free.sweep(0.2, steps=40).driver("motor").torque
    assert gap.min() > 0.01, "friction takes torque all the way round"


def test_the_efforts_of_a_sweep_give_its_motion_back() -> None:
    driven = _slider_crank()
    driven.drive_angle("motor", driven.bodies["crank"], polynomial(math.radians(30), 15.0, 20.0))
    swept = driven.sweep(0.1, steps=200)
    m = _slider_crank()
    m.torque("motor", m.bodies["crank"], table(swept.t, swept.driver("motor").torque))
    m.start_moving(crank=15.0)
    run = m.simulate(0.1, steps=10, tolerance=1e-9)
    np.testing.assert_allclose(run.body("crank").theta, swept.body("crank").theta[::20], atol=1e-5)


def test_another_actuator_carries_the_friction_too() -> None:
    """The crank's torque or a push on the slider make one motion; the push has other reactions and other friction."""
    m = _slider_crank()
    m.drive_angle("motor", m.bodies["crank"], constant_rate(20.0, math.radians(30)))
    m.force("pull", m.bodies["slider"].origin, 0.0)
    motion = m.sweep(0.05, steps=41)  # away from the dead points, where no push gets through
    same = m.inverse_dynamics(motion, ["motor"])
    np.testing.assert_allclose(same.efforts["motor"], motion.driver("motor").torque, atol=1e-8)
    other = m.inverse_dynamics(motion, ["pull"])
    reaction = other.solution.joint("rail")
    pressed = np.maximum(abs(reaction.fy), 2 * abs(reaction.torque) / 0.08) + 2.0
    slider, pin = motion.body("slider"), other.solution.joint("B")
    rub = 0.2 * pressed * np.tanh(slider.vx / 1e-3)
    np.testing.assert_allclose(1.5 * slider.ax, other.efforts["pull"] + pin.fx - rub, atol=1e-7)


def test_normal_forces_are_those_of_the_reactions() -> None:
    m = _slider_crank()
    m.drive_angle("motor", m.bodies["crank"], constant_rate(20.0, math.radians(30)))
    sol = m.sweep(0.2, steps=20)
    packed = pack(m)
    from mbsd.equations.assembly import tabulate

    q, v = sol.q.reshape(21, -1), sol.v.reshape(21, -1)
    rows = len(packed.ws.phi)
    phi, gamma, compact = *np.zeros((2, 21, rows)), np.zeros((21, rows, 6))
    tabulate(packed.system, packed.drives(sol.t), q, v, packed.ws, phi, compact, gamma)
    normal = normals_along(packed, pack_loads(packed), q, compact, sol.lam)
    for k, pin in enumerate("OAB"):
        np.testing.assert_allclose(normal[:, k], sol.joint(pin).magnitude, rtol=1e-12)
    rail = sol.joint("rail")
    np.testing.assert_allclose(normal[:, 3], np.maximum(abs(rail.fy), 2 * abs(rail.torque) / 0.08), rtol=1e-9)


@pytest.mark.parametrize("far", [1e9, 1e30, 1e80, 1e300])
@pytest.mark.parametrize("slides", [False, True])
def test_normal_forces_of_a_trial_stage_far_away_leave_nothing(far: float, slides: bool) -> None:
    feet = dict.fromkeys(("rear", "front"), (0.3, 0.3))
    ready = prepare_dynamics(pusher(False, "OAB", 5.0, (0.5, 2.0), feet, (1.0, 2.0), 60.0), 0.0, 1.0, contacts=True)
    dynamics, contact = ready.dynamics, ready.switches.contacts[0]
    if slides:
        ready.switches.hold_row(contact.gap)
        ready.dynamics.sliding.table[contact.sliding, 0] = contact.friction
    scratch = scratch_for(dynamics, ready.packed.ws, 0, 1)
    state = np.stack([ready.initial.q, 1.0 + 0.3 * np.arange(len(ready.initial.q))])
    seen = []
    for begin in (0.0, far):
        out, lam = np.zeros_like(state), np.zeros(len(ready.packed.ws.phi))
        dynamics.loads.normal[...], dynamics.loads.normal[X] = 0.0, begin
        power = derivative(dynamics, scratch, 0.3, state, out, lam)
        seen.append(np.concatenate([out[1], lam, [power], dynamics.loads.normal[X]]))
    assert np.abs(seen[0]).max() > 1.0
    np.testing.assert_allclose(seen[1], seen[0], rtol=1e-9, atol=1e-9)


def test_joints_that_jam_are_told() -> None:
    """A drawer pulled far off its line, its guide too short: no normal force carries it."""
    m = Mechanism("drawer", gravity=None)
    drawer = m.body("drawer", 1.0, (0.0, 0.0), 1.0)
    m.prismatic("rail", m.ground.at(0, 0), drawer.at(0, 0.5))
    m.friction("rub", "rail", 0.5, length=0.1, slip_speed=1e-6)
    m.start_near(drawer=(0.0, -0.5, 0.0))
    m.start_moving(drawer=(1.0, 0.0, 0.0))
    m.force("pull", drawer.at(0, -0.2), 10.0)
    with pytest.raises(SimulationError, match=r"drawer: .*joints jam, among 'rail'. Lower the friction"):
        m.simulate(0.1)


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


@pytest.mark.parametrize(
    ("add", "words"),
    [
        (lambda m: m.friction("f", "pni", 0.1, radius=0.1), "no joint 'pni', did you mean 'pin'. There is: pin"),
        (lambda m: m.friction("f", "rod", 0.1), "is a distance; friction needs one of revolute"),
        (lambda m: m.friction("f", "pin", 0.1), "needs the radius"),
        (lambda m: m.friction("f", "rail", 0.1, radius=0.1), "no other has one"),
        (lambda m: m.friction("f", "pin", 0.1, radius=0.1, length=0.1), "prismatic joints alone"),
        (lambda m: m.friction("f", "rail", -0.1), "coefficient is -0.1"),
        (lambda m: m.friction("f", "rail", 0.1, static=math.nan), "finite"),
        (lambda m: m.friction("f", "rail", 0.1, slip_speed=0.0), "slip_speed is 0"),
    ],
)
def test_wrong_ones_are_refused_when_built(add, words: str) -> None:
    m = Mechanism("refused")
    a = m.body("a", 1.0)
    m.revolute("pin", m.ground.origin, a.origin)
    m.prismatic("rail", m.ground.origin, a.origin)
    m.distance("rod", m.ground.origin, a.at(1, 0), 1.0)
    with pytest.raises(ModelError, match=words):
        add(m)
    assert not m.forces
