"""Static equilibrium: closed forms, virtual work, stability, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from mbsd import EquilibriumError, Mechanism, ModelError, SingularPoseError, constant_rate
from tools.models import four_bars

G = 9.81


def pendulum(start: float) -> Mechanism:
    m = Mechanism("pendulum", gravity=(0.0, -G))
    rod = m.bar("rod", 1.2, mass=2.0)
    m.revolute("A", m.ground.at(0.1, 0.2), rod.start)
    m.start_near(rod=start)
    return m


@pytest.mark.parametrize("start", [-80.0, 10.0, 89.0, 90.0])
def test_a_pendulum_hangs(start: float) -> None:
    rest = pendulum(start).equilibrium()
    assert rest.stability == "stable"
    assert math.sin(rest.body("rod").theta) == pytest.approx(-1.0, abs=1e-12)
    assert rest.coordinates == ("rod.theta",)
    np.testing.assert_allclose(rest.joint("A").reaction, [0.0, 2.0 * G], atol=1e-9)
    assert rest.stiffness[0, 0] == pytest.approx(2.0 * G * 0.6)
    assert rest.energy.potential == pytest.approx(2.0 * G * (0.2 - 0.6))


def test_the_nearest_equilibrium_may_be_unstable() -> None:
    upright = pendulum(80.0).equilibrium(nearest=True)
    assert upright.stability == "unstable"
    assert not upright.stable
    assert math.degrees(upright.body("rod").theta) == pytest.approx(90.0)
    assert upright.stiffness[0, 0] == pytest.approx(-2.0 * G * 0.6)


def test_a_torsion_spring_buckles() -> None:
    """k (theta - 90 deg) = m g l / 2 cos(theta): upright above the critical stiffness, bent below it."""
    critical = 2.0 * G * 0.6
    for part in (1.5, 0.5):
        m = pendulum(90.0)
        m.torsion_spring("spring", m.ground, m.bodies["rod"], part * critical, free_angle=math.pi / 2)
        rest = m.equilibrium()
        assert rest.stability == "stable"
        bend = abs(rest.body("rod").theta - math.pi / 2)
        wanted = 0.0 if part > 1 else brentq(lambda x, k=part: k * x - math.sin(x), 0.5, 3.0)
        assert bend == pytest.approx(wanted, abs=1e-9)


def test_four_bar_with_a_spring_rests_where_virtual_work_says() -> None:
    lengths, masses = (4.0, 1.0, 3.5, 3.0), (1.0, 2.0, 1.5)
    m = four_bars.model(lengths, 1.0)
    m.drivers.clear()
    for name, length, mass in zip(four_bars.NAMES, lengths[1:], masses, strict=True):
        m.set_mass(name, mass, (length / 2, 0.0), mass * length**2 / 12)
    m.spring("spring", m.ground.at(-1.0, 2.0), m.bodies["crank"].end, 40.0, free_length=0.5)

    def potential(phi: float) -> float:
        theta, swing = four_bars.angles(lengths, np.array([phi]))
        b = lengths[1] * np.array([math.cos(phi), math.sin(phi)])
        heights = b[1] / 2, b[1] + lengths[2] / 2 * math.sin(theta[0]), lengths[3] / 2 * math.sin(swing[0])
        stretched = np.hypot(*(b - [-1.0, 2.0])) - 0.5
        return sum(mass * 9.81 * y for mass, y in zip(masses, heights, strict=True)) + 20.0 * stretched**2

    rest = m.equilibrium()
    phi = float(rest.body("crank").theta)
    best = minimize_scalar(potential, bracket=(phi - 0.3, phi + 0.2), tol=1e-12)
    assert phi == pytest.approx(best.x, abs=1e-6)
    assert rest.energy.potential == pytest.approx(best.fun)
    h = 1e-3
    bend = (potential(phi + h) - 2 * potential(phi) + potential(phi - h)) / h**2
    assert rest.coordinates == ("crank.theta",)
    assert rest.stiffness[0, 0] == pytest.approx(bend, rel=1e-4)


def test_reactions_balance_on_every_body() -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0), 1.0, dict.fromkeys(four_bars.NAMES, (1.3, (0.4, 0.2), 0.3)))
    rest = m.equilibrium(time=0.7)
    weight = 1.3 * 9.81
    a, b, c, d = (rest.joint(name).reaction for name in "ABCD")
    np.testing.assert_allclose(a - b, [0.0, weight], atol=1e-9)
    np.testing.assert_allclose(b - c, [0.0, weight], atol=1e-9)
    np.testing.assert_allclose(c + d, [0.0, weight], atol=1e-9)
    assert rest.stability == "fixed"
    assert rest.driver("motor").value == pytest.approx(0.7)
    still = four_bars.model((4.0, 1.0, 3.5, 3.0), 1e-9, dict.fromkeys(four_bars.NAMES, (1.3, (0.4, 0.2), 0.3)))
    still.drivers.clear()
    still.drive_angle("motor", still.bodies["crank"], constant_rate(1e-9, 0.7))
    swept = still.sweep(1.0, steps=1)
    assert rest.driver("motor").torque == pytest.approx(swept.driver("motor").torque[0])


def test_a_hanging_chain_is_a_catenary_of_links() -> None:
    """Horizontal tension is the same in all links, and its vertical part grows by the weight of a link."""
    m = Mechanism("chain", gravity=(0.0, -G))
    before, count = m.ground.at(0.0, 0.0), 8
    for k in range(count):
        link = m.bar(f"link {k}", 0.25, mass=0.4)
        m.revolute(f"pin {k}", before, link.start)
        m.start_near(**{f"link {k}": -60.0 + 120.0 * k / (count - 1)})
        before = link.end
    m.revolute("last", m.ground.at(1.4, 0.1), before)
    rest = m.equilibrium()
    assert rest.stability == "stable"
    pulls = np.array([rest.joint(f"pin {k}").reaction for k in range(count)])
    np.testing.assert_allclose(pulls[:, 0], pulls[0, 0], rtol=1e-9)
    np.testing.assert_allclose(np.diff(pulls[:, 1]), -0.4 * G, rtol=1e-9)


def test_constant_loads_without_a_potential() -> None:
    """A follower force on a spring-hinged rod: it keeps its angle against the rod."""
    m = Mechanism("follower", gravity=None)
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.torsion_spring("spring", m.ground, rod, 30.0)
    m.force("follower", rod.end, 12.0, direction=(0.0, 1.0), frame=rod)
    assert m.equilibrium().body("rod").theta == pytest.approx(12.0 / 30.0)


def test_a_mechanism_without_loads_is_neutral() -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0), 1.0)
    m.drivers.clear()
    rest = m.equilibrium()
    assert rest.stability == "neutral"
    assert rest.body("crank").theta == pytest.approx(0.0, abs=1e-9)


def test_a_frame_of_redundant_bars_stands() -> None:
    m = Mechanism("frame", gravity=(0.0, -G))
    beam = m.bar("beam", 1.0, mass=3.0)
    m.weld("wall", m.ground.origin, beam.start)
    m.revolute("prop", m.ground.at(1.0, 0.0), beam.end)
    rest = m.equilibrium()
    assert rest.stability == "fixed"
    total = rest.joint("wall").reaction + rest.joint("prop").reaction
    np.testing.assert_allclose(total, [0.0, 3.0 * G], atol=1e-9)


def test_falling_bodies_have_no_equilibrium() -> None:
    m = Mechanism("free")
    m.body("stone", 2.0, inertia=0.1)
    with pytest.raises(EquilibriumError, match=r"free: no equilibrium .* 'stone' is still driven by 19.6 N"):
        m.equilibrium()
    with pytest.raises(EquilibriumError, match="free: no equilibrium"):
        m.equilibrium(nearest=True)


def test_equilibrium_at_a_change_point_is_refused() -> None:
    """A parallelogram drawn flat by a load along its ground."""
    m = Mechanism("parallelogram", gravity=(G, 0.0))
    left, deck, right = m.bar("left", 1.0, mass=1.0), m.bar("deck", 2.0, mass=1.0), m.bar("right", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, deck.start)
    m.revolute("C", deck.end, right.end)
    m.revolute("D", m.ground.at(2, 0), right.start)
    m.start_near(left=50, deck=0, right=50)
    with pytest.raises(SingularPoseError, match="parallelogram: the pose that balances is singular"):
        m.equilibrium()


def test_a_simulation_that_starts_at_rest_stays() -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0), 1.0, dict.fromkeys(four_bars.NAMES, (1.3, (0.4, 0.2), 0.3)))
    m.drivers.clear()
    rest = m.equilibrium()
    rest.start(m)
    sol = m.simulate(3.0)
    assert np.ptp(sol.body("crank").theta) < 1e-6


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(ModelError, match="no body beside ground"):
        Mechanism("nothing").equilibrium()
    with pytest.raises(ModelError, match="time is nan"):
        pendulum(0.0).equilibrium(time=math.nan)
