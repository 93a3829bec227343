"""Change points of driven motions: passed on the smooth continuation or on the other assembly, with right efforts.

Exact answers: the coupler of a parallelogram stays parallel; closed forms of the places of pins; virtual work,
motor torque = dV/dtheta + d(T)/dt / omega, on the exact path.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, SingularPoseError, Solution, constant_rate, cycloidal, harmonic, table

G = 9.80665
RATE = 2 * math.pi
STEPS = (359, 360, 361, 720)
LINKAGES = {
    "parallelogram": ((0.3, 0.1, 0.3, 0.1), 1),
    "antiparallelogram": ((0.3, 0.1, 0.3, 0.1), -1),
    "kite, short ground": ((0.1, 0.1, 0.3, 0.3), 1),
    "kite, long ground": ((0.3, 0.1, 0.1, 0.3), 1),
    "1-2-4-5": ((0.4, 0.1, 0.2, 0.5), 1),
    "1-2-4-5, longest on ground": ((0.5, 0.1, 0.2, 0.4), 1),
    "2-5-4-3": ((0.2, 0.5, 0.4, 0.3), 1),
    "1-4-2-3": ((0.1, 0.4, 0.2, 0.3), 1),
}
"""(ground, crank, coupler, rocker) (m) and the side of the diagonal at the start."""


def pin_of(lengths: tuple[float, ...], theta: np.ndarray, side: float | np.ndarray) -> np.ndarray:
    """(T, 2) the pin between coupler and rocker on one side of the diagonal from the crank's pin to that on ground."""
    ground, crank, coupler, rocker = (np.longdouble(str(length)) for length in lengths)
    theta = np.asarray(theta, np.longdouble)
    x, y = crank * np.cos(theta), crank * np.sin(theta)
    dx, dy = ground - x, -y
    square = dx * dx + dy * dy
    along = (square + coupler**2 - rocker**2) / (2 * square)
    height = side * np.sqrt(np.maximum(coupler**2 / square - along * along, 0))
    return np.stack([x + along * dx - height * dy, y + along * dy + height * dx], axis=-1).astype(float)


def linkage(
    name: str, start: float = 60.0, turn: float = 0.0, mirrored: bool = False, scale: float = 1.0, law: object = None
) -> Mechanism:
    """Bars of 1 kg, ``start`` and ``turn`` in degrees."""
    lengths, side = LINKAGES[name]
    ground, *bars = (scale * length for length in lengths)
    flip, turned = (-1.0 if mirrored else 1.0), math.radians(turn)
    theta = flip * math.radians(start)
    pin = scale * pin_of(lengths, np.array([math.radians(start)]), side)[0] * [1.0, flip]
    tip, foot = bars[0] * np.array([math.cos(theta), math.sin(theta)]), np.array([ground, 0.0])
    m = Mechanism(name)
    crank, coupler, rocker = (
        m.bar(name, length, mass=1.0) for name, length in zip(("crank", "coupler", "rocker"), bars, strict=True)
    )
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(ground * math.cos(turned), ground * math.sin(turned)), rocker.start)
    m.drive_angle("motor", crank, law or constant_rate(flip * RATE, theta + turned))
    angles = {"crank": theta}
    for bar, way in (("coupler", pin - tip), ("rocker", pin - foot)):
        angles[bar] = math.atan2(way[1], way[0])
    m.start_near(**{bar: math.degrees(angle + turned) for bar, angle in angles.items()})
    return m


def exact_pin(name: str, theta: np.ndarray, start: float) -> np.ndarray:
    """The pin on the smooth motion: the side changes where the bars come into line, at half turns."""
    lengths, side = LINKAGES[name]
    ground, crank, coupler, rocker = lengths
    flat = [k for k in range(1, 5) if _in_line(ground, crank, coupler, rocker, k)]
    passed = sum((theta > k * math.pi).astype(int) for k in flat if k * math.pi > start)
    return pin_of(lengths, theta, side * (-1.0) ** passed)


