"""Linkages whose dimensions stray, and their closed forms."""

from __future__ import annotations

import numpy as np

from mbsd import Mechanism
from tools.models import linkages

GROUND, CRANK, COUPLER, ROCKER = 0.120, 0.040, 0.120, 0.090
SIZES = {"crank": 5e-5, "coupler": 8e-5, "rocker": 6e-5, "D": {"x": 4e-5}}


def four_bar(mass: float | None = None) -> Mechanism:
    return linkages.four_bar(GROUND, CRANK, COUPLER, ROCKER, masses=3 * [mass], traced=(0.06, 0.03))


def rocker_angle(angle, crank=CRANK, coupler=COUPLER, rocker=ROCKER, ground=GROUND, pin=(0.0, 0.0)):
    """Angle (rad) of the rocker of four_bar, by two circles; ``pin`` (m) is added to the place of B."""
    bx, by = crank * np.cos(angle) + pin[0], crank * np.sin(angle) + pin[1]
    dx, dy = ground - bx, -by
    length = np.hypot(dx, dy)
    along = (length**2 + coupler**2 - rocker**2) / (2 * length)
    height = np.sqrt(coupler**2 - along**2)
    cx = bx + (along * dx - height * dy) / length
    cy = by + (along * dy + height * dx) / length
    return np.arctan2(cy, cx - ground)


def slider_crank() -> Mechanism:
    return linkages.slider_crank(0.05, 0.15, 0.0, start=(0, 0))


def switch() -> Mechanism:
    """A lever that a spring moves."""
    m = Mechanism("switch", gravity=None)
    lever = m.bar("lever", 0.10, mass=0.2)
    m.revolute("pivot", m.ground.at(0, 0), lever.start)
    m.spring("spring", m.ground.at(0, 0.16), lever.end, stiffness=120.0, damping=0.0, free_length=0.10)
    m.torsion_spring("oil", m.ground, lever, stiffness=0.0, damping=0.004)
    m.start_near(lever=80)
    return m
