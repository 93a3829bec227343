"""Published motions under springs, dampers and torques: numbers of others, each file with its source and tolerance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism
from tests.published.test_reference_dynamics import adams_mass, assert_adams, case, rows_of, simulate_at


def fortran(text: str) -> float:
    """A number as the test set prints it, 0.158d+2."""
    return float(text.replace("d", "e"))


def squeezer() -> Mechanism:
    """Andrews' squeezing mechanism: seven bodies, three loops, one freedom."""
    data = case("iftomm_a03_andrews")
    p = data["parameters"]
    m = Mechanism("squeezer", gravity=None)
    bodies = {
        f"K{k + 1}": m.body(f"K{k + 1}", mass, inertia=inertia)
        for k, (mass, inertia) in enumerate(zip(p["m"], p["I"], strict=True))
    }
    k1, k2, k3, k4, k5, k6, k7 = bodies.values()
    a, b, c = m.ground.at(p["xa"], p["ya"]), m.ground.at(p["xb"], p["yb"]), m.ground.at(p["xc"], p["yc"])
    # frames at the centres of mass, turned by the angles of the reference
    m.revolute("O", m.ground.at(0, 0), k1.at(-p["ra"], 0))
    m.revolute("F", k1.at(p["rr"] - p["ra"], 0), k2.at(p["da"], 0))
    e = k2.at(p["da"] - p["d"], 0)
    m.trace("F", k1.at(p["rr"] - p["ra"], 0))
    m.revolute("E3", e, k3.at(-p["sb"], p["sa"] - p["ss"]))
    m.revolute("B", b, k3.at(-p["sb"], p["sa"]))
    m.revolute("E4", e, k4.at(0, -p["ea"]))
    m.revolute("G", k4.at(0, p["e"] - p["ea"]), k5.at(p["zt"] - p["ta"], -p["tb"]))
    m.revolute("A5", a, k5.at(-p["ta"], -p["tb"]))
    m.revolute("E6", e, k6.at(p["fa"], 0))
    m.revolute("H", k6.at(p["fa"] - p["zf"], 0), k7.at(p["ub"], p["ua"] - p["u"]))
    m.revolute("A7", a, k7.at(p["ub"], p["ua"]))
    m.torque("motor", k1, p["mom"])
    m.spring("spring", c, k3.at(p["sd"] - p["sb"], p["sa"] - p["sc"]), p["c0"], free_length=p["l0"])
    beta, theta, gamma, phi, delta, omega, epsilon = (float(q) for q in data["initial_conditions"]["q"])
    angles = (beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon)
    m.start_near(**{name: math.degrees(angle) for name, angle in zip(bodies, angles, strict=True)})
    return m


def test_andrews_squeezer_at_the_reference_time() -> None:
    reference = [fortran(value) for value in case("iftomm_a03_andrews")["expected"][0]["values"]]
    beta, theta, gamma, phi, delta, omega, epsilon = reference[:7]
    angles = np.array([beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon])
    sol = simulate_at(squeezer(), np.array([0.0, 0.03]))
    computed = np.array([sol.body(f"K{k + 1}").theta[-1] for k in range(7)])
    computed += 2 * math.pi * np.round((angles - computed) / (2 * math.pi))  # links count turns from their own start
    np.testing.assert_allclose(computed, angles, atol=1e-6)
    assert sol.body("K1").omega[-1] == pytest.approx(reference[7], abs=1e-3)
    assert sol.body("K1").alpha[-1] == pytest.approx(reference[14], rel=1e-5)


def test_andrews_squeezer_starts_with_the_reference_acceleration() -> None:
    start = case("iftomm_a03_andrews")["initial_conditions"]
    sol = simulate_at(squeezer(), np.array([0.0, 1e-4]))
    assert sol.body("K1").alpha[0] == pytest.approx(float(start["beta_dd"]), rel=1e-9)


