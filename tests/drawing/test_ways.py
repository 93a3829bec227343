"""Ways that something runs on are drawn as far as it goes, and the solid side of ground's is hatched."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, Solution, constant_rate, curve
from mbsd.drawing.pose import tracks_of
from mbsd.drawing.symbols.surfaces import MOST, curve_way, surface_way

RADIUS, SPEED, END = 0.1, 2.0, 1.0


def tyre_beyond_its_road(points: int = 5) -> Solution:
    """A wheel is driven along x for 1 s, 2 m, over a road that is described on its first half metre alone."""
    m = Mechanism("beyond", gravity=(0.0, -9.81))
    wheel, cart = m.body("wheel", 1.0, inertia=0.01), m.body("cart", 1.0, inertia=0.01)
    x = np.linspace(0.0, 0.5, points)
    m.angle_lock("level", m.ground.origin, cart.origin)
    m.revolute("hub", cart.origin, wheel.origin)
    m.drive_coordinate("engine", m.ground.origin, cart.origin, constant_rate(SPEED))
    m.tyre("tyre", m.ground.origin, wheel.origin, RADIUS, 1e4, 100.0, profile=curve(x, 0.1 * x))
    m.start_near(cart=(0.0, RADIUS, 0.0), wheel=(0.0, RADIUS, 0.0))
    m.start_moving(cart=(SPEED, 0.1 * SPEED, 0.0), wheel=(SPEED, 0.1 * SPEED, 0.0))
    return m.simulate(END, steps=60)


def rolls_off(angle: float) -> Solution:
    """A disc that rolls down a curve, level at its end, and on along the straight line beyond; the world turned."""
    c, s = math.cos(angle), math.sin(angle)
    m = Mechanism("off", gravity=(9.81 * s, -9.81 * c))
    wheel = m.body("wheel", 1.0, inertia=0.005)
    x = np.linspace(-0.6, 0.0, 13)
    m.rigid_terrain("hill", m.ground.at(0, 0, angle), wheel.origin, np.stack([x, x**2], axis=1).tolist(), RADIUS, False)
    start = np.array([-0.4, 0.16]) + RADIUS * np.array([0.8, 1.0]) / math.hypot(0.8, 1.0)
    m.start_near(wheel=(c * start[0] - s * start[1], s * start[0] + c * start[1], 0))
    m.start_moving(wheel=(0, 0, 0))
    return m.simulate(1.2, steps=120)


def test_a_road_goes_on_along_its_tangent_as_far_as_the_tyre() -> None:
    sol = tyre_beyond_its_road()
    pose = tracks_of(sol).pose(0)
    path = surface_way(sol.mechanism.forces["tyre"], pose, RADIUS)
    assert path[-1] == pytest.approx([SPEED * END + RADIUS, 0.1 * (SPEED * END + RADIUS)], rel=1e-6)
    assert path[0] == pytest.approx([-RADIUS, -0.1 * RADIUS], rel=1e-6)
    assert np.diff(path[:, 1]) == pytest.approx(0.1 * np.diff(path[:, 0]))


@pytest.mark.parametrize("angle", [0.0, 0.7, math.pi, -2.0])
def test_a_terrain_goes_on_straight_where_the_wheel_rolls_on(angle: float) -> None:
    sol = rolls_off(angle)
    pose, contact = tracks_of(sol).pose(0), sol.mechanism.contacts["hill"]
    path = curve_way(contact, pose, "contact hill")
    c, s = math.cos(angle), math.sin(angle)
    own = path @ np.array([[c, -s], [s, c]])
    wheel = sol.body("wheel")
    farthest = float((c * wheel.x + s * wheel.y).max())
    assert farthest > 0.5  # it has left the described part
    assert own[-1, 0] > farthest + RADIUS
    assert own[-1, 1] == pytest.approx(0.0, abs=1e-3)
    assert own[0] == pytest.approx([-0.6, 0.36])  # it never came to the other end, which stays


def test_one_pose_alone_draws_what_is_described() -> None:
    from mbsd.drawing.pose import start_pose

    m = rolls_off(0.0).mechanism
    path = curve_way(m.contacts["hill"], start_pose(m), "contact hill")
    assert path[[0, -1]] == pytest.approx(np.array([[-0.6, 0.36], [0.0, 0.0]]))


def test_the_road_of_a_tyre_is_hatched_below() -> None:
    from matplotlib.figure import Figure

    sol = tyre_beyond_its_road()
    ax = Figure().subplots()
    sol.draw(ax=ax, names=False)
    drawn = [np.asarray(line.get_xydata(), float) for line in ax.lines if line.get_linewidth() == 0.9]
    strokes = [stroke for stroke in drawn if len(stroke) == 2]
    assert 20 < len(strokes) <= MOST
    roots, ends = np.array([s[0] for s in strokes]), np.array([s[1] for s in strokes])
    assert roots[:, 1] == pytest.approx(0.1 * roots[:, 0], abs=1e-9)
    assert (ends[:, 1] < 0.1 * ends[:, 0]).all()
    assert roots[:, 0].max() > SPEED * END


def test_a_long_road_has_few_strokes() -> None:
    from matplotlib.figure import Figure

    m = Mechanism("long", gravity=(0.0, -9.81))
    wheel = m.body("wheel", 1.0, inertia=0.01)
    m.tyre("tyre", m.ground.origin, wheel.origin, RADIUS, 1e4, profile=curve([-1e4, 1e4], [0.0, 0.0]))
    m.start_near(wheel=(0, RADIUS, 0))
    ax = Figure().subplots()
    m.draw(ax=ax, names=False)
    assert 0 < len(ax.lines) < MOST + 20
    low, high = ax.get_xlim()
    assert high - low < 10 * RADIUS  # the drawing shows the wheel, not 20 km of road
