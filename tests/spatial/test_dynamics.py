"""Simulations in space against published numbers, closed forms and conserved quantities."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.base.errors import InitialConditionWarning, MobilityError, ModelError
from mbsd.measures import samples
from mbsd.spatial import Mechanism, constant_rate
from mbsd.spatial.model.rotation import rotation_matrix
from tests.spatial import machines

FINE = 1e-12


@pytest.fixture(params=["tree", "reference"])
def formulation(request: pytest.FixtureRequest) -> str:
    return request.param


def top(
    mass: float,
    com: tuple[float, float, float],
    inertia: tuple[float, float, float],
    w: np.ndarray,
    g: tuple[float, float, float],
) -> Mechanism:
    """Return a body on a ball at the origin that begins with an angular velocity."""
    m = Mechanism("top", gravity=g)
    body = m.body("top", mass, com=com, inertia=inertia)
    m.spherical("ball", m.ground, body, at=(0, 0, 0))
    m.start_moving({"top": w})
    m.trace("com", body, at=com)
    return m


def test_the_heavy_top(formulation: str) -> None:
    """Terze, Müller, Zlatar 2016, J. Comput. Nonlinear Dynam.: m 15 kg, com 1 m, spin 150 rad/s."""
    m = top(15.0, (0, 1, 0), (0.234375, 0.46875, 0.234375), np.array([0, 150, -4.61538]), (0, 0, -9.81))
    sol = m.simulate(times=[0.0, 0.05, 0.1, 0.2], tolerance=FINE, formulation=formulation)
    wanted = [
        (0.22574111752548395, 0.9734319842761463, -0.038355180178823514),
        (0.42129665892536244, 0.8945719743456064, -0.14916470056193076),
        (0.6055505613769797, 0.5989576817949867, -0.5239830274300867),
    ]
    assert np.allclose(sol.point("com").place[1:], wanted, rtol=0, atol=1e-8)
    spin = sol.body("top").w_body
    assert np.allclose(spin[-1], (-2.6915909121417343, 150.0, 4.91726098989493), rtol=0, atol=1e-6)
    quaternion = -0.7082791529743312, 0.4387810881265616, 0.5457283961454229, 0.0893997528239162
    assert abs(abs(sol.body("top").orientation[-1] @ quaternion) - 1.0) < 1e-12
    total = sol.energy.total
    assert np.ptp(total) < 1e-9 * abs(total[0])


def test_kovalevskayas_top_keeps_its_constant(formulation: str) -> None:
    """Kovalevskaya 1889: (p^2 - q^2 - c g1)^2 + (2 p q - c g2)^2 stays, about the pivot I = (2, 2, 1)."""
    m = top(0.5, (1, 0, 0), (2.0, 1.5, 0.5), np.array([0.3, 0.5, 0.7]), (0, 0, -1.0))
    sol = m.simulate(duration=20.0, steps=20, tolerance=1e-11, formulation=formulation)
    body, (p, q, _) = sol.body("top"), sol.body("top").w_body.T
    g1, g2, _ = body.rotation[:, 2, :].T
    c = 0.5 / 1.0
    constant = (p**2 - q**2 - c * g1) ** 2 + (2 * p * q - c * g2) ** 2
    assert np.allclose(constant, 0.1156, rtol=0, atol=1e-9)
    wanted = (0.6787368887589877, -0.08283766003529257, 0.7296945648130091)
    assert np.allclose(sol.point("com").place[10], wanted, rtol=0, atol=1e-7)
    last = (0.4839111357536391, -0.2318669429294823, 0.843841059364949)
    assert np.allclose(sol.point("com").place[20], last, rtol=0, atol=1e-7)


@pytest.mark.parametrize("precession", [2.550040606415521, 64.11662606025112])
def test_a_symmetric_top_precesses_steadily(precession: float, formulation: str) -> None:
    """Closed form: both rates of precession at tilt 60 degrees, l .1, I .012 about the pivot, I3 .002, w3 200 rad/s."""
    tilt = math.radians(60.0)
    axis = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    m = Mechanism("symmetric top", gravity=(0, 0, -9.81))
    across = 0.012 - 0.1**2
    body = m.body("top", 1.0, com=0.1 * axis, inertia=across * np.eye(3) + (0.002 - across) * np.outer(axis, axis))
    m.spherical("tip", m.ground, body, at=(0, 0, 0))
    up = np.array([0.0, 0.0, 1.0])
    m.start_moving({"top": precession * up + (200.0 - precession * math.cos(tilt)) * axis})
    m.trace("com", body, at=0.1 * axis)
    place = m.simulate(duration=1.0, steps=200, tolerance=1e-11, formulation=formulation).point("com").place
    assert np.degrees(np.ptp(np.arccos(place[:, 2] / 0.1))) < 1e-6
    turned = np.unwrap(np.arctan2(place[:, 1], place[:, 0]))
    assert turned[-1] == pytest.approx(precession, abs=1e-7)


def test_a_tennis_racket_turns_over_and_comes_back(formulation: str) -> None:
    """Closed form by elliptic integrals: period 39.10573419729348 s for I = (1, 2, 3), w = (.01, 1, .01)."""
    m = Mechanism("racket", gravity=None)
    m.body("racket", 1.0, inertia=(1.0, 2.0, 3.0))
    m.start_moving({"racket": (0.01, 1.0, 0.01)})
    times = [0.0, 39.10573419729348 / 2, 39.10573419729348]
    w = m.simulate(times=times, tolerance=1e-12, formulation=formulation).body("racket").w_body
    assert np.allclose(w[2], w[0], rtol=0, atol=1e-8)
    assert w[1, 1] == pytest.approx(-1.0, abs=1e-4)


def test_bricards_loop(formulation: str) -> None:
    """IFToMM benchmark A04: place and velocity of P3, that of Exudyn to 1e-8; energy; one redundant row."""
    m = machines.bricard()
    m.gravity = (0.0, -9.81, 0.0)
    sol = m.simulate(times=[0.0, 0.5, 1.0, 2.0, 5.0, 10.0], tolerance=1e-11, formulation=formulation)
    wanted = [
        (0.968283679106769, -1.2246251594363595, 0.7501466094377354),
        (0.5105014611872203, -1.649167599394806, 0.14012311455318605),
        (-0.969340344777686, -1.2212468949562065, 0.7542780107799119),
        (0.9999999977380492, -1.000067257697832, 0.999932740040369),
        (0.9999999638063495, -1.0002690126961187, 0.9997309511199657),
    ]
    assert np.allclose(sol.point("P3").place[1:], wanted, rtol=0, atol=2e-8)
    rate = (-1.7510665152648157, -0.630374394907483, -1.039593027569527)
    assert np.allclose(sol.point("P3").velocity[2], rate, rtol=0, atol=1e-7)
    assert np.ptp(sol.energy.total) < 1e-8
    bend = abs(sol.joint("hinge 0").turn_acceleration[0])
    assert bend == pytest.approx(1.9580838323353265, abs=1e-8)
    assert sol.stats.position_residual < 1e-10
    assert sol.stats.power_residual < 1e-7


@pytest.mark.parametrize(
    ("count", "tip"),
    [
        (1, (0.011016097432845522, -0.0993868804585592, -0.0009452989295025472)),
        (3, (-0.06382701473156421, 0.21483818041424896, -0.03862349079713289)),
        (10, (0.1621894405667371, -0.8806080293260177, 0.09764551553752829)),
    ],
)
def test_a_chain_of_universal_joints(count: int, tip: tuple[float, float, float], formulation: str) -> None:
    """Bars of .1 m with universal joints (y, then z), first z rate 3 rad/s; MuJoCo's RK4 to 5e-10."""
    m = Mechanism("chain", gravity=(0, 0, -9.81))
    before = m.ground
    for k in range(count):
        bar = m.body(f"bar {k}", 0.1, com=(0.1 * k + 0.05, 0, 0), inertia=(1e-5, 0.1 * 0.01 / 12, 0.1 * 0.01 / 12))
        m.universal(f"joint {k}", before, bar, at=(0.1 * k, 0, 0), first=(0, 1, 0), second=(0, 0, 1))
        before = bar
    spin = {f"bar {k}": (0.0, 0.0, 3.0) for k in range(count)}
    m.start_moving(spin)
    m.trace("tip", before, at=(0.1 * count, 0, 0))
    sol = m.simulate(times=[0.0, 1.0], tolerance=1e-11, formulation=formulation)
    assert np.allclose(sol.point("tip").place[-1], tip, rtol=0, atol=1e-6 if count == 10 else 1e-8)


