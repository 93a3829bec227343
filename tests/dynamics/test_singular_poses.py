"""Redundant joints, change points, toggles and stretched chains in forward dynamics: solved, or refused by name."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbsd import AssemblyError, Body, Mechanism, SimulationError, SingularPoseError, constant_rate

G = 9.81


def parallelogram(start: float, middle: float | None = None, longer: float = 0.0) -> Mechanism:
    """Equal cranks, and a third one of length ``middle`` that repeats them; a change point where all lie flat.

    ``longer``: what the deck is too long.
    """
    m = Mechanism("parallelogram", gravity=(0.0, -G))
    left, deck, right = (
        m.bar("left", 1.0, mass=1.0),
        m.bar("deck", 2.0 + longer, mass=1.0),
        m.bar("right", 1.0, mass=1.0),
    )
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, deck.start)
    m.revolute("C", deck.end, right.end)
    m.revolute("D", m.ground.at(2, 0), right.start)
    m.start_near(left=start, deck=0, right=start)
    if middle is not None:
        third = m.bar("middle", middle, mass=1.0)
        m.revolute("E", m.ground.at(1, 0), third.start)
        m.revolute("F", third.end, deck.at(1, 0))
        m.start_near(middle=start)
    return m


@pytest.mark.parametrize("middle", [None, 1.0], ids=["plain", "redundant"])
def test_a_parallelogram_swings_through_its_change_point(middle: float | None) -> None:
    """All cranks are one pendulum: T = (3 m_c / 3 + m_d) theta'^2 / 2 with cranks 1 / 3 each, through flat poses."""
    m = parallelogram(50.0, middle)
    sol = m.simulate(3.0)
    left, right = sol.body("left"), sol.body("right")
    cranks = 3 if middle else 2
    inertia, pull = cranks / 3 + 1.0, (cranks / 2 + 1.0) * G
    energy = 0.5 * inertia * left.omega**2 + pull * np.sin(left.theta)
    np.testing.assert_allclose(energy, energy[0], atol=1e-3)
    np.testing.assert_allclose(left.theta, right.theta, atol=1e-6)
    assert left.theta.min() < -math.pi, "it has passed both flat poses"
    assert sol.stats.position_residual < 1e-9
    if middle:
        assert sol.mobility.redundant_rows == 1


@pytest.mark.parametrize("middle", [None, 1.0], ids=["plain", "redundant"])
def test_a_start_at_the_change_point_is_refused(middle: float | None) -> None:
    with pytest.raises(SingularPoseError, match=r"parallelogram: the start pose at t = 0 s is singular .* start_near"):
        parallelogram(0.0, middle).simulate(1.0)
    assert parallelogram(1.0, middle).simulate(0.5).stats.position_residual < 1e-9, "a little beside it goes on"


@pytest.mark.parametrize("broken", ["A", "B", "C", "D", "E", "F"])
def test_a_joint_that_breaks_leaves_its_work_to_those_that_repeat_it(broken: str) -> None:
    """Whichever pin goes, the deck stays on two cranks, as if the third were not there from then on."""
    m = parallelogram(50.0, 1.0)
    m.event("breaks", lambda t, _: t - 0.1, action=lambda moment: moment.release(broken))
    sol = m.simulate(0.6, steps=60)
    assert [event.time for event in sol.events] == pytest.approx([0.1])
    assert sol.stats.position_residual < 1e-9
    assert np.ptp(sol.audit) < 1e-5
    np.testing.assert_allclose(sol.body("deck").theta, 0.0, atol=1e-9)
    fast = sol.joint(broken).magnitude
    assert fast[:10].max() > 1.0
    assert fast[11:].max() == 0.0
    loose = {"A": "left", "B": "left", "C": "right", "D": "right", "E": "middle", "F": "middle"}[broken]
    others = [name for name in ("left", "middle", "right") if name != loose]
    np.testing.assert_allclose(sol.body(others[0]).theta, sol.body(others[1]).theta, atol=1e-9)
    assert abs(sol.body(loose).theta - sol.body(others[0]).theta)[-1] > 0.01
    between = sol.at(0.4321)
    assert abs(between.body("deck").theta[0]) < 1e-9


