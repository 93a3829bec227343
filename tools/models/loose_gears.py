"""Gears that no arm holds apart."""

from __future__ import annotations

import math

from mbsd import Mechanism


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