def test_a_driven_simulation_is_the_sweep(formulation: str) -> None:
    m = machines.slider_crank()
    swept = m.sweep(duration=1.0, steps=20)
    simulated = m.simulate(duration=1.0, steps=20, tolerance=1e-11, formulation=formulation)
    for name in ("crank", "rod", "slider"):
        assert np.allclose(swept.body(name).place, simulated.body(name).place, rtol=0, atol=1e-9)
    torque = swept.driver("motor").torque
    assert np.allclose(torque, simulated.driver("motor").torque, rtol=0, atol=1e-7)
    assert np.allclose(swept.joint("ball").force, simulated.joint("ball").force, rtol=0, atol=1e-6)
    energy = simulated.energy.total
    assert np.allclose(simulated.work, energy - energy[0], rtol=0, atol=1e-7)


def test_gears_count_their_turns_in_a_simulation(formulation: str) -> None:
    m = Mechanism("gears", gravity=None)
    for k, x in enumerate((0.0, 0.2)):
        wheel = m.disc(f"wheel {k}", (x, 0, 0), (0, 0, 1), radius=0.05, mass=1.0, thickness=0.01)
        m.revolute(f"shaft {k}", m.ground, wheel, at=(x, 0, 0), axis=(0, 0, 1))
    m.gear_pair("teeth", "shaft 0", "shaft 1", teeth=(20, 30))
    m.start_moving({"shaft 0": 30.0})
    sol = m.simulate(duration=2.0, steps=50, tolerance=1e-10, formulation=formulation)
    assert sol.joint("shaft 0").turn[-1] == pytest.approx(60.0, abs=1e-6)
    assert sol.joint("shaft 1").turn[-1] == pytest.approx(-40.0, abs=1e-6)
    assert sol.stats.position_residual < 1e-9