def test_andrews_squeezer_on_its_way_and_its_energy() -> None:
    rows = rows_of(case("iftomm_a03_andrews"), 1)
    sol = simulate_at(squeezer(), rows[:, 0], tolerance=1e-10)
    np.testing.assert_allclose(sol.body("K1").theta, rows[:, 1], atol=1e-6)
    np.testing.assert_allclose(sol.body("K3").theta, rows[:, 3], atol=1e-6)
    point = np.array(case("iftomm_a03_andrews")["expected"][2]["rows"])
    np.testing.assert_allclose(np.stack([sol.point("F").x, sol.point("F").y], axis=1), point[:, 1:], atol=1e-8)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-6
    motor = 0.033 * (sol.body("K1").theta - sol.body("K1").theta[0])
    np.testing.assert_allclose(sol.energy.total - sol.energy.total[0], motor, atol=1e-6)


def test_adams_torsion_spring() -> None:
    data = case("adams_rotspring_case01")
    m = Mechanism("adams torsion spring", gravity=tuple(data["gravity"]))
    body = adams_mass(m, 0.1)
    m.revolute("pin", m.ground.at(0, 0), body.at(-2.0, 0.0))
    m.torsion_spring("spring", m.ground, body, 200.0, damping=10.0)
    sol = simulate_at(m, rows_of(data)[:, 0])
    assert_adams(sol, rows_of(data), -sol.joint("pin").reaction, data["expected"][0]["tol_abs"])


def test_adams_mass_on_a_spring() -> None:
    data = case("adams_transpring_case02")
    m = Mechanism("adams spring", gravity=tuple(data["gravity"]))
    body = adams_mass(m, 0.04)
    m.spring("spring", m.ground.at(0, 0), body.origin, 100.0, damping=5.0, free_length=2.0)
    sol = simulate_at(m, rows_of(data)[:, 0])
    view = sol.body("mass")
    pull = -np.stack([view.ax, view.ay + 9.80665], axis=1)  # 1 kg: what the spring does to ground
    assert_adams(sol, rows_of(data), pull, data["expected"][0]["tol_abs"])


def test_exudyn_slider_crank_under_torque() -> None:
    """MATLAB's own tolerance dominates after 1.5 s, hence the wide limits there."""
    data = case("exudyn_slider_crank_matlab")
    rows = rows_of(data)
    m = Mechanism("slider-crank", gravity=None)
    crank = m.body("crank", 0.2, inertia=0.2 * 0.1**2 / 12)
    rod, slider = m.body("rod", 0.2, inertia=0.0015), m.body("slider", 0.4, inertia=1.0)
    m.revolute("O", m.ground.at(0, 0), crank.at(-0.05, 0))
    m.revolute("A", crank.at(0.05, 0), rod.at(-0.15, 0))
    m.revolute("B", rod.at(0.15, 0), slider.origin)
    m.prismatic("rail", m.ground.at(0, 0), slider.origin)
    m.torque("motor", crank, 0.1)
    m.start_near(crank=0.0, rod=0.0, slider=(0.4, 0.0, 0.0))
    view = simulate_at(m, np.concatenate([[0.0], rows[:, 0]])).body("crank")
    early, limits = rows[:, 0] < 1.0, data["expected"][0]["tol_abs"]
    theta, omega = np.abs(view.theta[1:] - rows[:, 1]), np.abs(view.omega[1:] - rows[:, 2])
    assert theta.max() < limits["theta"]
    assert omega.max() < limits["omega"]
    assert theta[early].max() < limits["until_1s"][0]
    assert omega[early].max() < limits["until_1s"][1]


def test_nikravesh_sliding_pendulum() -> None:
    data = case("nikravesh_sp_sliding_pendulum")
    rows = rows_of(data)
    m = Mechanism("sliding pendulum", gravity=tuple(data["gravity"]))
    slider, rod = m.body("slider", 5.0, inertia=4.0), m.body("rod", 2.0, inertia=0.2)
    m.prismatic("rail", m.ground.at(0, 0.2), slider.origin)
    m.revolute("pin", slider.origin, rod.at(0, 0.5))
    m.spring("spring", m.ground.at(0, 0.2), slider.origin, 20.0, free_length=0.6)
    m.start_near(slider=(rows[0, 1], 0.2, 0.0), rod=math.degrees(rows[0, 6]))
    sol = simulate_at(m, rows[:, 0])
    s, r = sol.body("slider"), sol.body("rod")
    computed = np.stack([s.x, s.y, s.theta, r.x, r.y, r.theta, s.vx, s.vy, s.omega, r.vx, r.vy, r.omega], axis=1)
    limits = data["expected"][0]
    np.testing.assert_allclose(computed[:, :6], rows[:, 1:7], atol=limits["tol_abs_pos"])
    np.testing.assert_allclose(computed[:, 6:], rows[:, 7:], atol=limits["tol_abs_vel"])