def _in_line(ground: float, crank: float, coupler: float, rocker: float, half_turns: int) -> bool:
    distance = abs(ground - crank) if half_turns % 2 == 0 else ground + crank
    return any(math.isclose(distance, abs(rocker - sign * coupler), abs_tol=1e-12) for sign in (-1, 1))


def pins_of(sol: Solution, length: float, turn: float = 0.0, mirrored: bool = False, scale: float = 1.0) -> np.ndarray:
    """(T, 2) the end of the rocker in the linkage's own frame."""
    rocker, back = sol.body("rocker"), math.radians(-turn)
    x, y = rocker.x + scale * length * np.cos(rocker.theta), rocker.y + scale * length * np.sin(rocker.theta)
    out = np.stack([math.cos(back) * x - math.sin(back) * y, math.sin(back) * x + math.cos(back) * y], axis=1)
    return out / scale * [1.0, -1.0 if mirrored else 1.0]


def power_gap(sol: Solution) -> float:
    """Largest difference between the motor's power and the rate of the energy, by central differences in time."""
    power, total = sol.driver("motor").power, sol.energy.total
    rate = np.gradient(total, sol.t, edge_order=2)
    return float(np.nanmax(np.abs(power - rate)[2:-2])) / float(np.nanmax(np.abs(power)))


@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("name", LINKAGES)
def test_linkages_go_through_on_the_smooth_motion(name: str, steps: int) -> None:
    sol = linkage(name).sweep(1.0, steps=steps)
    theta = math.radians(60) + RATE * sol.t
    exact = exact_pin(name, theta, math.radians(60))
    gap = np.abs(pins_of(sol, LINKAGES[name][0][3]) - exact).max(axis=1)
    flat = np.abs(np.sin(theta)) < 1e-6  # there the closed form itself has half of its digits
    assert gap[~flat].max() < 1e-11
    assert gap.max() < 1e-7
    assert np.isfinite([sol.q, sol.v, sol.a]).all()
    assert sol.stats.acceleration_residual < 1e-8
    assert power_gap(sol) < 2e-3


@pytest.mark.parametrize("start", [0.5, 1.0, 37.3, 90.0, 179.99, 181.0, 359.0])
def test_a_parallelogram_stays_parallel_from_any_start(start: float) -> None:
    name = "parallelogram" if start < 180 else "antiparallelogram"  # the same bars beyond the flat pose
    for steps in STEPS:
        sol = linkage(name, start).sweep(steps=steps)
        assert np.abs(np.sin(sol.body("coupler").theta)).max() < 1e-11
        assert np.abs(sol.body("rocker").alpha).max() < 1e-6
        exact = 0.2 * G * np.cos(sol.body("crank").theta)
        np.testing.assert_allclose(sol.driver("motor").torque, exact, atol=1e-7)


@settings(max_examples=12)
@given(
    name=st.sampled_from(sorted(LINKAGES)),
    turn=st.sampled_from([0.0, 17.0, 90.0, -133.3]),
    mirrored=st.booleans(),
    scale=st.sampled_from([1e-3, 1.0, 40.0]),
    steps=st.sampled_from(STEPS),
)
def test_rotated_mirrored_and_scaled_linkages_do_the_same(
    name: str, turn: float, mirrored: bool, scale: float, steps: int
) -> None:
    sol = linkage(name, 60.0, turn, mirrored, scale).sweep(1.0, steps=steps)
    theta = math.radians(60) + RATE * sol.t
    gap = np.abs(pins_of(sol, LINKAGES[name][0][3], turn, mirrored, scale) - exact_pin(name, theta, math.radians(60)))
    assert gap[np.abs(np.sin(theta)) > 1e-6].max() < 1e-10