def test_any_frame_of_reference_gives_the_same_motion() -> None:
    """A pendulum of two rods in the plane, turned with its gravity."""
    tips = []
    for e in ((1.0, 0, 0, 0), (0.3, -0.5, 0.7, 0.4)):
        turned = rotation_matrix(e)
        m = Mechanism("double pendulum", gravity=turned @ [0, 0, -9.81])
        elbow, end = turned @ [1.0, 0, 0], turned @ [2.0, 0, 0]
        first = m.rod("first", (0, 0, 0), elbow, mass=1.0, radius=0.02)
        second = m.rod("second", elbow, end, mass=1.0, radius=0.02)
        m.revolute("a", m.ground, first, at=(0, 0, 0), axis=turned @ [0, 1.0, 0])
        m.revolute("b", first, second, at=elbow, axis=turned @ [0, 1.0, 0])
        m.trace("tip", second, at=end)
        tips.append(m.simulate(duration=1.0, steps=10, tolerance=1e-11).point("tip").place @ turned)
    assert np.allclose(*tips, rtol=0, atol=1e-9)
    assert np.abs(tips[0][:, 1]).max() < 1e-12


def test_what_cannot_be_simulated_is_refused() -> None:
    m = Mechanism("rod")
    rod = m.rod("rod", (0, 0, 0), (1, 0, 0), mass=1.0)
    m.spherical("ball", m.ground, rod, at=(0, 0, 0))
    with pytest.raises(MobilityError, match=r"no inertia about its axis \(1, 0, 0\).*radius="):
        m.simulate(duration=1.0)
    bare = Mechanism("massless")
    arm = bare.rod("arm", (0, 0, 0), (1, 0, 0))
    bare.revolute("hinge", bare.ground, arm, at=(0, 0, 0), axis=(0, 1, 0))
    with pytest.raises(MobilityError, match="body 'arm' has no mass"):
        bare.simulate(duration=1.0)
    with pytest.raises(ModelError, match="say how long"):
        m.simulate()
    with pytest.raises(ModelError, match="no joint or body 'rdo', did you mean 'rod'"):
        m.start_moving({"rdo": 3.0})
    with pytest.raises(ModelError, match="tolerance is -1"):
        m.simulate(duration=1.0, tolerance=-1.0)


