"""Linkages whose dimensions stray, and their closed forms."""

from __future__ import annotations

import numpy as np

from mbsd import Mechanism, constant_rate

GROUND, CRANK, COUPLER, ROCKER = 0.120, 0.040, 0.120, 0.090
SIZES = {"crank": 5e-5, "coupler": 8e-5, "rocker": 6e-5, "D": {"x": 4e-5}}


def four_bar(mass: float | None = None) -> Mechanism:
    m = Mechanism("four_bar")
    crank, coupler, rocker = (
        m.bar(name, length, mass=mass) if mass else m.bar(name, length)
        for name, length in (("crank", CRANK), ("coupler", COUPLER), ("rocker", ROCKER))
    )
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(GROUND, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(2 * np.pi))
    m.trace("P", coupler.at(0.06, 0.03))
    m.start_near(crank=0, coupler=45, rocker=100)
    return m


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
    m = Mechanism("slider_crank")
    crank, rod, slider = m.bar("crank", 0.05), m.bar("rod", 0.15), m.body("slider")
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(2 * np.pi))
    m.start_near(crank=0, rod=0)
    return m


def switch() -> Mechanism:
    """A lever that a spring moves."""
    m = Mechanism("switch", gravity=None)
    lever = m.bar("lever", 0.10, mass=0.2)
    m.revolute("pivot", m.ground.at(0, 0), lever.start)
    m.spring("spring", m.ground.at(0, 0.16), lever.end, stiffness=120.0, damping=0.0, free_length=0.10)
    m.torsion_spring("oil", m.ground, lever, stiffness=0.0, damping=0.004)
    m.start_near(lever=80)
    return m