@pytest.mark.parametrize("digits", [3, 4, 6, 8, 10, 12])
def test_rounded_times_beside_a_change_point_give_the_same_torque(digits: int) -> None:
    times = np.round(np.linspace(0.0, 1.0, 361), digits)
    m = linkage("parallelogram")
    for sol in (m.sweep(times=times), m.simulate(times=times)):
        exact = 0.2 * G * np.cos(sol.body("crank").theta)
        np.testing.assert_allclose(sol.driver("motor").torque, exact, atol=1e-7)


def test_reactions_beside_a_change_point_grow_as_statics_says() -> None:
    """Half the weights of coupler and rocker hang at the rocker's end, held by a coupler whose arm vanishes there."""
    flat = 1.0 / 3.0
    near = [1e-3, 1e-5, 1e-7]
    times = sorted([0.0, *(flat - x for x in near), *(flat + x for x in near), 1.0])
    sol = linkage("parallelogram").sweep(times=times)
    assert np.isfinite(sol.lam).all()
    np.testing.assert_allclose((sol.joint("C").fx * np.sin(sol.body("crank").theta))[1:-1], G, rtol=2e-3)


def test_three_parallel_cranks_have_reactions_beside_the_pose_at_which_two_loops_are_flat() -> None:
    """Two loops pass at once: det J has a double root, reactions grow as its square root."""
    m = Mechanism("three cranks")
    coupler = m.bar("coupler", 0.3, mass=1.0)
    for k, place in enumerate((0.0, 0.2, 0.3)):
        crank = m.bar(f"crank{k}", 0.1, mass=1.0)
        m.revolute(f"foot{k}", m.ground.at(place, 0), crank.start)
        m.revolute(f"head{k}", crank.end, coupler.at(place, 0))
    m.drive_angle("motor", m.bodies["crank0"], constant_rate(RATE, math.radians(60)))
    m.start_near(crank0=60, crank1=60, crank2=60, coupler=0)
    sol = m.sweep(1.0, steps=1439)
    theta = math.radians(60) + RATE * sol.t
    assert np.abs(np.sin(theta)).min() < 0.01
    assert sol.is_defined.all()
    np.testing.assert_allclose(sol.driver("motor").torque, 0.25 * G * np.cos(theta), atol=1e-6)
    heads = [sol.joint(f"head{k}") for k in range(3)]
    assert np.abs(heads[0].fx).max() > 100.0, "pins wedge the coupler"
    body = sol.body("coupler")
    np.testing.assert_allclose(sum(head.fx for head in heads), body.ax, atol=1e-5)
    np.testing.assert_allclose(sum(head.fy for head in heads), body.ay + G, atol=1e-5)


def test_rows_without_efforts_are_nan_and_named() -> None:
    sol = linkage("parallelogram").sweep(1.0)
    rows = np.flatnonzero(~sol.is_defined)
    assert rows.tolist() == [120, 300]
    assert np.isnan(sol.joint("C").fx[rows]).all()
    assert np.isfinite(sol.driver("motor").torque).all()
    assert [note.split(":")[0] for note in sol.notes] == [
        f"row {row}, t = {time:.9g} s" for row, time in ((120, 1 / 3), (300, 5 / 6))
    ]
    assert "reactions of A, B, C, D" in sol.notes[0]
    assert "2 with efforts that do not exist" in repr(sol)
    kept = sol.only(sol.is_defined)
    assert (len(kept.t), kept.notes) == (359, ())


def test_without_weight_reactions_are_finite_at_the_change_point() -> None:
    m = linkage("parallelogram")
    m.gravity = None
    for sol in (m.sweep(1.0), m.simulate(1.0)):
        assert not sol.notes
        # the coupler's inertia is shared: half of 1 kg at 0.1 m
        np.testing.assert_allclose(sol.joint("C").magnitude, 0.5 * 0.1 * RATE**2, rtol=1e-6)


