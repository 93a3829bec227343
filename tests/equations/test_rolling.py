"""Racks, discs on lines and terrain, points on curves, against closed forms and conservation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import cumulative_trapezoid, quad

from mbsd import Mechanism, ModelError, constant_rate


@settings(max_examples=10)
@given(radius=st.floats(0.02, 0.5), turned=st.floats(-3, 3), phase=st.floats(-1, 1))
def test_rack_and_pinion(radius: float, turned: float, phase: float) -> None:
    m = Mechanism("steering", gravity=None)
    pinion, rack = m.body("pinion"), m.body("rack", 3.0)
    m.revolute("axle", m.ground.at(0, 0), pinion.origin)
    c, s = math.cos(turned), math.sin(turned)
    m.prismatic("guide", m.ground.at(radius * s, -radius * c, turned), rack.origin)
    m.rack_and_pinion("teeth", rack.origin, pinion.at(0, 0, 0.4), radius)
    m.drive_angle("wheel", pinion, lambda t: phase + 3.0 * t * t)
    m.start_near(rack=(0, 0, math.degrees(turned)))
    sol = m.sweep(duration=2.0, steps=40)
    travel = (sol.body("rack").x - sol.body("rack").x[0]) * c + (sol.body("rack").y - sol.body("rack").y[0]) * s
    np.testing.assert_allclose(travel, radius * 3.0 * sol.t**2, atol=1e-10)
    np.testing.assert_allclose(sol.driver("wheel").torque, 3.0 * radius**2 * 6.0, rtol=1e-7)


def test_a_disc_rolls_down_a_slope() -> None:
    """A full disc on a slope: a = 2/3 g sin(slope), friction m g sin / 3."""
    slope, radius, mass = 0.3, 0.2, 2.0
    m = Mechanism("slope", gravity=(0.0, -9.81))
    disc = m.body("disc", mass, (0, 0), mass * radius**2 / 2)
    m.rolling_disc("road", m.ground.at(0.3, 0.1, -slope), disc.origin, radius)
    m.start_near(disc=(0.3, 0.3, 0))
    sol = m.simulate(duration=1.5, steps=30, tolerance=1e-10)
    view, road = sol.body("disc"), sol.joint("road")
    moved = np.hypot(view.x - view.x[0], view.y - view.y[0])
    np.testing.assert_allclose(moved, 9.81 * math.sin(slope) / 3 * sol.t**2, atol=1e-9)
    np.testing.assert_allclose(view.theta, -moved / radius, atol=1e-9)
    friction = -road.fx * math.cos(slope) + road.fy * math.sin(slope)
    np.testing.assert_allclose(friction, mass * 9.81 * math.sin(slope) / 3, rtol=1e-8)
    np.testing.assert_allclose(road.torque, -friction * radius, rtol=1e-8)


def _bowl(count: int, size: float = 2.0) -> list[tuple[float, float]]:
    """A circular bowl of radius ``size`` from left to right."""
    angles = np.linspace(math.pi + 0.2, 2 * math.pi - 0.2, count)
    return [(size * math.cos(a), size * math.sin(a)) for a in angles]


def test_a_disc_in_a_round_bowl_swings_like_a_pendulum() -> None:
    """Rolling with k = I / (m r^2): (1 + k) (R - r)^2 phi'^2 / 2 = g (R - r) (cos phi - cos phi_0)."""
    bowl, radius = 2.0, 0.3
    m = Mechanism("bowl", gravity=(0.0, -9.81))
    disc = m.body("disc", 1.5, (0, 0), 1.5 * radius**2 / 2)
    m.rolling_on_curve("road", m.ground.origin, disc.origin, _bowl(81), radius)
    reach, swing = bowl - radius, 1.1
    m.start_near(disc=(reach * math.sin(swing), -reach * math.cos(swing), 0))
    sol = m.simulate(duration=3.0, steps=120, tolerance=1e-10)
    view = sol.body("disc")
    np.testing.assert_allclose(np.hypot(view.x, view.y), reach, atol=1e-7)
    phi = np.arctan2(view.x, -view.y)
    rate = (view.x * view.vy - view.y * view.vx) / reach**2
    fallen = 9.81 * (np.cos(phi) - np.cos(phi[0]))
    np.testing.assert_allclose(1.5 * reach * rate**2 / 2, fallen, atol=1e-5)
    np.testing.assert_allclose(radius * (view.theta - view.theta[0]), -reach * (phi - phi[0]), atol=1e-7)
    assert np.ptp(sol.energy.total) < 1e-7


def test_rolling_over_waves_goes_the_length_of_the_centres_path() -> None:
    x = np.linspace(-1.0, 7.0, 161)
    points = np.stack([x, 0.2 * np.sin(x)], axis=1)
    radius = 0.4
    m = Mechanism("waves", gravity=None)
    disc = m.body("disc", 1.0, (0, 0), 0.1)
    m.rolling_on_curve("road", m.ground.origin, disc.origin, points.tolist(), radius)
    m.drive_angle("motor", disc, constant_rate(-1.0))
    m.start_near(disc=(0.0, 0.4, 0))
    sol = m.sweep(duration=12.0, steps=600)
    view = sol.body("disc")

    def ground(u: float) -> float:
        return math.hypot(1.0, 0.2 * math.cos(u))

    # foot of the centre: centre = c(u) + r n(u)
    foot = view.x.copy()
    for _ in range(50):
        foot = view.x + radius * 0.2 * np.cos(foot) / np.hypot(1.0, 0.2 * np.cos(foot))
    inside = foot < 6.5
    arc = np.array([quad(ground, foot[0], u)[0] for u in foot])
    beta = np.arctan(0.2 * np.cos(foot))
    rolled = arc - radius * (beta - beta[0])
    np.testing.assert_allclose(-radius * (view.theta - view.theta[0])[inside], rolled[inside], atol=1e-6)
    path = cumulative_trapezoid(np.hypot(view.vx, view.vy), sol.t, initial=0)
    np.testing.assert_allclose(path, radius * sol.t, rtol=1e-9)  # the contact stands still, so v = r omega
    assert view.x[-1] > 3.0


