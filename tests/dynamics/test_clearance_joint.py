"""A pin with play: Flores' slider-crank beside independent equations, impacts, friction, rest, energy, refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, MobilityError, ModelError, SimulationError, constant_rate, polynomial
from mbsd.measures import final
from mbsd.model.forces.contact import DAMPING_MODELS
from mbsd.results.force_view import ForceView
from tools.models.clearance_slider_crank import CRANK, RADIUS, ROD, TURN, reference, slider_crank

G = 9.80665
MODULUS_OF_BRONZE = 110e9


def normal(force: ForceView) -> np.ndarray:
    """(T,) the normal force (N)."""
    assert force.effort is not None
    return force.effort


def test_hertz_makes_the_stiffness_of_the_benchmark() -> None:
    """6.61e10 N/m^1.5 is quoted for the bearing of the benchmark: steel, a journal of 9.5 mm in a bore of 10 mm."""
    force = slider_crank(0.5e-3).forces["B"]
    yielding = 2.0 * (1.0 - 0.3**2) / 207e9
    assert force.params["stiffness"] == pytest.approx(4.0 / (3.0 * yielding) * math.sqrt(0.01 * 0.0095 / 0.0005))
    assert force.params["stiffness"] == pytest.approx(6.61e10, rel=1e-3)
    softer = slider_crank(0.5e-3, journal_modulus=MODULUS_OF_BRONZE, journal_poisson=0.34).forces["B"]
    both = (1.0 - 0.3**2) / 207e9 + (1.0 - 0.34**2) / MODULUS_OF_BRONZE
    assert softer.params["stiffness"] == pytest.approx(4.0 / (3.0 * both) * math.sqrt(0.01 * 0.0095 / 0.0005))


@pytest.mark.parametrize(("clearance", "friction"), [(0.5e-3, 0.0), (0.5e-3, 0.1), (0.05e-3, 0.0)])
def test_slider_crank_beside_equations_of_its_own(clearance: float, friction: float) -> None:
    """A quarter of a turn with several impacts, each of which makes differences larger."""
    end, slip = 0.25 * TURN, (0.01, 0.1)
    m = slider_crank(clearance, friction=friction, slip_speeds=slip)
    sol = m.simulate(end, tolerance=1e-12)
    expected = reference(end, sol.t, clearance, 0.9, friction, slip)
    touching = sol.force("B").gap < 0.0
    assert np.count_nonzero(np.diff(touching.astype(int)) == 1) >= 1
    assert np.abs(sol.body("rod").theta - expected[:, 0]).max() < 1e-9
    assert np.abs(sol.body("slider").x - expected[:, 1]).max() < 1e-10
    assert np.abs(sol.body("slider").vx - expected[:, 3]).max() < 1e-5


def test_the_slider_keeps_to_the_ideal_motion_within_its_play() -> None:
    """What published curves show: place and speed near the ideal ones, free flight at constant speed, sharp peaks."""
    ideal = slider_crank().simulate(2.0 * TURN, steps=1440)
    for clearance in (0.05e-3, 0.5e-3):
        sol = slider_crank(clearance).simulate(2.0 * TURN, steps=1440, tolerance=1e-9)
        force = sol.force("B")
        reach = (clearance - force.gap.min()) / math.cos(math.asin(CRANK / ROD))
        away = np.abs(sol.body("slider").x - ideal.body("slider").x).max()
        assert clearance < away < 1.2 * reach
        assert np.abs(sol.body("slider").vx - ideal.body("slider").vx).max() < 0.2 * ideal.body("slider").vx.max()
        flying = force.gap > 0.0
        assert flying.any()
        assert np.abs(sol.body("slider").ax[flying]).max() < 1e-6
        assert np.abs(normal(force)[flying]).max() == 0.0
        assert normal(force).min() >= 0.0, "it never pulls"
        assert np.abs(sol.body("slider").ax).max() > 4.0 * np.abs(ideal.body("slider").ax).max()


def test_it_starts_as_a_pin_does_or_where_it_is_said_to() -> None:
    ideal = slider_crank().simulate(1e-6)
    sol = slider_crank(0.5e-3).simulate(1e-6)
    for name in ("crank", "rod", "slider"):
        for what in ("x", "y", "theta", "vx", "vy", "omega"):
            assert getattr(sol.body(name), what)[0] == pytest.approx(getattr(ideal.body(name), what)[0], abs=1e-9)
    assert sol.force("B").gap[0] == pytest.approx(0.5e-3, abs=1e-12)
    aside = slider_crank(0.5e-3, start=(-0.4e-3, 0.0)).simulate(1e-6)
    assert aside.body("slider").x[0] == pytest.approx(CRANK + ROD - 0.4e-3, abs=1e-12)
    loose = slider_crank(0.5e-3, start=None)
    loose.start_near(slider=(CRANK + ROD + 0.1e-3, 0, 0))
    loose.start_moving(slider=(2.0, 0.0, 0.0))
    free = loose.simulate(1e-6)
    assert free.body("slider").x[0] == pytest.approx(CRANK + ROD + 0.1e-3, abs=1e-12)
    assert free.body("slider").vx[0] == pytest.approx(2.0, abs=1e-9)


def ball(**joint: Any) -> Mechanism:
    """A journal that flies along x in a bearing on ground."""
    m = Mechanism("ball", gravity=None)
    body = m.body("ball", mass=0.2, inertia=1e-5)
    given = {"stiffness": 1e9, "start": None} | joint
    m.clearance_joint("play", m.ground.at(0.1, 0.2, 0.7), body.origin, 1e-3, RADIUS, **given)
    m.start_near(ball=(0.1, 0.2, 0))
    m.start_moving(ball=(0.5, 0.0, 0.0))
    return m


@pytest.mark.parametrize("model", DAMPING_MODELS)
def test_an_impact_gives_back_what_its_restitution_says(model: str) -> None:
    """A (1 + e') = ln((1 + A) / (1 - A e')) of Hunt and Crossley's force, see forces/contact.py."""
    given = 0.8
    sol = ball(restitution=given, damping_model=model).simulate(5e-3)
    loss, back = DAMPING_MODELS[model](given), -sol.body("ball").vx[-1] / 0.5
    assert loss * (1.0 + back) == pytest.approx(math.log((1.0 + loss) / (1.0 - loss * back)), rel=1e-6)