def slider_crank(start: float = 30.0, fold: bool = False, mass: float = 1.0) -> Mechanism:
    """Crank and rod of 0.1 m, in line with the slider; folded, the rod lies on the crank and the slider rests."""
    m = Mechanism("equal slider-crank")
    crank, rod, slider = m.bar("crank", 0.1, mass=mass), m.bar("rod", 0.1, mass=mass), m.body("slider", mass=mass)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(RATE, math.radians(start)))
    m.start_near(crank=start, rod=180 + start if fold else -start)
    return m


@pytest.mark.parametrize("steps", STEPS)
def test_an_equal_slider_crank_goes_through_on_both_branches(steps: int) -> None:
    sol = slider_crank().sweep(1.0, steps=steps)
    theta = sol.body("crank").theta
    np.testing.assert_allclose(sol.body("slider").x, 0.2 * np.cos(theta), atol=1e-13)
    np.testing.assert_allclose(sol.body("slider").ax, -0.2 * RATE**2 * np.cos(theta), atol=1e-7)
    # T = omega^2 (0.2^2 sin^2 + 0.15^2 sin^2 + 0.05^2 cos^2) / 2 + ...: slider and rod change their speeds
    changes = (0.2**2 + 0.15**2 - 0.05**2) * np.sin(theta) * np.cos(theta) * RATE**2
    np.testing.assert_allclose(sol.driver("motor").torque, 0.1 * G * np.cos(theta) + changes, atol=1e-7)
    folded = slider_crank(fold=True).sweep(1.0, steps=steps)
    assert np.abs(folded.body("slider").x).max() < 1e-13
    np.testing.assert_allclose(folded.driver("motor").torque, 0.1 * G * np.cos(theta), atol=1e-7)


@pytest.mark.parametrize("steps", STEPS)
def test_the_other_assembly_is_taken_where_asked_for(steps: int) -> None:
    """From cos to rest and back: the slider stands still between the two change points that are switched."""
    m = slider_crank()
    first, second = 1 / 6, 4 / 6
    sol = m.sweep(1.0, steps=steps, switch_at=[first, second])
    still = (sol.t > first) & (sol.t < second)
    theta = sol.body("crank").theta
    np.testing.assert_allclose(sol.body("slider").x, np.where(still, 0.0, 0.2 * np.cos(theta)), atol=1e-12)
    np.testing.assert_allclose(
        sol.body("slider").vx[~np.isclose(sol.t, first) & ~np.isclose(sol.t, second)],
        np.where(still, 0.0, -0.2 * RATE * np.sin(theta))[~np.isclose(sol.t, first) & ~np.isclose(sol.t, second)],
        atol=1e-9,
    )
    still &= ~np.isclose(sol.t, first) & ~np.isclose(sol.t, second)
    np.testing.assert_allclose(sol.driver("motor").torque[still], (0.1 * G * np.cos(theta))[still], atol=1e-6)
    jumped = np.flatnonzero(np.isclose(sol.t, first) | np.isclose(sol.t, second))
    assert np.isnan(sol.driver("motor").torque[jumped]).all()
    assert len(sol.notes) == len(jumped)


@pytest.mark.parametrize("steps", [359, 360])
def test_a_parallelogram_becomes_an_antiparallelogram(steps: int) -> None:
    m = linkage("parallelogram")
    sol = m.sweep(1.0, steps=steps, switch_at=[1 / 3])
    theta = math.radians(60) + RATE * sol.t
    lengths, _ = LINKAGES["parallelogram"]
    late = theta > math.pi + 1e-9
    side = np.where(late & (theta > 2 * math.pi), -1.0, 1.0)
    exact = np.where(late[:, None], pin_of(lengths, theta, side), exact_pin("parallelogram", theta, 1.0))
    clear = np.abs(np.sin(theta)) > 1e-6
    np.testing.assert_allclose(pins_of(sol, 0.1)[clear], exact[clear], atol=1e-11)
    for before, after in pairwise(np.flatnonzero(clear)):
        assert np.abs(pins_of(sol, 0.1)[after] - pins_of(sol, 0.1)[before]).max() < 0.02
    assert sol.stats.power_residual < 1e-7