def test_a_thrown_body_starts_with_the_velocity_of_its_frame() -> None:
    m = Mechanism("throw", gravity=(0, 0, -9.81))
    moments = ((0.05, 0.01, 0.0), (0.01, 0.08, 0.002), (0.0, 0.002, 0.06))
    m.body("stick", 2.0, (0.1, 0.2, -0.3), moments, at=(1, 2, 3), orientation=(0.5, 0.3, -0.2, 0.7))
    v, w, t = np.array([1.0, -2.0, 4.0]), np.array([0.5, 3.0, -1.0]), np.linspace(0.0, 0.4, 5)
    m.start_moving({"stick": [*v, *w]})
    stick = m.simulate(times=t).body("stick")
    np.testing.assert_allclose(stick.velocity[0], v, atol=1e-12)
    np.testing.assert_allclose(stick.w[0], w, atol=1e-12)
    middle = stick.place + stick.rotation @ np.array([0.1, 0.2, -0.3])
    thrown = v + np.cross(w, middle[0] - stick.place[0])
    np.testing.assert_allclose(middle, middle[0] + np.outer(t, thrown) - np.outer(t**2, [0, 0, 9.81 / 2]), atol=1e-9)
    many = m.simulate_many(
        times=t, moving={"stick": [[*v, *w], [*(2 * v), *w]]}, measure={"vx": samples("stick.vx", [0.0])}
    )
    np.testing.assert_allclose(np.ravel(many["vx"]), [1.0, 2.0], atol=1e-12)
    with pytest.raises(ModelError, match=r"start velocity of 'stick'.*\(vx, vy, vz, wx, wy, wz\)"):
        m.start_moving({"stick": (1.0, 2.0)})


def test_a_start_that_joints_forbid_is_changed_with_a_warning() -> None:
    m = Mechanism("door")
    leaf = m.body("leaf", 10.0, com=(0.4, 0, 0), inertia=(1.0, 1.0, 1.0))
    m.revolute("hinge", m.ground, leaf, at=(0, 0, 0), axis=(0, 0, 1))
    m.start_moving({"leaf": (1.0, 0.0, 2.0)})
    with pytest.warns(InitialConditionWarning, match="wx of 'leaf' is 0 rad/s, not 1"):
        sol = m.simulate(duration=0.5, steps=5)
    assert sol.joint("hinge").turn_rate == pytest.approx(np.full(6, 2.0), abs=1e-6)


def test_superfluous_drivers_of_a_simulation_are_refused() -> None:
    m = machines.slider_crank()
    m.drive_slide("jack", "rail", constant_rate(0.0))
    with pytest.raises(MobilityError, match=r"'jack' drives a freedom .* 2 drivers, 1 degree of freedom"):
        m.simulate(duration=0.1)
