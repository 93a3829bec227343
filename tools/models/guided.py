"""Machines guided for a while: Geneva drives, a bead on a crossing curve, gears that no arm holds."""

from __future__ import annotations

import math

import numba
import numpy as np

from mbsd import Mechanism, constant_rate

ROUND = np.linspace(0.0, 2 * math.pi, 65)[:-1]
EIGHT = np.stack([np.sin(ROUND), 0.5 * np.sin(2 * ROUND)], axis=1)
"""Lemniscate of Gerono, crossing itself at (0, 0)."""


def geneva(slots: int, distance: float = 0.1, start: float = 0.0) -> Mechanism:
    """With the given slots and distance of centres (m), its crank turning at 1 rad/s from ``start`` (rad)."""
    m = Mechanism("geneva", gravity=None)
    crank, wheel = m.body("crank"), m.body("wheel", 1.0, (0, 0), 2e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(distance, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots, distance * math.sin(math.pi / slots))
    m.drive_angle("motor", crank, constant_rate(1.0, start))
    m.start_near(wheel=5)
    return m


def two_genevas() -> Mechanism:
    """Two wheels of one crank, which starts where a pin leaves."""
    m = Mechanism("two", gravity=None)
    crank = m.body("crank", 0.5, (0.0, 0.0), 1e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    for name, slots, x in (("wheel", 4, 0.1), ("other", 5, -0.12)):
        wheel = m.body(name, 1.0, (0.0, 0.0), 1e-3)
        m.revolute(f"W{name}", m.ground.at(x, 0), wheel.origin)
        turned = 0.0 if x > 0 else math.pi / 3
        m.geneva(f"index {name}", crank.at(0, 0, turned), wheel.origin, slots, abs(x) * math.sin(math.pi / slots))
    m.start_near(crank=-45.0)
    m.start_moving(crank=6.0)
    return m


def free_geneva(slots: int, gravity: tuple[float, float] | None = (0.0, -9.81), speed: float = 10.0) -> Mechanism:
    """A crank with a flywheel's inertia that turns a wheel and its own unbalance."""
    m = Mechanism("geneva", gravity=gravity)
    crank, wheel = m.body("crank", 0.5, (0.01, 0.0), 1e-3), m.body("wheel", 1.0, (0.0, 0.0), 2e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(0.1, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots, 0.1 * math.sin(math.pi / slots))
    m.torsion_spring("spring", m.ground, crank, 0.0, 0.0)
    m.start_near(wheel=5)
    m.start_moving(crank=speed)
    return m


def swinging_geneva() -> Mechanism:
    """It swings back at its slot, again and again."""
    m = free_geneva(4, speed=1.0)
    m.change("spring", stiffness=0.02)
    return m


def heavy_pair_of_genevas() -> Mechanism:
    """Two wheels of one crank, whose spring and damper vary."""
    m = two_genevas()
    m.torsion_spring("spring", m.ground, m.bodies["crank"], 0.0, 1e-4)
    return m


def loose_gears(stiffness: float = 0.0) -> Mechanism:
    """Wheels whose centres nothing holds apart: they meet after about a second."""
    m = Mechanism("loose", gravity=None)
    ring, gear = m.body("ring", 2.0, inertia=1.0), m.body("gear", 1.0, inertia=0.1)
    wide = math.hypot(0.3, 0.05) / 0.3
    m.gear_pair("mesh", ring.origin, gear.origin, radius_i=0.5 * wide, radius_j=0.2 * wide, internal=True)
    m.torsion_spring("coil", m.ground, gear, stiffness, 0.1, 0.5)
    m.start_near(ring=(0, 0, 0), gear=(0.3, 0.05, 0))
    m.start_moving(gear=(-0.3, -0.05, 0.0), ring=(0.0, 0.0, 0.0))
    return m


@numba.njit
def middle(t, q, v):
    return q[0]


@numba.njit
def faster(t, q, v):
    return 1.05 * v[0], 1.05 * v[1], v[2]


def coaster(events: bool = False, stop: bool = False) -> Mechanism:
    """A bead on a figure of eight, drawn to its middle from a cart."""
    m = Mechanism("coaster")
    bead, cart = m.body("bead", 1.0, inertia=1e-3), m.body("cart", 2.0, inertia=1e-3)
    m.point_on_curve("track", m.ground.at(0, 0), bead.origin, EIGHT.tolist(), closed=True)
    m.prismatic("rail", m.ground.at(0, -1.0), cart.origin)
    m.spring("tie", bead.origin, cart.origin, 30.0, 0.2, free_length=0.5)
    if stop:
        m.coordinate_stop("wall", m.ground.origin, cart.origin, 0.15, upper=True, restitution=0.6)
    if events:
        m.event("middle", middle, direction=1, action=faster, frames=bead)
    m.start_near(bead=(*EIGHT[10], 0), cart=(0.0, -1.0, 0))
    return m