def test_a_disc_rolls_around_a_closed_curve_twice() -> None:
    """Around a circle of radius R outside: the disc turns (R + r) / r times a round."""
    big, radius = 0.5, 0.2
    angles = np.linspace(0, 2 * math.pi, 60, endpoint=False)
    points = np.stack([big * np.cos(-angles), big * np.sin(-angles)], axis=1)  # clockwise: the outside is on the left
    m = Mechanism("coin", gravity=None)
    arm, disc = m.body("arm"), m.body("disc", 1.0, (0, 0), 0.1)
    m.revolute("O", m.ground.origin, arm.origin)
    m.pin_in_slot("P", arm.origin, disc.origin)
    m.rolling_on_curve("coin", m.ground.origin, disc.origin, points.tolist(), radius, closed=True)
    m.drive_angle("motor", arm, constant_rate(1.0, 0.3))
    m.start_near(disc=(0.7 * math.cos(0.3), 0.7 * math.sin(0.3), 0))
    sol = m.sweep(duration=4 * math.pi, steps=400)
    turned = sol.body("disc").theta - sol.body("disc").theta[0]
    np.testing.assert_allclose(turned, (big + radius) / radius * sol.t, atol=2e-6)


def test_a_bead_on_a_cycloid_swings_in_the_same_time_from_any_height() -> None:
    """Huygens' tautochrone: the time to the bottom is pi sqrt(R / g); points alone tell the curve."""
    big, gravity = 0.25, 9.81
    turn = np.linspace(0.25, 2 * math.pi - 0.25, 161)
    points = np.stack([big * (turn - np.sin(turn)), big * (np.cos(turn) - 1)], axis=1)
    for start in (0.9, 2.0):
        m = Mechanism("tautochrone", gravity=(0.0, -gravity))
        bead = m.body("bead", 1.0, (0, 0), 1.0)
        m.point_on_curve("wire", m.ground.origin, bead.origin, points.tolist())
        m.angle_lock("upright", m.ground.origin, bead.origin)
        m.start_near(bead=(big * (start - math.sin(start)), big * (math.cos(start) - 1), 0))
        bottom = math.pi * math.sqrt(big / gravity)
        sol = m.simulate(times=[0.0, bottom / 2, bottom, 2 * bottom], tolerance=1e-11)
        assert sol.body("bead").x[2] == pytest.approx(math.pi * big, abs=1e-6)
        assert sol.body("bead").x[3] == pytest.approx(2 * math.pi * big - sol.body("bead").x[0], abs=1e-6)
        assert np.abs(sol.joint("upright").torque).max() < 1e-9


def test_curves_and_discs_that_cannot_be_are_refused() -> None:
    m = Mechanism("road")
    disc = m.body("disc")
    with pytest.raises(ModelError, match=r"bent to a radius of [\d.]+ m, where a disc of 2.5 m touches twice"):
        m.rolling_on_curve("road", m.ground.origin, disc.origin, _bowl(81), 2.5)
    with pytest.raises(ModelError, match="must be two or more rows"):
        m.point_on_curve("wire", m.ground.origin, disc.origin, [(0.0, 1.0)])
    with pytest.raises(ModelError, match=r"points\[1\]\[0\] is nan"):
        m.point_on_curve("wire", m.ground.origin, disc.origin, [(0.0, 1.0), (math.nan, 2.0), (2.0, 3.0)])
    with pytest.raises(ModelError, match="points 1 and the next are the same"):
        m.point_on_curve("wire", m.ground.origin, disc.origin, [(0.0, 1.0), (1.0, 2.0), (1.0, 2.0)])


@pytest.mark.parametrize("end", [0, -1])
def test_the_foot_on_the_straight_line_beyond_an_end_is_exact(end: int) -> None:
    """Also where the point lies at the centre of curvature of the end: there the curve, not the line, has no foot."""
    from mbsd.equations.relative.curve_pieces import foot
    from mbsd.model.plane_curves import curve_numbers, curve_pieces

    points = np.array([[-6, -1], [-4, -0.5], [-2, 0], [0, -0.3], [2, -0.5], [4, 0.2], [6, 0.1]], float)
    breaks, coefficients = curve_pieces(points, False)
    numbers = np.concatenate([np.zeros(4), curve_numbers(breaks, coefficients, False, 0.2, 0.2)])
    h = breaks[end] - breaks[-2] if end else 0.0
    row = coefficients[end]
    place = (row * h ** np.arange(6)).sum(axis=1)
    slope = (row[:, 1:] * np.arange(1, 6) * h ** np.arange(5)).sum(axis=1)
    bend = (row[:, 2:] * np.arange(2, 6) * np.arange(1, 5) * h ** np.arange(4)).sum(axis=1)
    speed = float(slope @ slope)
    normal = np.array([-slope[1], slope[0]]) / math.sqrt(speed)
    scratch = np.zeros(20)
    outwards = 1.0 if end else -1.0
    for way in (0.1, 1.0, 3.0):
        u = breaks[end] + outwards * way
        on_line = place + slope * outwards * way
        centre = (speed - bend @ (on_line - place)) / (bend @ normal)
        for off in (0.2, -0.2, *(centre * (1 + part) for part in (1e-4, -1e-4, 1e-2, -1e-2))):
            if abs(off) < 2.0:
                x, y = on_line + off * normal
                assert abs(foot(numbers, x, y, scratch) - u) < 1e-12, (way, off)
