"""MJCF and URDF: a tree with as many freedoms as the mechanism, less what closes loops; MuJoCo moves it the same."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any
from xml.etree.ElementTree import Element, fromstring

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.export.mjcf import mjcf
from mechanisms.stages.export.tree import poses_of, tree_of
from mechanisms.stages.export.urdf import urdf
from tools.models import linkages


def double_pendulum() -> Any:
    m = Mechanism("double")
    upper, lower = m.bar("upper", 0.3, mass=0.4), m.bar("lower", 0.2, mass=0.2)
    m.revolute("A", m.ground.at(0.1, 0.2), upper.start)
    m.revolute("B", upper.end, lower.start)
    m.spring("spring", m.ground.at(0.4, 0.2), lower.end, 20.0, damping=0.1, free_length=0.2)
    m.start_near(upper=20, lower=60)
    m.start_moving(upper=1.0, lower=-2.0)
    return m.simulate(0.5, steps=200)


def free_slider_crank() -> Any:
    m = Mechanism("crank")
    crank, rod, slider = m.bar("crank", 0.05, mass=0.3), m.bar("rod", 0.15, mass=0.2), m.body("slider", mass=0.5)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0, 0.3), slider.at(0, 0, 0.3))
    m.start_near(crank=70, rod=-10)
    m.start_moving(crank=3.0)
    return m.simulate(0.4, steps=200)


def quick_return() -> Any:
    """The slot turns: it is on the body that hangs on the pin."""
    m = Mechanism("quick")
    crank, arm = m.bar("crank", 0.04, mass=0.1), m.bar("arm", 0.2, mass=0.2)
    m.revolute("pivot", m.ground.at(0, 0), arm.start)
    m.revolute("shaft", m.ground.at(0, 0.1), crank.start)
    m.pin_in_slot("slot", arm.start, crank.end)
    m.drive_angle("motor", crank, constant_rate(3.0))
    m.start_near(crank=0, arm=70)
    return m.sweep(0.5, steps=100)


def geared() -> Any:
    m = Mechanism("geared")
    first, second = m.body("first", mass=0.2, inertia=1e-4), m.body("second", mass=0.3, inertia=3e-4)
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(0.15, 0), second.origin)
    m.gear_pair("mesh", first.origin, second.origin, 0.05, 0.10)
    m.drive_angle("motor", first, constant_rate(2.0))
    return m.sweep(0.5, steps=100)


def four_bar() -> Any:
    return linkages.four_bar(0.12, 0.04, 0.12, 0.09).sweep(0.5, steps=200)


def thrown() -> Any:
    m = Mechanism("thrown")
    m.body("disc", mass=0.2, com=(0.01, 0.02), inertia=1e-3)
    m.start_near(disc=(0.1, 0.2, 30))
    m.start_moving(disc=(1.0, 2.0, 5.0))
    return m.simulate(0.3, steps=100)


SOLVED: dict[str, tuple[Callable[[], Any], float]] = {
    "double_pendulum": (double_pendulum, 2e-4),
    "free_slider_crank": (free_slider_crank, 2e-3),
    "quick_return": (quick_return, 5e-3),
    "geared": (geared, 5e-3),
    "four_bar": (four_bar, 5e-3),
    "thrown": (thrown, 2e-5),
}
"""And how far MuJoCo may be off, of the size of the motion: its loops are soft, its servos as well."""


@pytest.mark.parametrize("name", SOLVED)
def test_freedoms_of_the_tree_less_its_loops_are_those_of_the_mechanism(name: str) -> None:
    sol = SOLVED[name][0]()
    text, left_out = mjcf(sol)
    root = fromstring(text)
    loops = root.find("equality")
    held = sum({"connect": 2, "joint": 1}[loop.tag] for loop in loops) if loops is not None else 0
    freedoms = len(list(root.iter("joint"))) - sum(
        1 for loop in (loops if loops is not None else []) if loop.tag == "joint"
    )
    assert freedoms - held == sol.mobility.dof
    assert left_out == []
    assert {body.get("name") for body in root.iter("body")} == set(sol.mechanism.bodies) - {"ground"}


@pytest.mark.parametrize("name", SOLVED)
def test_frames_of_the_tree_stand_where_the_bodies_do(name: str) -> None:
    sol = SOLVED[name][0]()
    poses = poses_of(sol)
    for node in tree_of(sol.mechanism, poses).nodes:
        above, here = poses[node.parent], node.pose
        c, s = math.cos(above.angle), math.sin(above.angle)
        place = (above.x + c * here.x - s * here.y, above.y + s * here.x + c * here.y)
        assert place == pytest.approx((poses[node.body.name].x, poses[node.body.name].y), abs=1e-12)


@pytest.mark.parametrize("name", SOLVED)
def test_urdf_is_a_tree_whose_frames_stand_where_the_bodies_do(name: str) -> None:
    sol = SOLVED[name][0]()
    root = fromstring(urdf(sol)[0].partition("\n")[2])
    links = {link.get("name") for link in root.iter("link")}
    above: dict[str, Element] = {}
    for joint in root.iter("joint"):
        child = joint.find("child")
        assert child is not None
        assert child.get("link") not in above  # one joint above each
        above[str(child.get("link"))] = joint
    assert set(above) == links - {"ground"}
    poses = poses_of(sol)
    for body in sol.mechanism.bodies:
        x, y, angle = _in_world(body, above)
        assert (x, y) == pytest.approx((poses[body].x, poses[body].y), abs=1e-12)
        assert math.remainder(angle - poses[body].angle, math.tau) == pytest.approx(0.0, abs=1e-12)


def _in_world(link: str, above: dict[str, Element]) -> tuple[float, float, float]:
    if link not in above:
        return 0.0, 0.0, 0.0
    origin, parent = above[link].find("origin"), above[link].find("parent")
    assert origin is not None
    assert parent is not None
    x, y, angle = _in_world(str(parent.get("link")), above)
    dx, dy, _ = map(float, str(origin.get("xyz")).split())
    c, s = math.cos(angle), math.sin(angle)
    return x + c * dx - s * dy, y + s * dx + c * dy, angle + float(str(origin.get("rpy")).split()[2])


@pytest.mark.parametrize("name", SOLVED)
def test_mujoco_moves_it_the_same(name: str) -> None:
    mujoco = pytest.importorskip("mujoco")
    solve, most = SOLVED[name]
    sol = solve()
    model = mujoco.MjModel.from_xml_string(mjcf(sol)[0])
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    views = {body: sol.body(body) for body in sol.mechanism.bodies if body != "ground"}
    size = max(sol.packed.size, *(np.ptp(view.x) + np.ptp(view.y) for view in views.values()))
    worst = 0.0
    while data.time < sol.t[-1] - 1e-9:
        mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        for body, view in views.items():
            here = np.array([np.interp(data.time, sol.t, view.x), np.interp(data.time, sol.t, view.y)])
            worst = max(worst, float(np.hypot(*(data.body(body).xpos[:2] - here))))
    assert worst < most * size


def test_features_that_cannot_be_exported_are_named() -> None:
    m = Mechanism("rack")
    pinion, rack = m.body("pinion", mass=1.0, inertia=1e-3), m.body("rack", mass=1.0, inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0.02), pinion.origin)
    m.prismatic("guide", m.ground.at(0, 0), rack.origin)
    m.rack_and_pinion("mesh", rack.origin, pinion.origin, 0.02)
    m.torque("brake", pinion, lambda t: -0.1)
    m.drive_angle("motor", pinion, lambda t: np.sin(t))
    sol = m.sweep(0.5, steps=10)
    assert mjcf(sol)[1] == ["joint 'mesh' (rack_and_pinion)", "force 'brake' (torque)", "driver 'motor' (drive_angle)"]
    assert urdf(sol)[1] == ["joint 'mesh' (rack_and_pinion)", "force 'brake' (torque)"]
