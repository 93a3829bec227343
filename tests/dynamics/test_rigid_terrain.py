"""Rigid contact with terrain: a hill that is left, a slope that is bounced off, a disc that rolls while it sticks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError

G = 9.81
HILLS = [(x, 0.3 * math.sin(x) - 0.05 * x) for x in np.linspace(-4.0, 6.0, 60)]


def hill(radius: float, count: int = 80) -> list[tuple[float, float]]:
    """The upper half of a circle, from left to right."""
    angles = np.linspace(math.radians(170), math.radians(10), count)
    return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]


@pytest.mark.parametrize("radius", [0.0, 0.2])
def test_a_bead_leaves_a_round_hill_where_its_weight_no_longer_bends_it(radius: float) -> None:
    """N = m (g cos a - v^2 / R) = 0 with v^2 = v0^2 + 2 g R (1 - cos a):  cos a = 2/3 + v0^2 / (3 g R)."""
    path, speed = 2.0, 0.5
    m = Mechanism("hill", gravity=(0, -G))
    bead = m.body("bead", 0.4, inertia=1e-3)
    m.rigid_terrain("ground", m.ground.origin, bead.origin, hill(path - radius), radius=radius)
    m.start_near(bead=(0.0, path, 0.0))
    m.start_moving(bead=(speed, 0.0, 0.0))
    sol = m.simulate(2.0, steps=200, tolerance=1e-11)
    leaving = next(event for event in sol.events if event.what == "opens")
    at = sol.at(leaving.time).body("bead")
    cosine = 2 / 3 + speed**2 / (3 * G * path)
    assert at.y[0] / path == pytest.approx(cosine, abs=1e-6)
    assert np.hypot(at.vx[0], at.vy[0]) ** 2 == pytest.approx(speed**2 + 2 * G * path * (1 - cosine), rel=1e-6)
    held = sol.t < leaving.time
    view = sol.body("bead")
    normal = 0.4 * (G * view.y - view.vx**2 - view.vy**2) / path
    np.testing.assert_allclose(sol.contact("ground").normal[held], normal[held], atol=1e-4)
    assert sol.audit is not None
    assert np.ptp(sol.audit[sol.t <= leaving.time]) < 1e-9


def test_a_ball_bounces_off_the_slope_where_it_falls() -> None:
    m = Mechanism("slope", gravity=(0, -G))
    ball = m.body("ball", 0.4, inertia=1e-3)
    m.rigid_terrain("ground", m.ground.origin, ball.origin, HILLS, radius=0.1, restitution=0.7)
    m.start_near(ball=(1.0, 2.0, 0.0))
    sol = m.simulate(0.8, steps=80, event_rows=True, tolerance=1e-11)
    hit = sol.events[0]
    assert hit.what == "impact"
    before, after = np.flatnonzero(sol.t == hit.time)[[0, -1]]
    ball_, gap = sol.body("ball"), sol.contact("ground").gap
    assert abs(gap[before]) < 1e-12
    assert gap.min() > -1e-10
    x = np.linspace(0.0, 2.0, 20001)
    nearest = np.hypot(x - ball_.x[before], 0.3 * np.sin(x) - 0.05 * x - ball_.y[before]).min()
    assert nearest == pytest.approx(0.1, abs=1e-5)
    change = np.array([ball_.vx[after] - ball_.vx[before], ball_.vy[after] - ball_.vy[before]])
    normal = change / np.hypot(*change)
    falling = np.array([ball_.vx[before], ball_.vy[before]]) @ normal
    assert np.array([ball_.vx[after], ball_.vy[after]]) @ normal == pytest.approx(-0.7 * falling, rel=1e-12)
    assert 0.4 * np.hypot(*change) == pytest.approx(hit.impulse, rel=1e-12)
    slope = 0.3 * math.cos(ball_.x[before] + 0.1 * -normal[0]) - 0.05
    np.testing.assert_allclose(normal, np.array([-slope, 1.0]) / math.hypot(slope, 1.0), atol=1e-4)


def test_a_disc_that_sticks_rolls_as_the_joint_does() -> None:
    def disc(m: Mechanism):
        body = m.body("disc", 1.5, inertia=0.5 * 1.5 * 0.2**2)
        m.start_near(disc=(-math.pi / 2 + 0.4, 0.2, 0.0))
        return body

    rigid, joint = Mechanism("contact", gravity=(0, -G)), Mechanism("joint", gravity=(0, -G))
    first, second = disc(rigid), disc(joint)
    joint.rolling_on_curve("ground", joint.ground.origin, second.origin, HILLS, radius=0.2)
    joint.start_near(disc=(-math.pi / 2 + 0.4, 0.0, 0.0))
    rolls = joint.simulate(2.0, steps=100, tolerance=1e-11)
    start = rolls.body("disc")
    rigid.rigid_terrain("ground", rigid.ground.origin, first.origin, HILLS, radius=0.2, friction=0.9)
    rigid.start_near(disc=(float(start.x[0]), float(start.y[0]), math.degrees(start.theta[0])))
    sol = rigid.simulate(2.0, steps=100, tolerance=1e-11)
    assert [event.what for event in sol.events] == ["closes"]
    for what in ("x", "y", "theta"):
        np.testing.assert_allclose(getattr(sol.body("disc"), what), getattr(start, what), atol=1e-8)
    assert np.ptp(sol.energy.total) < 1e-8
    reaction = rolls.joint("ground")
    size = np.hypot(sol.contact("ground").normal, sol.contact("ground").friction)
    np.testing.assert_allclose(size, reaction.magnitude, atol=1e-6)


def test_a_box_settles_on_rough_terrain_and_stays() -> None:
    m = Mechanism("box", gravity=(0, -G))
    box = m.body("box", 2.0, inertia=0.05)
    for name, x in (("left", -0.2), ("right", 0.2)):
        m.rigid_terrain(name, m.ground.origin, box.at(x, -0.1), HILLS, restitution=0.2, friction=0.7)
    m.start_near(box=(-1.5, 0.4, 10.0))
    sol = m.simulate(3.0, steps=150, tolerance=1e-8)
    for name in ("left", "right"):
        assert sol.contact(name).gap.min() > -1e-8
        assert (np.abs(sol.contact(name).friction) <= 0.7 * sol.contact(name).normal * (1 + 1e-9) + 1e-9).all()
    view = sol.body("box")
    assert max(abs(view.vx[-1]), abs(view.vy[-1]), abs(view.omega[-1])) < 1e-9
    assert sum(sol.contact(name).normal[-1] for name in ("left", "right")) > 0.0


def test_what_cannot_be_is_refused() -> None:
    m = Mechanism("refused")
    ball = m.body("ball", 1.0, inertia=0.1)
    valley = [(x, 4.0 * x * x) for x in np.linspace(-1, 1, 21)]
    with pytest.raises(ModelError, match=r"contact 'ground': the curve is bent to a radius of 0\.12.* touches twice"):
        m.rigid_terrain("ground", m.ground.origin, ball.origin, valley, radius=0.2)
    with pytest.raises(ModelError, match="must be two or more rows"):
        m.rigid_terrain("ground", m.ground.origin, ball.origin, [(0, 0)])
    with pytest.raises(ModelError, match="restitution is 2"):
        m.rigid_terrain("ground", m.ground.origin, ball.origin, valley, restitution=2.0)
    assert not m.contacts


@pytest.mark.parametrize(("height", "solid"), [(1.5, "within"), (0.0, "outside")])
def test_a_closed_terrain_that_is_solid_on_the_wrong_side_says_what_cures_it(height: float, solid: str) -> None:
    """A ball beside a round hill, or within a ring: the remedy that the refusal names is tried."""
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False) * (1.0 if solid == "within" else -1.0)
    points = np.column_stack([np.cos(turn), np.sin(turn)]).tolist()

    def hill(points: list[list[float]]) -> Mechanism:
        m = Mechanism("hill")
        ball = m.body("ball", 1.0, inertia=0.01)
        m.rigid_terrain("hill", m.ground.origin, ball.origin, points, 0.1, closed=True)
        m.start_near(ball=(0.0, height, 0.0))
        return m

    with pytest.raises(SimulationError, match="give the points of its closed curve in reverse order"):
        hill(points).simulate(0.01, 2)
    assert hill(points[::-1]).simulate(0.01, 2).contact("hill").gap[0] > 0.3
