"""Mechanisms whose exported units are tested."""

from __future__ import annotations

import math
from typing import Any

from mbsd import Mechanism, harmonic, table
from tools.models import linkages


def four_bar(stiffness: float = 30.0, mass: float = 0.3, **more: Any) -> Mechanism:
    """Falls freely from its start, with a spring."""
    m = linkages.four_bar(0.12, 0.04, 0.12, 0.09)
    m.drivers.clear()
    for name in ("crank", "coupler", "rocker"):
        m.change(name, mass=mass, inertia=2e-4)
    m.spring("spring", m.ground.at(0.0, 0.1), m.bodies["coupler"].at(0.05, 0), stiffness, damping=0.2, free_length=0.05)
    m.start_moving(crank=4.0)
    return m


def driven() -> Mechanism:
    m = linkages.four_bar(0.12, 0.04, 0.12, 0.09)
    for name in ("crank", "coupler", "rocker"):
        m.change(name, mass=0.2, com=(0.02, 0.005), inertia=1e-4)
    m.trace("P", m.bodies["coupler"].at(0.05, 0.02, 0.3))
    return m


def geared() -> Mechanism:
    m = Mechanism("gears")
    small, large = m.body("small", mass=0.1, inertia=1e-4), m.body("large", mass=0.4, inertia=2e-3)
    m.revolute("S", m.ground.at(0, 0), small.origin)
    m.revolute("L", m.ground.at(0.06, 0), large.origin)
    m.gear_pair("mesh", small.origin, large.origin, 0.02, 0.04)
    m.torsion_spring("coil", m.ground, large, 0.5)
    m.torque("motor", small, 0.02)
    return m


def rubbing() -> Mechanism:
    """A law with kinks in its rate, a block with friction, a slot."""
    m = Mechanism("yoke")
    crank, yoke = m.bar("crank", 0.05, mass=0.1), m.body("yoke", mass=0.3, inertia=1e-3)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.prismatic("guide", m.ground.at(0, 0), yoke.at(0, 0))
    m.pin_in_slot("slot", yoke.at(0, 0, math.pi / 2), crank.end)
    m.friction("rubs", "guide", 0.2, slip_speed=0.01, length=0.1)
    m.drive_angle("motor", crank, table([0.0, 0.2, 0.4, 0.6, 0.8, 1.0], [0.3, 1.0, 1.5, 2.5, 3.0, 4.0]))
    return m


def bouncing() -> Mechanism:
    m = Mechanism("ball")
    ball = m.body("ball", mass=0.2, inertia=1e-4)
    m.contact("floor", m.ground.at(0, 0), ball.origin, radius=0.05, stiffness=2e4, damping=2.0)
    m.start_near(ball=(0.0, 0.3, 0.0))
    m.start_moving(ball=(0.5, 0.0, 0.0))
    return m


def lifting() -> Mechanism:
    """Oil, whose pressures are states of the force, and a valve that a law opens."""
    m = Mechanism("lift")
    arm = m.bar("arm", 1.5, mass=20.0)
    m.revolute("pin", m.ground.at(0, 0), arm.start)
    m.hydraulic_cylinder(
        "ram", m.ground.at(0.6, -0.8), arm.at(1.0, -0.05), 0.05, 0.03, 0.5, 0.75, 1.5e7,
        valve=harmonic(0.5, 6.0), rated_flow=5e-4,
    )  # fmt: skip
    m.trace("tip", arm.end)
    m.start_near(arm=0)
    return m