def test_two_joints_that_break_leave_a_pendulum() -> None:
    m = parallelogram(50.0, 1.0)
    m.event("first", lambda t, _: t - 0.1, action=lambda moment: moment.release("C"))
    m.event("second", lambda t, _: t - 0.2, action=lambda moment: moment.release("F"))
    sol = m.simulate(0.8, steps=80)
    assert abs(sol.body("deck").theta[:21]).max() < 1e-9
    assert abs(sol.body("deck").theta[-1]) > 0.1, "the deck hangs on one pin"
    assert np.ptp(sol.audit) < 1e-5
    assert sol.stats.position_residual < 1e-9


def test_redundant_joints_that_disagree_are_refused() -> None:
    with pytest.raises(AssemblyError, match=r"parallelogram: the links do not close at t = 0 s: joint"):
        parallelogram(50.0, 1.001).simulate(1.0)


def test_a_stretched_chain_is_refused() -> None:
    m = Mechanism("stretched")
    a, b = m.bar("a", 1.0, mass=1.0), m.bar("b", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, m.ground.at(2, 0))
    m.start_near(a=0, b=0)
    with pytest.raises(SingularPoseError, match=r"stretched: .* only there 'C' repeats what others hold"):
        m.simulate(1.0)


def test_a_locked_structure_stands() -> None:
    m = Mechanism("truss", gravity=(0.0, -G))
    a, b = m.bar("a", 1.0, mass=1.0), m.bar("b", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, m.ground.at(1.2, 0))
    m.start_near(a=50, b=-50)
    sol = m.simulate(1.0)
    assert sol.mobility.dof == 0
    assert np.abs(np.diff(sol.q, axis=0)).max() == 0.0
    np.testing.assert_allclose(sol.joint("A").fy - sol.joint("C").fy, 0.0, atol=3.0 * G)
    beam = Mechanism("beam", gravity=(0.0, -G))
    bar = beam.bar("bar", 1.0, mass=3.0)
    beam.weld("wall", beam.ground.origin, bar.start)
    beam.revolute("prop", beam.ground.at(1, 0), bar.end)
    held = beam.simulate(1.0)
    assert held.mobility.nominal == -2
    total = held.joint("wall").reaction + held.joint("prop").reaction
    np.testing.assert_allclose(total, np.tile([0.0, 3.0 * G], (len(held.t), 1)), atol=1e-9)


def slider_crank(start: float) -> Mechanism:
    """Crank as long as its rod: a change point where the slider stands over the crank's pin."""
    m = Mechanism("slider-crank", gravity=(0.0, -G))
    crank, rod = m.bar("crank", 0.3, mass=1.0), m.bar("rod", 0.3, mass=1.0)
    slider = m.body("slider", 1.0, inertia=0.1)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("G", m.ground.origin, slider.origin)
    m.start_near(crank=start, rod=-start, slider=(0.6 * math.cos(math.radians(start)), 0, 0))
    return m


def test_dead_centre_and_change_point_are_told_apart() -> None:
    assert slider_crank(0.0).simulate(0.5).stats.position_residual < 1e-9, "a dead centre is no matter without a driver"
    with pytest.raises(SingularPoseError, match="slider-crank: the start pose"):
        slider_crank(90.0).simulate(0.5)
    m = slider_crank(0.0)
    m.drive_coordinate("push", m.ground.origin, m.bodies["slider"].origin, constant_rate(-0.1, 0.6))
    with pytest.raises(SingularPoseError, match="only there 'push' repeats"):
        m.simulate(0.5)