def test_an_elastic_impact_keeps_the_energy_and_friction_takes_what_is_said() -> None:
    sol = ball().simulate(20e-3, tolerance=1e-10)
    assert np.abs(sol.energy.total - sol.energy.total[0]).max() < 1e-8 * sol.energy.total[0]
    assert sol.energy.potential.max() == pytest.approx(sol.energy.total[0], rel=1e-2)
    m = ball(friction=0.2, restitution=0.9)
    m.start_moving(ball=(0.5, 0.0, 300.0))
    sol = m.simulate(20e-3, steps=10000, tolerance=1e-10)
    lost = np.trapezoid(sol.force("play").power, sol.t)
    assert sol.energy.kinetic[-1] - sol.energy.kinetic[0] == pytest.approx(lost, rel=1e-3)
    force = sol.force("play")
    ratio = np.hypot(force.fx, force.fy)[normal(force) > 1.0] / normal(force)[normal(force) > 1.0]
    assert ratio.max() == pytest.approx(math.hypot(1.0, 0.2), rel=1e-6)
    gone = RADIUS - 1e-3
    spun, pushed = 1e-5 * (sol.body("ball").omega[-1] - 300.0), 0.2 * sol.body("ball").vy
    assert spun < 0.0
    turned = np.trapezoid(force.torque + (force.x - sol.body("ball").x) * force.fy
                          - (force.y - sol.body("ball").y) * force.fx, sol.t)  # fmt: skip
    assert spun == pytest.approx(turned, rel=1e-3)
    assert abs(spun) <= 0.2 * gone * np.trapezoid(normal(force), sol.t) * (1.0 + 1e-6)
    assert np.abs(pushed).max() > 0.0


def test_a_friction_that_only_begins_beyond_its_first_speed() -> None:
    """The journal slides at 0.3 m/s: nothing, half of it, all of it."""
    shares = {(0.4, 0.5): 0.0, (0.2, 0.4): 0.5, (0.0, 0.1): 1.0}
    for speeds, share in shares.items():
        m = ball(friction=0.2, slip_speeds=speeds)
        m.start_near(ball=(0.1 + 1.01e-3, 0.2, 0))
        m.start_moving(ball=(0.0, 0.0, 0.3 / (RADIUS - 1e-3)))
        force = m.simulate(1e-9).force("play")
        assert force.fy[0] == pytest.approx(-share * 0.2 * 1e9 * 1e-5**1.5, abs=1e-3)
        assert force.fx[0] == pytest.approx(-1e9 * 1e-5**1.5, rel=1e-4)


