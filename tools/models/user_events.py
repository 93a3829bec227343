"""Machines with compiled and ready-made events of the user."""

from __future__ import annotations

import math

import numba

from mbsd import Mechanism, angle_reaches, constant_rate, distance_reaches, speed_reaches


@numba.njit
def height(t, q, v):
    return q[1] - 0.3


@numba.njit
def halved(t, q, v):
    return 0.5 * v[0], 0.5 * v[1], 0.5 * v[2]


@numba.njit
def kicked(t, q, v):
    return v[0] + 0.2, -0.7 * v[1], v[2] + 3.0


@numba.njit
def wavy(t, q, v):
    return math.sin(90.0 * q[0] + 20.0 * t) - 0.3


@numba.njit
def pulse(t, q, v):
    return 0.5 - 1.0 * (abs(math.sin(8.0 * t)) < 0.02) + 0.0 * q[0]


def swing() -> Mechanism:
    """An arm that is slowed down each time its tip comes up, until it is fast no more or has turned."""
    m = Mechanism("swing", gravity=(0, -9.81))
    arm = m.bar("arm", 0.5, mass=0.3)
    m.revolute("hinge", m.ground.at(0, 0), arm.start)
    m.torque("drive", arm, 1.5)
    m.event("up", height, direction=1, action=halved, frames=arm.end)
    m.event("down", height, direction=-1, frames=[arm.end])
    m.event("turned", angle_reaches(arm, 7.0), terminal=True)
    m.start_near(arm=-80)
    return m


def ball() -> Mechanism:
    """It bounces, is hit on its way down, and stops where it comes too near a point."""
    m = Mechanism("ball", gravity=(0, -9.81))
    ball = m.body("ball", mass=0.2, inertia=1e-4)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, radius=0.05, restitution=0.6, friction=0.2)
    m.event("bat", height, direction=-1, action=kicked, frames=ball)
    m.event("near", distance_reaches(m.ground.at(0.6, 0.4), ball.at(0.01, 0.0), 0.1), direction=-1, terminal=True)
    m.start_near(ball=(0.0, 0.5, 0))
    m.start_moving(ball=(0.2, 0, 1.0))
    return m


def rubbing() -> Mechanism:
    """A pendulum with a dry bearing that is hit wherever it is slow enough; it comes to rest."""
    m = Mechanism("rubbing")
    arm, bob = m.bar("arm", 0.6, mass=1.0), m.body("bob", mass=0.4, inertia=2e-3)
    m.revolute("pin", m.ground.origin, arm.start)
    m.revolute("tip", arm.end, bob.at(0.05, 0.02))
    m.friction("rub", "pin", 0.3, radius=0.04, sticks=True)
    m.event("fast", speed_reaches(arm, 2.0))
    m.event("wave", wavy, frames=(bob.at(0.02, 0.0),), direction=1)
    m.start_near(arm=-10)
    return m


def crank() -> Mechanism:
    """A crank with a motor; pulses of a function slow the slider, and all ends before the end."""
    m = Mechanism("crank")
    crank, rod = m.bar("crank", 0.1, mass=0.3), m.bar("rod", 0.4, mass=0.5)
    slider = m.body("slider", mass=0.8)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("D", m.ground.origin, slider.origin)
    m.drive_angle("motor", crank, constant_rate(9.0))
    m.spring("spring", m.ground.at(0.8, 0), slider.origin, 40.0, 2.0, free_length=0.3)
    m.event("pulse", pulse, frames=slider, shortest=0.004)
    m.event("there", angle_reaches(crank, 11.0), terminal=True)
    m.start_near(crank=0, rod=0)
    return m
