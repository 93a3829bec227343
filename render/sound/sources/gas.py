"""Gas behind pistons: the step of pressure of a combustion, which strikes piston and cylinder.

    F(t) = A p(t)      at each greatest rate of F within a cycle:    dF the rise from its foot, in the time tau that it
                       takes;    J = dF / (2 pi f_1),  f_1 the lowest mode of the piston

Source: Heywood, Internal Combustion Engine Fundamentals, 2018, chapter 9: noise follows the rate of the rise.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Blows, Desk
from render.sound.setting import Setting
from shared.contract import ForceMotion

Array = NDArray[np.float64]
NAME = "gas"
STEEP = 0.5
"""A combustion rises at this part of the greatest rate at least."""
LONG = (0.0005, 0.02)
"""A blow lasts so long, as it is heard (s)."""


def play(setting: Setting, desk: Desk) -> None:
    """Play every gas whose pressure rises steeply."""
    for _, force in setting.heard(setting.motion.forces):
        if force.gas is not None and force.actions:
            _blows(setting, desk, force)


def _blows(setting: Setting, desk: Desk, force: ForceMotion) -> None:
    acting = force.actions[-1]
    size = np.hypot(acting.fx, acting.fy)
    rate = np.gradient(setting.continued(setting.series(size)), setting.at)
    steepest = float(rate.max())
    if steepest <= 0:
        return
    steep = rate > STEEP * steepest
    first = np.flatnonzero(steep & ~np.roll(steep, 1))
    last = np.array([min(k + int(np.argmin(np.append(steep[k:], False))), len(steep) - 1) for k in first])
    rise = np.array(
        [float(np.trapezoid(rate[a : b + 1], setting.at[a : b + 1])) for a, b in zip(first, last, strict=True)]
    )
    kept = rise > 0
    film, long = setting.at[first][kept], (setting.at[last] - setting.at[first])[kept]
    side = np.interp(film, setting.at, setting.side(np.asarray(acting.x), np.asarray(acting.y)))
    for action in force.actions:
        modes = setting.modes(action.body)
        if modes is not None:
            impulse = rise[kept] / (math.tau * float(modes.frequency[0]))
            desk.strike(NAME, action.body, Blows(film, impulse, np.clip(long, *LONG), side))