def test_a_switch_where_no_change_point_is_raises_an_error() -> None:
    with pytest.raises(
        ModelError, match=r"switch_at has t = 0\.5 s, but it passes change points at t = 0\.333333333, 0\.8"
    ):
        linkage("parallelogram").sweep(1.0, switch_at=[0.5])
    with pytest.raises(ModelError, match="switch_at is 'soon'"):
        linkage("parallelogram").sweep(1.0, switch_at="soon")


@pytest.mark.parametrize(
    "times", [[0.0, 1 / 3], [0.0, 0.2, 1 / 3 - 1e-7], [0.333333], [0.0, 1 / 3 + 1e-9], [0.3333, 1 / 3]]
)
def test_a_motion_may_end_and_begin_at_a_change_point(times: list[float]) -> None:
    sol = linkage("parallelogram").sweep(times=times)
    np.testing.assert_allclose(np.sin(sol.body("coupler").theta), 0.0, atol=1e-9)
    np.testing.assert_allclose(sol.driver("motor").torque, 0.2 * G * np.cos(sol.body("crank").theta), atol=1e-6)


def _uneven(t: np.ndarray) -> np.ndarray:
    return math.radians(60) + RATE * t + 0.1 * np.sin(RATE * t)


LAWS = {
    "turning round there": (180.0, harmonic(math.radians(120), RATE / 2, math.pi / 2, math.radians(60))),
    "to and fro": (60.0, harmonic(math.radians(170), RATE, 0.0, math.radians(60))),
    "table": (60.0, table(np.linspace(0, 1, 37), _uneven(np.linspace(0, 1, 37)))),
    "cycloidal": (60.0, cycloidal(math.radians(200), 1.0, start=math.radians(60))),
}
"""Laws of the crank, and degrees at which they are at t = 0 or, turned round, half a second later."""


@pytest.mark.parametrize("name", LAWS)
def test_laws_of_all_sorts_pass(name: str) -> None:
    at_rest, law = LAWS[name]
    begin = 0.2 if at_rest == 180.0 else 0.0
    times = np.linspace(begin, 2.2 if begin else 1.0, 361 if not begin else 401)
    m = linkage("parallelogram", math.degrees(float(law(np.array([begin]))[0, 0])), law=law)
    sol = m.sweep(times=times)
    assert np.abs(np.sin(sol.body("coupler").theta)).max() < 1e-9
    for part in ("theta", "omega", "alpha"):
        crank, rocker = getattr(sol.body("crank"), part), getattr(sol.body("rocker"), part)
        np.testing.assert_allclose(rocker, crank, atol=1e-6)
    # V and T of a parallelogram: rocker and crank turn, the coupler is carried
    crank = sol.body("crank")
    inertia = 2 * m.bodies["crank"].inertia + 2 * 0.05**2 + 0.1**2
    exact = 0.2 * G * np.cos(crank.theta) + inertia * crank.alpha
    torque = sol.driver("motor").torque
    np.testing.assert_allclose(torque[sol.is_defined], exact[sol.is_defined], atol=1e-5)
    assert np.isnan(torque).sum() <= 2


def test_loops_that_pass_together_all_go_on() -> None:
    m = Mechanism("row")
    last = None
    for k in range(4):
        rod = m.bar(f"rod{k}", 0.1, 1.0)
        m.revolute(f"foot{k}", m.ground.at(0.3 * k, 0), rod.start)
        m.start_near(**{rod.name: 60})
        if last is not None:
            bar = m.bar(f"bar{k}", 0.3, 1.0)
            m.revolute(f"left{k}", last.end, bar.start)
            m.revolute(f"right{k}", bar.end, rod.end)
        last = rod
    m.drive_angle("motor", m.bodies["rod0"], constant_rate(RATE, math.pi / 3))
    sol = m.sweep(1.0)
    for k in range(1, 4):
        np.testing.assert_allclose(np.sin(sol.body(f"bar{k}").theta), 0.0, atol=1e-10)
    weight = (4 * 0.05 + 3 * 0.1) * G
    np.testing.assert_allclose(sol.driver("motor").torque, weight * np.cos(sol.body("rod0").theta), atol=1e-6)


