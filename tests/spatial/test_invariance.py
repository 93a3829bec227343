"""Planar mechanisms built in space give the planar numbers, in any orientation, and any frame gives the same motion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import mbsd
from mbsd import constant_rate
from mbsd.spatial import Mechanism
from mbsd.spatial.model.rotation import rotation_matrix

TOLERANCE = 1e-10


def planar_four_bar() -> mbsd.Mechanism:
    m = mbsd.Mechanism("four-bar", gravity=(0.0, -9.81))
    crank, coupler, rocker = (
        m.bar("crank", 0.3, mass=1.0),
        m.bar("coupler", 0.9, mass=2.0),
        m.bar("rocker", 0.7, mass=1.5),
    )
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.8, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(3.0))
    m.start_near(crank=0, coupler=40, rocker=90)
    return m


def planar_slider_crank() -> mbsd.Mechanism:
    m = mbsd.Mechanism("slider-crank", gravity=(0.0, -9.81))
    crank, rod = m.bar("crank", 0.2, mass=1.0), m.bar("rod", 0.7, mass=2.0)
    slider = m.body("slider", 3.0, inertia=0.1)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.at(0, 0))
    m.prismatic("D", m.ground.at(0, 0.05), slider.at(0, 0))
    m.drive_angle("motor", crank, constant_rate(3.0))
    m.start_near(crank=0, rod=0)
    return m


def in_space(plane: mbsd.Mechanism, sol: mbsd.Solution, turned: np.ndarray, shift: np.ndarray) -> Mechanism:
    """Return the mechanism of a planar one at its first pose, turned and shifted: hinges, rails and a motor."""
    m = Mechanism(plane.name, gravity=turned @ [0.0, -9.81, 0.0])

    def place(x: float, y: float) -> np.ndarray:
        return shift + turned @ [x, y, 0.0]

    for name, body in list(plane.bodies.items())[1:]:
        frame = sol.body(name)
        angle = frame.theta[0]
        axes = turned @ rotation_matrix([math.cos(angle / 2), 0, 0, math.sin(angle / 2)])
        arm = rotation_matrix([math.cos(angle / 2), 0, 0, math.sin(angle / 2)]) @ [*body.com, 0.0]
        moment = np.diag([body.inertia * 0.5, body.inertia * 0.5, body.inertia])  # across the plane it plays no part
        com = place(frame.x[0], frame.y[0]) + turned @ arm
        m.body(name, body.mass, com=com, inertia=axes @ moment @ axes.T)
    normal, along = turned @ [0, 0, 1], turned @ [1, 0, 0]
    for name, joint in plane.joints.items():
        view = sol.joint(name)
        at = place(view.x[0], view.y[0])
        if joint.kind.name == "revolute":
            m.revolute(name, *joint.bodies, at=at, axis=normal)
        else:
            m.prismatic(name, *joint.bodies, at=at, axis=along)
    m.drive_turn("motor", "A", constant_rate(3.0))
    return m


@pytest.mark.parametrize("build", [planar_four_bar, planar_slider_crank])
@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_planar_mechanism_in_space_gives_the_planar_numbers(build, seed: int) -> None:
    plane = build()
    sol = plane.sweep(duration=2.0, steps=50)
    random = np.random.default_rng(seed)
    turned, shift = rotation_matrix(random.standard_normal(4)), random.uniform(-1.0, 1.0, 3)
    space = in_space(plane, sol, turned, shift).sweep(duration=2.0, steps=50)
    assert np.allclose(space.driver("motor").torque, sol.driver("motor").torque, rtol=TOLERANCE, atol=TOLERANCE)
    for name in plane.joints:
        flat, view = sol.joint(name), space.joint(name)
        local = (view.place - shift) @ turned
        assert np.allclose(local, np.column_stack([flat.x, flat.y, 0 * flat.x]), rtol=0, atol=TOLERANCE)
        force = view.force @ turned
        wanted = np.column_stack([flat.fx, flat.fy, 0 * flat.fx])
        assert np.allclose(force, wanted, rtol=TOLERANCE, atol=TOLERANCE * np.abs(wanted).max())
    for name in list(plane.bodies)[1:]:
        assert np.allclose(space.body(name).w @ turned, np.outer(sol.body(name).omega, [0, 0, 1]), atol=TOLERANCE)
        assert np.allclose(space.body(name).alpha @ turned, np.outer(sol.body(name).alpha, [0, 0, 1]), atol=1e-9)


@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1))
def test_frames_of_bodies_change_nothing(seed: int) -> None:
    """A body's frame and its inertia in other axes leave the motion and the reactions as they are."""
    random = np.random.default_rng(seed)
    inertia = np.diag([0.3, 0.4, 0.5])
    efforts = []
    for orientation in ([1.0, 0, 0, 0], random.standard_normal(4)):
        rotation = rotation_matrix(orientation)
        at = random.uniform(-1, 1, 3)
        m = Mechanism("frames")
        com = np.array([0.1, 0.2, 0.3])
        body = m.body(
            "body",
            2.0,
            com=rotation.T @ (com - at),
            inertia=rotation.T @ inertia @ rotation,
            at=at,
            orientation=orientation,
        )
        m.revolute("hinge", m.ground, body, at=(0, 0, 0), axis=(1, 2, 3))
        m.drive_turn("motor", "hinge", constant_rate(2.0))
        sol = m.sweep(steps=20)
        efforts.append(
            np.column_stack([sol.driver("motor").torque, sol.joint("hinge").force, sol.joint("hinge").moment])
        )
    assert np.allclose(*efforts, rtol=1e-11, atol=1e-11)
