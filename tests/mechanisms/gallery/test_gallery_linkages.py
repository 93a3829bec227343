"""Linkages of the gallery against their closed forms and published numbers, at the sizes their folders have."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.results.solution import Solution
from mechanisms.four_bar_bicycle import mechanism as bicycle
from mechanisms.jansen_leg import mechanism as jansen
from mechanisms.quick_return import mechanism as shaper
from mechanisms.slider_crank import mechanism as slider_crank
from mechanisms.windshield_wiper import mechanism as wiper


@pytest.mark.parametrize("offset", [0.0, slider_crank.VARIANTS["offset"]["offset"]])
def test_slider_crank(offset: float) -> None:
    p = slider_crank.Params(offset=offset)
    sol = slider_crank.build(p).sweep()
    turn = p.speed * sol.t
    lean = np.arcsin((offset - p.crank * np.sin(turn)) / p.rod)
    rate = -p.crank * p.speed * np.cos(turn) / (p.rod * np.cos(lean))
    slider = sol.body("slider")
    np.testing.assert_allclose(slider.x, p.crank * np.cos(turn) + p.rod * np.cos(lean), atol=1e-14)
    vx = -p.crank * p.speed * np.sin(turn) - p.rod * rate * np.sin(lean)
    np.testing.assert_allclose(slider.vx, vx, atol=1e-13)


def test_gravity_costs_the_motor_the_weight_of_crank_and_rod() -> None:
    """Slow enough that masses hardly count: the torque is the weight on its lever arms (virtual work)."""
    p = slider_crank.Params(speed=1e-3)
    m = slider_crank.build(p)
    m.set_mass("crank", 0.2, (p.crank / 2, 0), 1e-5)
    m.set_mass("rod", 0.3, (p.rod / 2, 0), 1e-4)
    sol = m.sweep()
    crank, rod = sol.body("crank").theta, sol.body("rod").theta
    # dy of the rod's middle is half of that of pin A, because pin B keeps its height
    lever = p.crank * np.cos(crank) / 2
    np.testing.assert_allclose(sol.driver("motor").torque, p.gravity * (0.2 + 0.3) * lever, atol=1e-8)
    assert np.abs(rod).max() == pytest.approx(math.asin(p.crank / p.rod), rel=1e-4)


def _corner(first: np.ndarray, r: float, second: np.ndarray, s: float, left: bool) -> np.ndarray:
    """The point r from ``first`` (T, 2) and s from ``second``, left or right of the way from first to second."""
    way = second - first
    apart = np.linalg.norm(way, axis=-1, keepdims=True)
    along = (r**2 - s**2 + apart**2) / (2 * apart)
    across = np.sqrt(r**2 - along**2) * (1 if left else -1)
    unit = way / apart
    return first + along * unit + across * np.stack([-unit[..., 1], unit[..., 0]], axis=-1)


def _place(sol: Solution, name: str) -> np.ndarray:
    point = sol.point(name)
    return np.stack([point.x, point.y], axis=1)


def test_bicycle_knee_stays_between_the_dead_points_of_its_crank() -> None:
    p = bicycle.Params()
    sol = bicycle.build(p).sweep(steps=3600)
    assert sol.t[-1] == pytest.approx(1.0, rel=1e-14)  # 60 turns a minute
    to_bracket = math.radians(-p.slope)  # from hip to bracket
    angle = sol.body("thigh").theta - to_bracket

    def dead(line: float) -> float:
        return math.acos((p.hip**2 + p.thigh**2 - line**2) / (2 * p.hip * p.thigh))

    assert np.degrees(angle.max()) == pytest.approx(math.degrees(dead(p.shank + p.crank)), abs=1e-4)
    assert np.degrees(angle.min()) == pytest.approx(math.degrees(dead(p.shank - p.crank)), abs=1e-4)


def test_quick_return() -> None:
    p = shaper.Params()
    sol = shaper.build(p).sweep(steps=3600)
    crank = sol.body("crank").theta
    x, y = p.crank * np.cos(crank), p.height + p.crank * np.sin(crank)
    arm = np.arctan2(y, x)
    np.testing.assert_allclose(sol.body("arm").theta, arm, atol=1e-13)
    rise = p.ram - p.arm * np.sin(arm)
    np.testing.assert_allclose(sol.body("ram").x, p.arm * np.cos(arm) + np.sqrt(p.link**2 - rise**2), atol=1e-13)
    swing = math.asin(p.crank / p.height)
    cutting = np.mean(sol.body("arm").omega[:-1] > 0)
    assert cutting / (1 - cutting) == pytest.approx((math.pi + 2 * swing) / (math.pi - 2 * swing), rel=2e-3)


def test_jansen_leg_by_circles() -> None:
    """Each joint from two others, as one draws it by compass; a foot that is nearly flat for half of the turn."""
    p = jansen.Params()
    sol = jansen.build(p).sweep()
    crank = sol.body("crank").theta
    pivot = np.zeros((len(crank), 2))
    pin = np.stack([p.a + p.m * np.cos(crank), p.l + p.m * np.sin(crank)], axis=1)
    top = _corner(pivot, p.b, pin, p.j, left=True)
    back = _corner(pivot, p.d, top, p.e, left=True)
    knee = _corner(pivot, p.c, pin, p.k, left=False)
    heel = _corner(back, p.f, knee, p.g, left=False)
    foot = _corner(heel, p.h, knee, p.i, left=False)
    np.testing.assert_allclose(_place(sol, "foot"), foot, atol=1e-14)
    low = np.sort(foot[:-1, 1])
    height, stride = np.ptp(foot[:, 1]), np.ptp(foot[:, 0])
    assert low[len(low) // 2] - low[0] < 0.1 * height
    assert height < 0.5 * stride


def test_wipers_stay_parallel_and_swing_as_the_dead_points_of_the_motor_say() -> None:
    p = wiper.Params()
    sol = wiper.build(p).sweep(steps=3600)
    first, second = sol.body("first").theta, sol.body("second").theta
    np.testing.assert_allclose(first, second, atol=1e-12)
    apart = math.hypot(*p.motor)

    def dead(line: float) -> float:
        return math.acos((apart**2 + p.lever**2 - line**2) / (2 * apart * p.lever))

    assert np.ptp(first) == pytest.approx(dead(p.rod + p.crank) - dead(p.rod - p.crank), rel=1e-5)
    assert 80 < math.degrees(np.ptp(first)) < 110
