"""A driven motion stays on its assembly, or is refused: near change points and toggles, at any number of outputs."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from mbsd import Mechanism, SingularPoseError, constant_rate, cycloidal, function, harmonic, table
from mbsd.base.errors import BranchError, LimitError, MechanismError, ModelError
from mbsd.kinematics.march import March, march_along
from mbsd.kinematics.prepared import prepare
from tools.models.guided import geneva
from tools.random_mechanisms.linkages import driven_linkage

GROUND, CRANK, COUPLER, ROCKER = 0.30, 0.10, 0.25, 0.15
"""m; shortest and longest together are as long as the others, so all bars lie in line at one crank angle."""
FEW = (1, 2, 3, 12, 36, 90, 360, 1440)
ROUTES = pytest.mark.parametrize("closed", [True, False], ids=["closed form", "Newton-Raphson"])


def joint_c(theta: np.ndarray, more: float, side: float = 1.0) -> np.ndarray:
    """(T, 2) exact places of the pin between coupler and rocker on one side of the diagonal, at crank angles theta."""
    theta = np.asarray(theta, np.longdouble)
    x, y = CRANK * np.cos(theta), CRANK * np.sin(theta)
    dx, dy = GROUND - x, -y
    square = dx * dx + dy * dy
    along = (square + COUPLER**2 - (np.longdouble(ROCKER) + more) ** 2) / (2 * square)
    height = side * np.sqrt(np.maximum(COUPLER**2 / square - along * along, 0))
    return np.stack([x + along * dx - height * dy, y + along * dy + height * dx], axis=-1).astype(float)


def near_change_point(more: float, start: float, name: str = "", m: Mechanism | None = None) -> Mechanism:
    """The four-bar with a rocker longer by ``more``, turning at 1 rad/s from ``start``; or one more on its crank."""
    crank = m.bodies["crank"] if m else None
    if m is None or crank is None:
        m = Mechanism("near a change point")
        crank = m.bar("crank", CRANK)
        m.revolute("A", m.ground.at(0, 0), crank.start)
        m.drive_angle("motor", crank, constant_rate(1.0, start))
        m.start_near(crank=math.degrees(start))
    coupler, rocker = m.bar(f"coupler{name}", COUPLER), m.bar(f"rocker{name}", ROCKER + more)
    m.revolute(f"B{name}", crank.end, coupler.start)
    m.revolute(f"C{name}", coupler.end, rocker.end)
    m.revolute(f"D{name}", m.ground.at(GROUND, 0), rocker.start)
    pin = joint_c(np.array([start]), more)[0]
    first = pin - CRANK * np.array([math.cos(start), math.sin(start)])
    second = pin - [GROUND, 0.0]
    angles = {coupler.name: math.atan2(first[1], first[0]), rocker.name: math.atan2(second[1], second[0])}
    m.start_near(**{name: math.degrees(angle) for name, angle in angles.items()})
    return m


def march(m: Mechanism, times: np.ndarray, closed: bool) -> March:
    """By closed forms, or by Newton-Raphson as a whole."""
    ready = prepare(m, float(times[0]), float(times[-1]))
    return march_along(ready if closed else dataclasses.replace(ready, groups=None), times)


def end_of(m: Mechanism, motion: March, name: str, length: float) -> np.ndarray:
    """(T, 2) places of the end of a bar whose centre of mass is in its middle or at its start."""
    b = list(m.bodies).index(name)
    x, y, angle = motion.q[:, 3 * b : 3 * b + 3].T
    arm = length - m.bodies[name].com[0]
    return np.stack([x + arm * np.cos(angle), y + arm * np.sin(angle)], axis=1)


@ROUTES
@pytest.mark.parametrize("start", [1.0, 2.0])
@pytest.mark.parametrize("more", [1e-4, 1e-7, 1e-8, 1e-9, 1e-10])
def test_a_linkage_near_its_change_point_stays_on_its_side(more: float, start: float, closed: bool) -> None:
    for steps in FEW:
        m = near_change_point(more, start)
        times = np.linspace(0.0, 2 * math.pi, steps + 1)
        motion = march(m, times, closed)
        assert motion.closed == closed
        path = end_of(m, motion, "coupler", COUPLER)
        assert np.abs(path - joint_c(start + times, more)).max() < 1e-11, steps


@ROUTES
@pytest.mark.parametrize("less", [1e-4, 1e-7, 1e-9, 1e-10])
def test_a_linkage_that_just_cannot_turn_is_refused(less: float, closed: bool) -> None:
    for steps in FEW:
        with pytest.raises((SingularPoseError, BranchError)):
            march(near_change_point(-less, 1.0), np.linspace(0.0, 2 * math.pi, steps + 1), closed)


@ROUTES
def test_a_change_point_is_passed_on_the_smooth_motion(closed: bool) -> None:
    """Lengths equal but for rounding: the pin goes over to the other side of the diagonal."""
    for steps in (1, 2, 7, 36, 359, 1440):
        m = near_change_point(0.0, 1.0)
        times = np.linspace(0.0, 2 * math.pi, steps + 1)
        motion = march(m, times, closed)
        beyond = 1.0 + times > math.pi
        exact = np.where(beyond[:, None], joint_c(1.0 + times, 0.0, -1.0), joint_c(1.0 + times, 0.0))
        assert not motion.closed
        assert np.abs(end_of(m, motion, "coupler", COUPLER) - exact).max() < 1e-7, steps


@pytest.mark.parametrize("steps", [1, 2, 4, 7, 12, 360])
def test_a_third_crank_decides_where_two_alone_would_not(steps: int) -> None:
    """Three parallel cranks, not in line: two of them with the coupler lie flat at 0 and pi, all three never do."""
    m = Mechanism("three cranks")
    feet = {"one": (0.0, 0.0), "two": (0.4, 0.0), "three": (0.15, 0.3)}
    coupler = m.body("coupler")
    for name, (x, y) in feet.items():
        crank = m.bar(name, 0.1)
        m.revolute(f"foot {name}", m.ground.at(x, y), crank.start)
        m.revolute(f"head {name}", crank.end, coupler.at(x, y))
        m.start_near(**{name: 60})
    m.start_near(coupler=(0.05, 0.087, 0))
    m.drive_angle("motor", m.bodies["one"], constant_rate(1.0, math.pi / 3))
    times = np.linspace(0.0, 4 * math.pi, steps + 1)
    for moved in (0.0, 2 * math.pi / 3):  # outputs at the flat poses, too
        sol = m.sweep(times=np.append(0.0, times + moved) if moved else times)
        for name in feet:
            np.testing.assert_allclose(sol.body(name).theta, math.pi / 3 + sol.t, atol=1e-9)


def test_two_linkages_that_pass_at_the_same_time_both_stay() -> None:
    """Both determinants would change their signs at once, and the determinant of the whole would not."""
    more = 1e-8
    for closed in (True, False):
        m = near_change_point(more, 1.0, " two", near_change_point(more, 1.0))
        times = np.linspace(0.0, 2 * math.pi, 13)
        motion = march(m, times, closed)
        for name in ("coupler", "coupler two"):
            assert np.abs(end_of(m, motion, name, COUPLER) - joint_c(1.0 + times, more)).max() < 1e-11


@ROUTES
@pytest.mark.parametrize("short", [1e-3, 1e-6, 1e-8])
def test_a_swing_to_just_before_a_toggle_comes_back_on_its_side(short: float, closed: bool) -> None:
    """The crank swings to ``short`` rad before the angle at which coupler and rocker are in line."""
    lengths = (0.20, 0.10, 0.06, 0.05)
    ground, crank, coupler, rocker = lengths
    toggle = math.acos((ground**2 + crank**2 - (coupler + rocker) ** 2) / (2 * ground * crank))
    for sign, steps in ((1, 1), (1, 5), (1, 36), (1, 360), (-1, 36), (-1, 1), (-1, 360)):
        m = Mechanism("toggle")
        bars = [m.bar(name, length) for name, length in zip(("crank", "coupler", "rocker"), lengths[1:], strict=True)]
        m.revolute("A", m.ground.at(0, 0), bars[0].start)
        m.revolute("B", bars[0].end, bars[1].start)
        m.revolute("C", bars[1].end, bars[2].end)
        m.revolute("D", m.ground.at(ground, 0), bars[2].start)
        middle, furthest = 0.2, toggle - sign * short
        m.drive_angle("motor", bars[0], harmonic((furthest - middle) / 2, 1.0, -math.pi / 2, (furthest + middle) / 2))
        m.start_near(crank=math.degrees(middle), coupler=70, rocker=120)
        times = np.linspace(0.0, 2 * math.pi, steps + 1)
        if sign < 0:
            with pytest.raises((SingularPoseError, BranchError)):
                march(m, times, closed)
            continue
        motion = march(m, times, closed)
        np.testing.assert_allclose(motion.q[-1], motion.q[0], atol=1e-9)
        assert np.abs(np.diff(motion.closely()[1][:, 5::3], axis=0)).max() < 1.1


@pytest.mark.parametrize("slots", [3, 4, 5, 8])
def test_a_geneva_turns_slot_by_slot_at_any_number_of_outputs(slots: int) -> None:
    fine = geneva(slots, start=-2.0).sweep(4 * math.pi, steps=5040).body("wheel").theta
    for steps in (1, 2, 3, 4, 6, 9, 12, 14, 18, 36, 360):
        wheel = geneva(slots, start=-2.0).sweep(4 * math.pi, steps=steps).body("wheel").theta
        np.testing.assert_allclose(wheel, fine[:: 5040 // steps], atol=1e-9)
        assert abs(wheel[-1] - wheel[0]) == pytest.approx(2 * 2 * math.pi / slots)


@pytest.mark.parametrize("seed", range(24))
def test_random_linkages_move_alike_at_any_number_of_outputs(seed: int) -> None:
    def solved(steps: int, closed: bool = True) -> np.ndarray | str:
        m = driven_linkage(seed, 1 + seed % 3)
        times = np.linspace(0.0, 2 * math.pi, steps + 1)
        try:
            return march(m, times, closed).q
        except MechanismError as error:
            return type(error).__name__

    fine = solved(720)
    newton = solved(720, closed=False)
    assert isinstance(fine, str) == isinstance(newton, str)
    if not isinstance(fine, str) and not isinstance(newton, str):
        np.testing.assert_allclose(newton, fine, atol=1e-8)
    for steps in (1, 3, 5, 12, 90):
        for closed in (True, False):
            coarse = solved(steps, closed)
            assert isinstance(coarse, str) == isinstance(fine, str)
            if not isinstance(coarse, str) and not isinstance(fine, str):
                np.testing.assert_allclose(coarse, fine[:: 720 // steps], atol=1e-8)


def test_one_time_alone() -> None:
    m = near_change_point(0.01, 1.0)
    sol = m.sweep(times=[0.3])
    assert sol.t.tolist() == [0.3]
    coupler = m.sweep(times=[0.0, 0.3]).body("coupler")
    assert sol.body("coupler").theta[0] == pytest.approx(coupler.theta[1], abs=1e-12)
    assert sol.body("coupler").omega[0] == pytest.approx(coupler.omega[1], abs=1e-12)
    assert np.isfinite(sol.joint("B").reaction).all()
    with pytest.raises(ModelError, match="rising"):
        m.sweep(times=[])


def pusher(law: object, limits: tuple[float, float] | None = None) -> Mechanism:
    """A crank turned by a law, and a rod in a guide that it moves."""
    m = Mechanism("pusher")
    crank, rod, slider = m.bar("crank", 0.05), m.bar("rod", 0.15), m.body("slider")
    m.revolute("O", m.ground.at(0, 0), crank.start, limits=limits)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, law)
    m.start_near(crank=0, rod=0)
    return m


def test_turns_and_returns_between_two_outputs_are_followed() -> None:
    times = np.linspace(0.0, 1.0, 201)
    there_and_back = 40 * np.sin(math.pi * times) ** 2
    for law, turned in (
        (constant_rate(2 * math.pi * 50), 100 * math.pi),
        (harmonic(3.0, 2 * math.pi * 20), 0.0),
        (cycloidal(6 * math.pi, 0.001, 0.4), 6 * math.pi),
        (table(times, there_and_back), 0.0),
        (function(lambda t: 200 * t**2, lambda t: 400 * t, lambda t: 400.0), 200.0),
        (function(lambda t: 200 * t**2), 200.0),
        (function(lambda t: 20 * math.exp(-(((t - 0.437) / 0.002) ** 2))), 0.0),
    ):
        sol = pusher(law).sweep(1.0, steps=1)
        assert sol.body("crank").theta[-1] == pytest.approx(turned, abs=1e-9)
        assert abs(sol.body("rod").theta).max() < 0.5
        assert sol.stats.inserted_steps > 30


@pytest.mark.parametrize("steps", [1, 2, 7, 100])
def test_a_limit_passed_between_two_outputs_is_found(steps: int) -> None:
    furthest = 0.8
    for law in (harmonic(furthest, 2 * math.pi), constant_rate(furthest)):
        pusher(law, limits=(-1.0, 1.0)).sweep(1.0, steps=steps)
    with pytest.raises(LimitError, match="upper limit"):
        pusher(harmonic(furthest, 2 * math.pi), limits=(-1.0, furthest - 1e-4)).sweep(1.0, steps=steps)