def test_dlr_crane_crab() -> None:
    data = case("dlr_cranecrab")
    rows = rows_of(data)
    m = Mechanism("crane crab", gravity=tuple(data["gravity"]))
    cart, load = m.body("cart", 1.0, inertia=0.1), m.body("load", 0.5, inertia=0.1)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.revolute("hook", cart.origin, load.at(0.0, 1.0))
    m.bushing("damper", m.ground.at(0, 0), cart.origin, (0, 0, 0), damping=(10.0, 0, 0))
    m.start_near(cart=(0.0, 0.0, 0.0), load=math.degrees(rows[0, 1]))
    sol = simulate_at(m, rows[:, 0])
    computed = np.stack(
        [sol.body("load").theta, sol.body("cart").x, sol.body("cart").vx, sol.body("load").omega], axis=1
    )
    np.testing.assert_allclose(computed, rows[:, 1:], atol=data["expected"][0]["tol_abs"])


def test_dlr_spring_damper() -> None:
    data = case("dlr_springdamperdemo")
    rows = rows_of(data)
    m = Mechanism("spring damper", gravity=tuple(data["gravity"]))
    body = m.body("body", 0.5, inertia=0.1)
    m.bushing("mount", m.ground.at(-1.0, 0.0), body.origin, (5.0, 5.0, 0.0), damping=(1.0, 1.0, 0.0))
    m.start_near(body=(1.0, 1.0, 0.0))
    view = simulate_at(m, rows[:, 0]).body("body")
    computed = np.stack([view.theta, view.x, view.y, view.vx, view.vy, view.omega], axis=1)
    np.testing.assert_allclose(computed, rows[:, 1:], atol=data["expected"][0]["tol_abs"])


def test_dlr_kinematic_loop_of_massless_links() -> None:
    data = case("dlr_kinematicloop")
    rows = rows_of(data)
    m = Mechanism("kinematic loop", gravity=tuple(data["gravity"]))
    first, second, slider = m.body("link1"), m.body("link2"), m.body("slider")
    body = m.body("body", 1.0, inertia=0.1)
    m.revolute("revolute1", m.ground.at(0, 0), first.origin)
    m.prismatic("rail", m.ground.at(0, 0), slider.origin)
    m.revolute("revolute3", slider.origin, second.origin)
    m.revolute("revolute2", first.at(0.0, -0.5), second.at(0.0, -0.5))
    m.revolute("revolute4", first.at(0.0, -0.5), body.at(0.0, 0.6))
    m.spring("spring", m.ground.at(0, 0), slider.origin, 20.0, damping=4.0, free_length=0.4)
    start = math.degrees(math.asin(0.4))
    m.start_near(slider=(0.4, 0.0, 0.0), link1=start, link2=-start, body=math.degrees(rows[0, 1]))
    sol = simulate_at(m, rows[:, 0])
    link1, link2, b = sol.body("link1"), sol.body("link2"), sol.body("body")
    computed = np.stack(
        [
            b.theta,
            b.omega,
            link2.theta - link1.theta,
            link2.omega - link1.omega,
            b.theta - link1.theta,
            b.omega - link1.omega,
            sol.body("slider").x,
            sol.body("slider").vx,
        ],
        axis=1,
    )
    np.testing.assert_allclose(computed, rows[:, 1:], atol=data["expected"][0]["tol_abs"])


