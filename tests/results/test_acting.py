"""Where joints, contacts and drivers act, and with which torque there."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mbsd.model.joint import KINDS
from mbsd.results.acting import acting, actions


def rolling(angle: float, radius: float) -> Mechanism:
    """A disc on a line that is turned by ``angle`` (rad), pulled down by its weight and along by a driver."""
    m = Mechanism("wheel", gravity=(0.0, -9.81))
    line = m.ground.at(0.0, 0.0, angle)
    disc = m.body("disc", mass=2.0, inertia=0.01)
    m.rolling_disc("road", line, disc.at(0.0, 0.0), radius=radius)
    m.drive_coordinate("pull", line, disc.at(0.0, 0.0), constant_rate(0.3))
    return m


@given(st.floats(-1.0, 1.0), st.floats(0.05, 0.4))
def test_a_wheel_is_pushed_where_it_touches_its_road_however_that_lies(angle: float, radius: float) -> None:
    sol = rolling(angle, radius).sweep(1.0, 4)
    road, disc = sol.joint("road"), sol.body("disc")
    normal = np.array([-np.sin(angle), np.cos(angle)])
    centre = np.stack([disc.x, disc.y], axis=1)
    assert road.place == pytest.approx(centre - radius * normal, abs=1e-9)
    assert road.acts.torque == pytest.approx(0.0, abs=1e-9)
    assert np.array_equal(road.acts.fx, road.fx)
    arm = centre - road.place
    about_marker = -(arm[:, 0] * road.fy - arm[:, 1] * road.fx)  # of the force moved to the marker
    assert road.torque == pytest.approx(about_marker, abs=1e-9)


def test_a_pin_acts_at_its_marker_and_a_guide_keeps_its_torque() -> None:
    m = Mechanism("slider", gravity=(0.0, -9.81))
    block = m.body("block", mass=1.0, com=(0.2, 0.0), inertia=0.01)
    m.prismatic("guide", m.ground.at(0.0, 0.0), block.at(0.0, 0.0))
    m.drive_coordinate("push", m.ground.at(0.0, 0.0), block.at(0.0, 0.0), constant_rate(0.1))
    guide = m.sweep(1.0, 3).joint("guide")
    assert guide.acts.torque == pytest.approx(guide.torque)
    assert guide.torque == pytest.approx(0.2 * 9.81)
    assert guide.place == pytest.approx(np.stack([guide.x, guide.y], axis=1))


def two_bars(kind: str) -> Mechanism:
    """A crank on ground, and a bar on the crank that a driver moves against it."""
    m = Mechanism("two_bars", gravity=(0.0, -9.81))
    a, b = m.bar("a", 0.3, mass=1.0), m.bar("b", 0.4, mass=0.5)
    m.revolute("O", m.ground.at(0.0, 0.0), a.start)
    m.revolute("A", a.end, b.start)
    m.drive_angle("turn", a, constant_rate(0.5, start=0.2))
    if kind == "distance":
        m.drive_distance("ram", m.ground.at(0.1, -0.3), b.end, constant_rate(0.02, start=0.7))
    else:
        m.drive_relative_angle("ram", a, b, constant_rate(1.0, start=0.4))
    return m


def test_a_driver_of_an_angle_turns_its_bodies_against_each_other_about_their_pin() -> None:
    sol = two_bars("angle").sweep(1.0, 6)
    number = next(k for k, joint in enumerate(sol.packed.joints) if joint.name == "ram")
    first, second = actions(sol.packed, sol.q, sol.wrench, number)
    assert (first.body, second.body) == ("a", "b")
    assert second.torque == pytest.approx(sol.driver("ram").effort)
    assert first.torque == pytest.approx(-second.torque)
    assert np.stack([second.x, second.y], axis=1) == pytest.approx(sol.joint("A").place)


def test_a_driver_of_a_distance_pushes_along_its_line_at_both_ends() -> None:
    sol = two_bars("distance").sweep(0.5, 6)
    number = next(k for k, joint in enumerate(sol.packed.joints) if joint.name == "ram")
    first, second = actions(sol.packed, sol.q, sol.wrench, number)
    way = np.stack([second.x - first.x, second.y - first.y], axis=1)
    unit = way / np.hypot(*way.T)[:, None]
    assert second.force == pytest.approx(sol.driver("ram").effort[:, None] * unit)
    assert first.force == pytest.approx(-second.force)
    assert np.stack([first.x, first.y], axis=1) == pytest.approx(np.tile([0.1, -0.3], (7, 1)))


@pytest.mark.parametrize("name", [name for name, kind in KINDS.items() if kind.touching == "place"])
def test_where_only_a_force_is_exchanged_no_torque_is_left(name: str) -> None:
    """The force and torque about the marker are those of the force at the place, of every kind that touches."""
    rng = np.random.default_rng(1)
    m = Mechanism("example")
    a, b = m.bar("a", 1.0, mass=1.0), m.bar("b", 1.0, mass=1.0)
    KINDS[name].example(m, a.at(0.0, 0.0), b.at(0.1, 0.2))
    from mbsd.arrays.packing import pack

    packed = pack(m)
    q, wrench = rng.normal(size=(5, 3, 3)), rng.normal(size=(5, len(packed.joints), 3))
    number = [joint.name for joint in packed.joints].index("example")
    on = acting(packed, q, wrench, number)
    marker = q[:, 2, :2] + _turned(q[:, 2, 2], np.array([0.1, 0.2]) - packed.com[2])
    arm = np.stack([on.x, on.y], axis=1) - marker
    assert on.torque == pytest.approx(0.0, abs=1e-12)
    assert arm[:, 0] * on.fy - arm[:, 1] * on.fx == pytest.approx(wrench[:, number, 2])


def _turned(angle: np.ndarray, arm: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]], axis=1)