def test_a_toggle_stops_with_its_time() -> None:
    m = Mechanism("toggle", gravity=(0.0, -G))
    crank, coupler, rocker = m.bar("crank", 0.5, 1.0), m.bar("coupler", 0.4, 1.0), m.bar("rocker", 0.5, 1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(1.0, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(1.0, math.radians(40)))
    m.start_near(crank=40, coupler=0, rocker=100)
    reach = math.acos((0.5**2 + 1.0 - 0.9**2) / (2 * 0.5 * 1.0))
    with pytest.raises(SimulationError, match=r"toggle: dop853 stops at t = 0.41706.* The pose is singular here"):
        m.simulate(2.0)
    assert reach - math.radians(40) == pytest.approx(0.41706, abs=1e-4)


def bars(loops: int, turn: float) -> Mechanism:
    """IFToMM A02 in a world turned by ``turn`` (rad): frames at the middles of uniform bars of 1 m and 1 kg."""
    m = Mechanism("bars", gravity=(G * math.sin(turn), -G * math.cos(turn)))
    c, s = math.cos(turn), math.sin(turn)

    def bar(name: str, x: float, y: float, angle: float, speed: tuple[float, float]) -> Body:
        body = m.body(name, 1.0, inertia=1 / 12)
        m.start_near(**{name: (c * x - s * y, s * x + c * y, math.degrees(angle + turn))})
        m.start_moving(**{name: (c * speed[0], s * speed[0], speed[1])})
        return body

    uprights = [bar(f"upright{k}", k, 0.5, math.pi / 2, (0.5, -1.0)) for k in range(loops + 1)]
    for k, upright in enumerate(uprights):
        m.revolute(f"foot{k}", m.ground.at(c * k, s * k), upright.at(-0.5, 0))
    for k in range(loops):
        coupler = bar(f"coupler{k}", k + 0.5, 1.0, 0.0, (1.0, 0.0))
        m.revolute(f"left{k}", uprights[k].at(0.5, 0), coupler.at(-0.5, 0))
        m.revolute(f"right{k}", uprights[k + 1].at(0.5, 0), coupler.at(0.5, 0))
    return m


@pytest.mark.parametrize(
    ("formulation", "loops", "tolerance", "turn"),
    [
        ("independent", 1, 1e-7, 0.0),
        ("independent", 5, 1e-7, 0.0),
        ("independent", 10, 1e-8, 0.0),
        ("independent", 5, 1e-9, 0.3),
        ("independent", 5, 1e-10, 1.1),
        ("independent", 5, 3e-11, 0.0),
        ("independent", 40, 1e-10, 0.3),
        ("reference", 5, 1e-8, 0.3),
        ("reference", 5, 1e-9, 0.0),
        ("reference", 5, 3e-11, 1.1),
        ("reference", 40, 1e-10, 0.3),
    ],
)
def test_tight_tolerances_are_met_through_change_points(
    formulation: str, loops: int, tolerance: float, turn: float
) -> None:
    """The error falls with the tolerance, down to 1e-8 rad, though all bars lie in one line twice in each swing."""
    inertia, load = (loops + 1) / 3 + loops, G * ((loops + 1) / 2 + loops)
    sol = bars(loops, turn).simulate(10.0, steps=100, tolerance=tolerance, formulation=formulation)
    exact = solve_ivp(
        lambda t, y: (y[1], -load * math.cos(y[0]) / inertia), (0, 10), (math.pi / 2, -1.0),
        method="DOP853", t_eval=sol.t, rtol=1e-13, atol=1e-14,
    ).y[0]  # fmt: skip
    for name in ("upright0", f"upright{loops}"):
        error = np.abs(sol.body(name).theta - turn - exact).max()
        assert error < max(300 * tolerance, 1e-8)
    assert sol.stats.position_residual < 1e-9


@pytest.mark.parametrize("formulation", ["independent", "reference"])
@pytest.mark.parametrize("longer", [1e-2, 1e-3, 1e-5])
def test_links_that_nearly_close_stay_on_their_branch(formulation: str, longer: float) -> None:
    """A deck that is a little too long: the cranks may not pass through one line, however fast they come near."""
    m = parallelogram(90.0, longer=longer)
    m.start_moving(left=-1.0)
    sol = m.simulate(2.0, steps=100, tolerance=1e-10, formulation=formulation)
    left, right = sol.body("left"), sol.body("right")
    assert left.theta[-1] > 5.0
    assert abs(right.theta[-1] - left.theta[-1]) > 4.0
    assert np.ptp(sol.audit) < 1e-5


def three_cranks(turned: float) -> Mechanism:
    """Three parallel cranks of 0.4 m on one deck, the world ``turned`` (rad); any two of them hold the deck."""
    c, s = math.cos(turned), math.sin(turned)
    m = Mechanism("three_cranks", gravity=(G * s, -G * c))
    deck = m.body("deck", mass=0.7, inertia=0.0125)
    for k, (x, y) in enumerate([(0.0, 0.0), (0.2, 0.1), (0.5, 0.2)]):
        crank = m.bar(f"crank{k}", 0.4, mass=0.5)
        m.revolute(f"foot{k}", m.ground.at(c * x - s * y, s * x + c * y), crank.start)
        m.revolute(f"head{k}", deck.at(x, y), crank.end)
        m.start_near(**{f"crank{k}": math.degrees(-0.2 + turned)})
    m.start_near(deck=math.degrees(turned))
    m.start_moving(crank0=6.0)
    return m


@pytest.mark.parametrize("turned", [0.0, 0.3, 1.1, 2.6])
def test_redundant_cranks_turn_through_poses_where_two_of_them_lie_flat(turned: float) -> None:
    """All cranks are one pendulum: (3 m L^2 / 3 + m_d L^2) theta'' = -(3 m / 2 + m_d) g L cos(theta)."""
    sol = three_cranks(turned).simulate(1.5, tolerance=1e-10)
    inertia, pull = 0.5 * 0.16 + 0.7 * 0.16, (3 * 0.5 / 2 + 0.7) * G * 0.4
    exact = solve_ivp(
        lambda _, y: (y[1], -pull / inertia * math.cos(y[0])),
        (0.0, 1.5),
        (-0.2, 6.0),
        t_eval=sol.t,
        method="DOP853",
        rtol=1e-13,
        atol=1e-13,
    )
    np.testing.assert_allclose(sol.body("crank0").theta - turned, exact.y[0], rtol=0, atol=1e-8)
    assert np.ptp(exact.y[0]) > math.pi, "every pair of cranks has been flat"
    assert sol.stats.position_residual < 1e-10


def test_two_cranks_that_lie_flat_are_passed_between_events_too() -> None:
    """The same motion where a stop, which it never meets, has it go from event to event."""
    m, n = three_cranks(0.3), three_cranks(0.3)
    n.event("never", lambda t, moment: moment.body("crank0").theta - 50.0)
    plain, watched = m.simulate(1.5, tolerance=1e-10), n.simulate(1.5, tolerance=1e-10)
    np.testing.assert_allclose(plain.body("crank0").theta, watched.body("crank0").theta, rtol=0, atol=1e-8)
    some = np.array([0.111, 0.77, 1.31])
    np.testing.assert_allclose(
        watched.at(some).body("crank0").theta, m.simulate(times=[0.0, *some], tolerance=1e-10).body("crank0").theta[1:],
        rtol=0, atol=1e-8,
    )  # fmt: skip


def test_a_massless_base_carries_what_ground_does_near_a_change_point() -> None:
    """Reactions on a base without mass that is welded to ground, in a run that comes near flat cranks."""

    def on(base: bool) -> Mechanism:
        m = Mechanism("row", gravity=(0.0, -G))
        foot = m.ground
        if base:
            foot = m.body("base")
            m.weld("base", m.ground.at(0.3, 0.2), foot.at(0.3, 0.2))
        rods = [m.bar(f"rod{k}", 1.0, mass=1.0) for k in range(2)]
        deck = m.bar("deck", 1.0, mass=1.0)
        for k, rod in enumerate(rods):
            m.revolute(f"foot{k}", foot.at(k, 0), rod.start)
            m.revolute(f"head{k}", deck.at(k, 0), rod.end)
        m.start_near(rod0=51.6328, rod1=51.6328, deck=0)
        m.start_moving(rod0=-1.5)
        return m

    rough = on(base=False).simulate(0.6, steps=600)
    flat = float(np.interp(0.0, -rough.body("rod0").theta, rough.t))
    times = np.sort([*np.linspace(0.0, 1.5, 301), flat - 1e-6, flat + 1e-6])
    here, there = (on(base).simulate(times=times, tolerance=1e-9) for base in (False, True))
    assert here.singularity_margin.min() < 1e-5
    for name in ("foot0", "foot1", "head0", "head1"):
        for part in ("fx", "fy"):
            a, b = getattr(here.joint(name), part), getattr(there.joint(name), part)
            np.testing.assert_allclose(
                a, b, rtol=0, atol=1e-3 * np.abs(a).max()
            )  # 1e-9 over a margin of 1e-5, and more


@pytest.mark.parametrize("away", [0.0, 1.0, 3.0, 10.0, 30.0])
def test_redundant_cranks_far_from_the_origin_are_not_singular(away: float) -> None:
    """The size of the mechanism is that from the origin, and poses are tried at parts of it beside the start."""
    m = Mechanism("cranks")
    coupler = m.body("coupler", 0.5, com=(0.2, 0.0), inertia=0.07)
    for k, (x, y) in enumerate([(0.0, 0.0), (0.2, 0.1), (0.5, 0.2)]):
        bar = m.bar(f"bar{k}", 0.4, mass=0.5)
        m.revolute(f"foot{k}", m.ground.at(away + x, 0.7 * away + y), bar.start)
        m.revolute(f"head{k}", coupler.at(x, y), bar.end)
    m.start_near(bar0=-121, bar1=-121, bar2=-121, coupler=(away - 0.206, 0.7 * away - 0.343, 0))
    sol = m.simulate(0.3, steps=10)
    np.testing.assert_allclose(sol.body("bar0").theta, sol.body("bar2").theta, atol=1e-9)


def platform(start: float, mass: float = 1.0) -> Mechanism:
    """Return a platform on three alike rods from one angle (rad), of which any two hold it."""
    m = Mechanism("platform", gravity=(0.0, -G))
    plate = m.body("plate", mass=mass, com=(0.2, 0.1), inertia=0.02)
    for k, (x, y) in enumerate([(0.0, 0.0), (0.2, 0.1), (0.5, 0.2)]):
        rod = m.body(f"rod{k}", mass=0.5 + 0.1 * k, com=(0.2, 0.0), inertia=0.01)
        m.revolute(f"foot{k}", m.ground.at(x, y), rod.at(0, 0))
        m.revolute(f"head{k}", plate.at(x, y), rod.at(0.4, 0))
        m.start_near(**{f"rod{k}": (x, y, math.degrees(start))})
    m.start_near(plate=(0.4 * math.cos(start), 0.4 * math.sin(start), 0.0))
    return m


@pytest.mark.parametrize("beside", [0.0, 1e-7, 1e-4, -3e-3])
def test_rods_that_repeat_others_start_in_line_with_two_feet(beside: float) -> None:
    """Two of the rods are flat there, all three are not."""
    start = math.atan2(0.1, 0.2) + beside
    sol = platform(start).simulate(0.5, steps=10, tolerance=1e-11)
    turn = sol.body("rod0").theta
    inertia = sum(0.01 + (0.5 + 0.1 * k) * 0.2**2 for k in range(3)) + 0.4**2
    lever = (1.8 * 0.2 + 0.4) * G / inertia
    assert np.allclose(sol.body("plate").theta, 0.0, rtol=0.0, atol=1e-9)
    speed = np.sqrt(2.0 * lever * np.maximum(np.sin(start) - np.sin(turn), 0.0))
    assert np.allclose(np.abs(sol.body("rod0").omega), speed, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("start", [1.0, 1.25])
def test_rods_that_repeat_others_have_derivatives_where_two_of_them_are_flat(start: float) -> None:
    h, of = 1e-4, "plate.x"
    own = platform(start).sensitivities(of, "plate.mass", 1.5, 10, tolerance=1e-9)
    there, here = (platform(start, 1.0 + h * side).simulate(1.5, steps=10, tolerance=1e-11) for side in (1, -1))
    known = (there.body("plate").x - here.body("plate").x) / (2.0 * h)
    assert np.allclose(own[of][:, 0], known, rtol=0.0, atol=2e-5 * np.abs(known).max())
