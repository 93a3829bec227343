"""Mechanisms on which integrators are measured: an open chain, a closed chain, and that with a stiff joint."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ellipj, ellipk

from mbsd import Mechanism

G = 9.81
AMPLITUDE = math.radians(100)
"""Amplitude of the pendulum, whose rod of 1.5 m swings like a point on a string of 1 m."""


def pendulum() -> Mechanism:
    """A rod hung at its end, released 100 degrees from rest."""
    m = Mechanism("pendulum", gravity=(0.0, -G))
    rod = m.bar("rod", 1.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=math.degrees(AMPLITUDE) - 90.0)
    return m


def pendulum_angle(t: np.ndarray) -> np.ndarray:
    """Angle of the rod from the x axis (rad): sin(phi/2) = k sn(K - w t)."""
    k = math.sin(AMPLITUDE / 2)
    return 2 * np.arcsin(k * ellipj(ellipk(k * k) - math.sqrt(G) * t, k * k)[0]) - math.pi / 2


def four_bar(pin: bool = True) -> Mechanism:
    """A crank-rocker released from rest; it swings through 283 degrees of its crank."""
    m = Mechanism("four-bar", gravity=(0.0, -G))
    crank, coupler, rocker = m.bar("crank", 0.3, 1.0), m.bar("coupler", 0.9, 0.5), m.bar("rocker", 0.7, 2.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("D", m.ground.at(0.8, 0), rocker.start)
    m.start_near(crank=50, coupler=20, rocker=80)
    if pin:
        m.revolute("C", coupler.end, rocker.end)
    return m


def stiff_four_bar() -> Mechanism:
    """The same with a stiff bush for the pin C: its damper alone asks explicit methods for steps below 0.01 ms."""
    m = four_bar(pin=False)
    closed = four_bar().simulate(1e-3, steps=1)
    m.start_near(**{name: math.degrees(float(closed.body(name).theta[0])) for name in ("crank", "coupler", "rocker")})
    m.bushing("C", m.bodies["coupler"].end, m.bodies["rocker"].end, (1e7, 1e7, 0.0), (1e5, 1e5, 0.0))
    return m