def test_a_start_at_a_change_point_raises_an_error() -> None:
    with pytest.raises(SingularPoseError, match="start pose"):
        linkage("parallelogram", 180.0).sweep(1.0)


def three_rods(turn: float) -> Solution:
    """Return the motion of a deck on three alike rods from 1.1 rad, in a world turned by an angle (rad)."""
    m = Mechanism("three rods", gravity=(G * math.sin(turn), -G * math.cos(turn)))
    c, s = math.cos(turn), math.sin(turn)
    deck = m.body("deck", mass=3.0, com=(0.0, 0.1), inertia=0.2)
    rods = [m.bar(f"rod{k}", 0.2, mass=1.0) for k in range(3)]
    for rod, x in zip(rods, (0.0, 0.33, 0.13), strict=True):
        m.revolute(f"foot of {rod.name}", m.ground.at(c * x, s * x), rod.start)
        m.revolute(f"head of {rod.name}", deck.at(x, 0), rod.end)
    m.start_near(deck=math.degrees(turn), **{rod.name: math.degrees(1.1 + turn) for rod in rods})
    m.drive_angle("motor", rods[0], cycloidal(-2.0, 1.0, start=1.1 + turn))
    return m.sweep(1.0, steps=60)


@pytest.mark.parametrize("beside", [-0.02, 1e-6, 0.017, 0.1])
@pytest.mark.parametrize("quarter", [0.0, 0.5 * math.pi])
def test_rods_that_repeat_others_have_efforts_where_rows_of_some_are_singular(quarter: float, beside: float) -> None:
    """With one row of the third rod, but not with both, there is a toggle where it is along an axis of the world."""
    known, sol = three_rods(0.0), three_rods(quarter - 1.1 + beside)
    assert sol.is_defined.all()
    assert sol.stats.position_residual < 1e-12
    torque = known.driver("motor").torque
    assert np.allclose(sol.driver("motor").torque, torque, rtol=0.0, atol=1e-9 * np.abs(torque).max())


@pytest.mark.parametrize("order", [(0, 1, 2, 4, 5, 3), (5, 1, 2, 4, 3, 0), (4, 2, 3, 1, 5, 0)])
def test_rods_that_repeat_others_pass_their_flat_pose_in_any_order_of_joints(order: tuple[int, ...]) -> None:
    """Rows of some choices pass two change points there at once; the platform passes one."""

    def torque(order: tuple[int, ...]) -> np.ndarray:
        m = Mechanism("three rods", gravity=(0.0, -G))
        deck = m.body("deck", mass=3.0, com=(0.0, 0.1), inertia=0.2)
        rods, places = [m.bar(f"rod{k}", 0.236, mass=1.0) for k in range(3)], (0.0, 0.33, 0.13)
        for k in order:
            rod, x = rods[k % 3], places[k % 3]
            ends = (m.ground.at(x, 0), rod.start) if k < 3 else (deck.at(x, 0), rod.end)
            m.revolute(f"joint{k}", *ends)
        start = 1.0721890625819386
        m.start_near(deck=0, **{rod.name: math.degrees(start) for rod in rods})
        m.drive_angle("motor", rods[0], cycloidal(-math.pi, 2.453386424393165, start=start))
        return m.sweep(2.453386424393165, steps=360).driver("motor").torque

    known = torque((0, 1, 2, 3, 4, 5))
    assert np.allclose(torque(order), known, rtol=0.0, atol=1e-9 * np.abs(known).max())
