"""Knocks of joints: a pin changes sides in its bore, or the force of a joint jumps.

In its clearance c a pin is free while its force F passes zero at a rate F'; it crosses with

    c = F' t^3 / (6 m)      v = F' t^2 / (2 m)      J = m v

m is the mass of both bodies on each other. A force that jumps by dF within one step of the motion moves a mode of
frequency f as the impulse J = dF / (2 pi f) does. Source: Haines 1980, Survey: 2-Dimensional Motion and Impact at
Revolute Joints, Mech. Mach. Theory 15, 361.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Blows, Desk
from render.sound.setting import Setting
from shared.contract import JointMotion

Array = NDArray[np.float64]
NAME = "knocks"
CLEARANCE = 5e-4
"""Clearance of a joint, as a part of the size of its body."""
LONG = 0.0006
"""Duration of a knock (s)."""
NEAR = 0.25
"""A force passes zero where it is below this part of its largest, and ends up the other way."""
SUDDEN = 8.0
"""A force jumps where it changes so many times faster than before and after ..."""
LARGE = 0.15
"""... by this part of its largest."""


def play(setting: Setting, desk: Desk) -> None:
    """Strike the bodies of joints that knock."""
    for _, joint in setting.heard(setting.motion.joints):
        if joint.pair is not None or joint.acts is not None:
            _joint(setting, desk, joint)


def _joint(setting: Setting, desk: Desk, joint: JointMotion) -> None:
    modes = [each for body in joint.bodies if body != "ground" and (each := setting.modes(body))]
    force = np.stack([joint.fx, joint.fy])
    if not modes or np.hypot(*force).max() < 1e-9:
        return
    lightest = min(modes, key=lambda each: each.mass)
    lowest = float(min(each.frequency[0] for each in modes))
    times, impulse = _crossings(setting, joint, force, CLEARANCE * lightest.size)
    jumps, change = _jumps(setting.time, force)
    times, impulse = np.append(times, jumps), np.append(impulse, change / (2 * np.pi * lowest))
    film, index = setting.when(times)
    side = np.interp(film, setting.at, setting.side(np.asarray(joint.x), np.asarray(joint.y)))
    for body in joint.bodies:
        desk.strike(NAME, body, Blows(film, impulse[index], np.full(len(film), LONG), side))


def _crossings(setting: Setting, joint: JointMotion, force: Array, clearance: float) -> tuple[Array, Array]:
    """Return times at which the force of a joint turns round, and its impulses.

    It turns within a small part of its size.
    """
    time, size = setting.time, np.hypot(*force)
    steps = np.diff(time)
    low = np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] < size[2:]) & (size[1:-1] < NEAR * size.max())) + 1
    turned = [k for k in low if steps[k - 1] > 0 and steps[k] > 0 and _turns(force, size, int(k))]
    k = np.array(turned, int)
    if not len(k):
        return np.zeros(0), np.zeros(0)
    rate = np.hypot(*(force[:, k + 1] - force[:, k - 1])) / (time[k + 1] - time[k - 1])
    mass = setting.mass(*joint.bodies)
    free = (6 * mass * clearance / np.maximum(rate, 1e-12)) ** (1 / 3)
    return time[k], rate * free**2 / 2


def _turns(force: Array, size: Array, k: int) -> bool:
    """Return True if the force points the other way after its least value at ``k``."""
    before, after = force[:, max(0, k - 3)], force[:, min(force.shape[1] - 1, k + 3)]
    return float(before @ after) < 0 and bool(size[k] < size.max())


def _jumps(time: Array, force: Array) -> tuple[Array, Array]:
    """Return times at which a force jumps, and by how much (N); not at impacts, which are heard as such."""
    change = np.hypot(*np.diff(force, axis=1))
    if len(change) < 8:
        return np.zeros(0), np.zeros(0)
    apart = np.diff(time) > 0
    row = np.concatenate([change[-3:], change, change[:3]])
    around = np.median(np.stack([np.roll(row, s)[3:-3] for s in (-3, -2, 2, 3)]), axis=0)
    sharp = (change > SUDDEN * around) & (change > LARGE * np.hypot(*force).max()) & apart
    k = np.flatnonzero(sharp)
    return (time[k] + time[k + 1]) / 2, change[k]
