"""A bead on a curve that crosses itself."""

from __future__ import annotations

import math

import numba
import numpy as np

from mbsd import Mechanism

ROUND = np.linspace(0.0, 2 * math.pi, 65)[:-1]


EIGHT = np.stack([np.sin(ROUND), 0.5 * np.sin(2 * ROUND)], axis=1)
"""Lemniscate of Gerono, crossing itself at (0, 0)."""


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