def hanging(start: Any = (0.0, 0.0)) -> Mechanism:
    m = Mechanism("hanging")
    bar = m.bar("bar", 0.1, mass=1.0)
    m.clearance_joint("pin", m.ground.at(0, 0), bar.start, 1e-4, RADIUS, stiffness=6e8, start=start)
    m.start_near(bar=-90)
    return m


def test_it_hangs_at_rest_where_the_contact_carries_it() -> None:
    m = hanging()
    rest = m.equilibrium()
    depth = (G / 6e8) ** (2.0 / 3.0)
    assert rest.body("bar").y == pytest.approx(-1e-4 - depth, abs=1e-10)
    assert rest.force("pin").fy == pytest.approx(G, rel=1e-6)
    assert rest.force("pin").gap == pytest.approx(-depth, abs=1e-10)
    assert rest.stability == "stable"
    rest.start(m)
    sol = m.simulate(0.05)
    assert np.ptp(sol.body("bar").y) < 1e-9
    bounce = max(mode.frequency for mode in m.modes() if mode.frequency)
    stiff = 1.5 * 6e8 * depth**0.5
    assert 2.0 * math.pi * bounce == pytest.approx(math.sqrt(stiff / 1.0), rel=1e-3)


def first_effort(m: Mechanism) -> float:
    effort = m.simulate(1e-6).force("pin").effort
    assert effort is not None
    return float(effort[0])


def test_a_journal_starts_no_deeper_in_the_wall_than_its_load_presses_it() -> None:
    """It may be pressed in ten times harder than by its load, in any direction; and by a hundredth of its clearance."""
    depth = (G / 6e8) ** (2.0 / 3.0)
    for times, refused in ((1.0, False), (9.9, False), (10.1, True), (100.0, True)):
        away = 1e-4 + depth * times ** (2.0 / 3.0)
        for place in ((0.0, -away), (0.6 * away, 0.8 * away)):
            if not refused:
                assert first_effort(hanging(place)) == pytest.approx(times * G, rel=1e-6)
                continue
            with pytest.raises(
                SimulationError, match=r"hanging: force 'pin' starts .* m deep .* pin .* carries 9.81 N"
            ):
                hanging(place).simulate(1e-6)
    light = hanging((0.0, 1.009e-4))
    light.gravity = None
    light.simulate(1e-6)
    light.change("pin", start=(0.0, 1.011e-4))
    with pytest.raises(
        SimulationError, match=r"without play carries 0 N. Give start= within its clearance of 0.0001 m"
    ):
        light.simulate(1e-6)
    light.change("pin", start=None)
    light.simulate(1e-6)


def test_rows_of_many_that_press_a_journal_in_have_the_reason_of_single_ones() -> None:
    m = slider_crank(0.5e-3, modulus=None, stiffness=6.6e10, start=(0.4e-3, 0.0))
    measure = {"x": final("slider.x")}
    many = m.simulate_many(0.1 * TURN, {"B": {"clearance": [0.5e-3, 0.1e-3]}}, measure=measure)
    assert many.good.tolist() == [True, False]
    assert "starts with its journal 0.0003 m deep" in str(many.reason[1])
    apart = m.simulate_many(0.1 * TURN, {"B": {"stiffness": [6.6e10, 6e10]}}, measure=measure)
    assert apart.way == "all of 2 in the compiled loop"
    m.change("B", start=(0.51e-3, 0.0))
    deep = m.simulate_many(0.1 * TURN, {"B": {"stiffness": [6.6e10, 6.6e14]}}, measure=measure)
    assert deep.good.tolist() == [True, False]