def test_car_axis() -> None:
    """Both ends as point masses; the road's left end moves as driven, the arm stays square to the road."""
    expected = [fortran(value) for value in case("ivp_car_axis")["expected"][0]["values"]]
    mass = 10 * 0.01**2 / 2
    m = Mechanism("car axis", gravity=(0.0, -1.0))
    left, right = m.body("left", mass), m.body("right", mass)
    road = m.body("road", 1.0, inertia=1.0)
    m.revolute("hub", m.ground.at(0, 0), road.origin)
    m.drive_angle("waves", road, lambda t: math.asin(0.1 * math.sin(10.0 * t)))
    m.pin_in_slot("arm", road.at(0, 0, math.pi / 2), left.origin)
    m.distance("axle", left.origin, right.origin, 1.0)
    m.spring("left spring", m.ground.at(0, 0), left.origin, 1.0, free_length=0.5)
    m.spring("right spring", road.at(1.0, 0.0), right.origin, 1.0, free_length=0.5)
    m.start_near(left=(0.0, 0.5, 0.0), right=(1.0, 0.5, 0.0), road=0.0)
    m.start_moving(left=(-0.5, 0.0, 0.0), right=(-0.5, 0.0, 0.0))
    sol = simulate_at(m, np.array([0.0, 3.0]), tolerance=1e-10)
    left_end, right_end = sol.body("left"), sol.body("right")
    computed = np.array(
        [getattr(v, f)[-1] for fields in (("x", "y"), ("vx", "vy")) for v in (left_end, right_end) for f in fields]
    )
    np.testing.assert_allclose(computed, expected[:8], atol=1e-6)
    # multipliers of (xb xl + yb yl = 0) and (|l - r|^2 = L^2), whose gradients at the ends are 1 and 2 long
    assert np.hypot(sol.joint("arm").fx, sol.joint("arm").fy)[-1] == pytest.approx(abs(expected[8]), abs=1e-8)
    assert np.hypot(sol.joint("axle").fx, sol.joint("axle").fy)[-1] == pytest.approx(2 * abs(expected[9]), abs=1e-8)


@pytest.mark.parametrize("name", ["nikravesh_mp_b_macpherson", "nikravesh_mp_c_macpherson"])
def test_nikravesh_macpherson_on_its_tyre(name: str) -> None:
    """The control arm is a body (B) or a massless rod (C). The tyre's law measures the centre of mass and may pull."""
    data = case(name)
    rows = rows_of(data)
    m = Mechanism("macpherson", gravity=tuple(data["gravity"]))
    wheel = m.body("wheel", 20.0, inertia=2.5)
    if len(data["bodies"]) == 2:
        arm = m.body("arm", 2.0, inertia=0.5)
        m.revolute("ball", wheel.at(0, -0.07), arm.at(0.225, 0))
        m.revolute("chassis", m.ground.at(0.12, 0.29), arm.at(-0.225, 0))
        m.start_near(wheel=(*rows[0, 1:3], math.degrees(rows[0, 3])), arm=(*rows[0, 4:6], math.degrees(rows[0, 6])))
    else:
        m.distance("arm", m.ground.at(0.12, 0.29), wheel.at(0, -0.07), 0.45)
        m.start_near(wheel=(*rows[0, 1:3], math.degrees(rows[0, 3])))
    m.pin_in_slot("strut", wheel.at(-0.17, 0.25, math.atan2(-0.88, 0.47)), m.ground.at(0.41, 0.83))
    m.spring("spring", wheel.at(-0.17, 0.25), m.ground.at(0.41, 0.83), 20000.0, damping=1100.0, free_length=0.34)

    def tyre(t, q, v):
        deflection = q[1] - 0.3
        force = -(100000.0 * deflection + 1000.0 * v[1]) if deflection < 0.0 else 0.0
        arm = math.cos(q[2]) * 0.11 - math.sin(q[2]) * -0.02
        return 0.0, force, arm * force

    m.user_force("tyre", tyre, wheel)
    sol = simulate_at(m, rows[:, 0], tolerance=1e-8)
    views = [sol.body(body) for body in m.bodies if body != "ground"]
    computed = np.stack([getattr(v, f) for v in views for f in ("x", "y", "theta")], axis=1)
    speeds = np.stack([getattr(v, f) for v in views for f in ("vx", "vy", "omega")], axis=1)
    limits, half = data["expected"][0], 1 + computed.shape[1]
    gap = computed - rows[:, 1:half]
    gap -= 2 * math.pi * np.round(gap / (2 * math.pi))
    np.testing.assert_allclose(gap, 0.0, atol=limits["tol_abs_pos"])
    np.testing.assert_allclose(speeds, rows[:, half:], atol=limits["tol_abs_vel"])
