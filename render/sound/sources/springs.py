"""Springs: waves that run along the wire when its ends are moved suddenly, and the creak of its coils.

    f_n = n / 2 sqrt(k / m_s)      surge, n = 1, 2, 3       k: stiffness;  m_s: mass of the wire
    m_s = 2 G rho U / tau^2        the least wire that stores U, the most that the spring holds, at tau = 500 MPa

The ends of a spring move suddenly where its body is struck: it gets the part m_s / (m + m_s) of the impulse.
Its coils creak with 1 % of the power that goes in and out. Source: Wahl, Mechanical Springs, 1963.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Desk
from render.sound.ringing import Matter, modes, of_power
from render.sound.setting import Setting
from render.sound.sources.impacts import NAME as IMPACTS
from shared.contract import ForceMotion

Array = NDArray[np.float64]
NAME = "springs"
SHEAR, DENSITY, STRESS = 79e9, 7850.0, 500e6
CREAK = 0.01
EFFICIENCY = 1e-6
RANGE = (60.0, 4000.0)
COIL = 0.01
"""Radius of the coil of a torsion spring (m)."""
AREA = 30.0
"""Surface of a wire that is wound, over that of a cube of its volume."""
STEEL = Matter(205e9, DENSITY, 0.02)


def play(setting: Setting, desk: Desk) -> None:
    """Play every spring that holds energy."""
    for name, force in setting.heard(setting.motion.forces):
        if force.look in ("coil", "spiral") and max(force.potential, default=0.0) > 0 and force.actions:
            _spring(setting, desk, name, force)


def _spring(setting: Setting, desk: Desk, name: str, force: ForceMotion) -> None:
    acting = force.actions[-1]
    creak = of_power(CREAK * np.abs(setting.series(np.asarray(force.power))), EFFICIENCY) * (setting.rate > 0)
    surge, wire = surge_of(force)
    side = setting.side(np.asarray(acting.x), np.asarray(acting.y))
    for n in (1, 2, 3):
        desk.noise(NAME, creak / n, np.full(len(creak), n * surge), side)
    rings = modes(surge * np.arange(1.0, 7.0), STEEL, wire, AREA * (wire / DENSITY) ** (2 / 3), 0.1)
    held = {action.body for action in force.actions}
    for body, blows in desk.struck[IMPACTS]:
        if body in held and body != "ground":
            part = wire / (wire + setting.motion.bodies[body].mass)
            desk.strike(NAME, f"\0{name}", blows._replace(impulse=part * blows.impulse), rings)


def surge_of(force: ForceMotion) -> tuple[float, float]:
    """Return the lowest frequency (Hz) of waves along the wire of a spring, and the wire's mass (kg)."""
    stored, travel = float(np.ptp(force.potential)), float(np.ptp(np.asarray(force.value)))
    wire = max(2 * SHEAR * DENSITY * stored / STRESS**2, 1e-6)
    stiffness = float(np.ptp(np.asarray(force.effort))) / max(travel, 1e-12)
    if force.unit == "rad":
        stiffness /= COIL**2
    return float(np.clip(0.5 * np.sqrt(stiffness / wire), *RANGE)), wire