def test_damping_runs_with_other_integrators_and_restitution_says_that_it_does_not() -> None:
    m = slider_crank(0.5e-3, restitution=None, damping=0.2)
    here, there = (m.simulate(0.1 * TURN, method=method).body("slider").x for method in ("dop853", "radau"))
    assert np.abs(here - there).max() < 1e-7
    with pytest.raises(ModelError, match="take method='dop853', or damping= instead"):
        slider_crank(0.5e-3).simulate(0.1 * TURN, method="radau")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"clearance": 0.02}, "which leaves no journal"),
        ({"clearance": 0.0}, "clearance is 0; it must be positive"),
        ({"radius": -0.01}, "radius is -0.01; it must be positive"),
        ({"modulus": None}, "neither stiffness= nor modulus="),
        ({"stiffness": 1e9}, "both stiffness= and modulus="),
        ({"modulus": None, "stiffness": 1e9, "journal_modulus": 1e9}, "journal_modulus= and stiffness="),
        ({"poisson": 0.6}, "Poisson's ratio is within 0 .. 0.5"),
        ({"slip_speeds": (0.1, 0.1)}, "slip_speeds are 0.1 and 0.1 m/s"),
        ({"start": (0.01, 0.0)}, "beyond the bearing's radius"),
        ({"restitution": 1.5}, "it must be within 0 .. 1"),
        ({"damping": 0.1}, "give one of them"),
        ({"exponent": 0.5}, "exponent is 0.5; it must be 1 or more"),
    ],
)
def test_bad_numbers_are_refused_by_name(given: dict[str, Any], said: str) -> None:
    m = Mechanism("bad")
    bar = m.bar("bar", 0.1, mass=1.0)
    fit = {"clearance": 1e-4, "radius": RADIUS, "modulus": 207e9, "restitution": 0.9} | given
    with pytest.raises(ModelError, match=said):
        m.clearance_joint("pin", m.ground.at(0, 0), bar.start, **fit)
    assert not m.forces


def test_much_play_is_suspicious() -> None:
    assert not slider_crank(0.5e-3).check()
    [finding] = slider_crank(2e-3).check()
    assert "its clearance of 0.002 m is 20% of the bearing's radius" in str(finding)


def test_a_sweep_says_that_play_is_simulated() -> None:
    with pytest.raises(MobilityError, match=r"What has play \('B'\) is free to move in it, .* simulate\(\) does"):
        slider_crank(0.5e-3).sweep()


def test_a_mechanism_that_does_not_close_as_ideal_says_how_it_may_start() -> None:
    m = slider_crank(0.5e-3)
    m.change("rod", length=0.03)  # shorter than the crank: it reaches the guide in no half turn
    m.start_near(crank=90)
    m.drivers.clear()
    m.drive_angle("motor", m.bodies["crank"], constant_rate(1.0, 0.5 * math.pi))
    with pytest.raises(AssemblyError, match="'B' starts closed, without play; with start=None"):
        m.simulate(1e-3)
    m.change("B", start=None)
    assert m.simulate(1e-6).force("B").gap[0] < 0.0


def four_loose_pins() -> Mechanism:
    m = Mechanism("four_bar", gravity=None)
    crank, coupler, rocker = (m.bar(name, n, mass=0.2) for name, n in (("a", 0.04), ("b", 0.12), ("c", 0.09)))
    places = {
        "A": (m.ground.at(0, 0), crank.start), "B": (crank.end, coupler.start),
        "C": (coupler.end, rocker.end), "D": (m.ground.at(0.12, 0), rocker.start),
    }  # fmt: skip
    for name, (i, j) in places.items():
        m.clearance_joint(name, i, j, 0.1e-3, 5e-3, modulus=207e9, restitution=0.8)
    m.start_near(a=40, b=30, c=82.14)
    m.start_moving(a=30.0)
    return m


def test_play_in_every_pin_keeps_the_links_together_and_takes_energy() -> None:
    m = four_loose_pins()
    assert m.mobility().dof == 9
    sol = m.simulate(0.05, tolerance=1e-9)
    views = [sol.force(name) for name in "ABCD"]
    assert all(view.gap.min() > -0.02e-3 and view.gap.max() < 0.1e-3 + 1e-12 for view in views)
    lost = sol.energy.total[0] - sol.energy.total
    assert lost[-1] > 0.0
    assert np.diff(sol.energy.total).max() < 1e-9 * sol.energy.total[0]


def test_drivers_on_both_sides_of_a_play_move_as_they_are_said_to() -> None:
    m = slider_crank(0.5e-3)
    m.drive_coordinate("push", m.ground.at(0, 0), m.bodies["slider"].origin, polynomial(CRANK + ROD, 0.3))
    assert m.simulate(1e-5).body("slider").vx[0] == pytest.approx(0.3, abs=1e-9)
