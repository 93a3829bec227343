"""Teeth that mesh, of gears, racks, chains and toothed belts: small strokes that sum to a tone.

    phase    n = z (theta - phi) / 2 pi     a tooth of the wheel with z teeth meets the line of centres, at phi,
                                            whenever n passes a whole number: f = z omega / 2 pi on a fixed axis
    stroke   dF = e F                       as the number of pairs that share the load F changes: J = dF / (2 pi f_1)
    tone     harmonics k f of weight 1 / k^2, with the pressure of the force dF at f

e = 0.15 is the change of a pair's stiffness with a contact ratio of about 1.6; without a load teeth bear a part of the
wheel's weight. In a film twenty times slower teeth pass twenty times more slowly, and one hears each.
Sources: Smith, Gear Noise and Vibration, 2003; Cai, Hayashi 1994, J. Mech. Des. 116, 558.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Blows, Desk
from render.sound.ringing import of_force
from render.sound.setting import Setting
from shared.contract import JointMotion, Shape

Array = NDArray[np.float64]
NAME = "mesh"
SHARE = 0.15
"""Part of the load that changes from tooth to tooth."""
LIGHT = 0.02
"""Load of teeth that transmit none, as a part of the weight of the lighter wheel."""
LONG = 0.0003
"""Duration of the stroke of a tooth (s)."""
WEIGHTS = tuple(1 / k**2 for k in range(1, 7))
MOST = 60_000
"""Strokes of one pair in a showing; of more the tone alone is heard."""


def play(setting: Setting, desk: Desk) -> None:
    """Play the teeth of every pair that has some."""
    for _, joint in setting.heard(setting.motion.joints):
        if joint.shape is not None and joint.shape.teeth:
            _pair(setting, desk, joint, joint.shape)


def _pair(setting: Setting, desk: Desk, joint: JointMotion, shape: Shape) -> None:
    phase = setting.closed(setting.continued(teeth_passed(setting, shape)))
    frequency = np.abs(np.gradient(phase, setting.at))
    places = joint.acts or joint
    side = setting.side(np.asarray(places.x), np.asarray(places.y))
    change = SHARE * (setting.series(_load(joint, shape)) + LIGHT * 9.81 * setting.mass(*shape.bodies))
    change = np.where(frequency > 1e-9, change, 0.0)
    desk.tone(NAME, phase, of_force(change, frequency), WEIGHTS, side)
    film = crossings(setting.at, phase)
    if len(film) > MOST:
        return
    force, where = np.interp(film, setting.at, change), np.interp(film, setting.at, side)
    for body in shape.bodies:
        modes = setting.modes(body)
        if modes is not None:
            lowest = float(modes.frequency[0])
            desk.strike(NAME, body, Blows(film, force / (math.tau * lowest), np.full(len(film), LONG), where))


def _load(joint: JointMotion, shape: Shape) -> Array:
    """Return (T,) force between the teeth (N).

    A belt's reaction is a torque; its force is that over the radius.
    """
    force, torque = np.hypot(joint.fx, joint.fy), np.abs(joint.torque)
    radius = shape.radius_second or shape.radius_first
    return np.maximum(force, torque / radius) if radius else force


def teeth_passed(setting: Setting, shape: Shape) -> Array:
    """Return (M + 1,) how many teeth have passed the mesh of two wheels, or of a pinion and a rack."""
    (a, b), (first, second) = shape.bodies, shape.markers
    if len(shape.teeth) == 1:
        return shape.teeth[0] * (setting.angle(b) - setting.angle(a)) / math.tau
    way = setting.place(b, *second[:2]) - setting.place(a, *first[:2])
    line = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    return shape.teeth[0] * (setting.angle(a) - line) / math.tau if a != "ground" else _of_ring(setting, shape, line)


def _of_ring(setting: Setting, shape: Shape, line: Array) -> Array:
    """Return the same if the first wheel stands still: teeth pass the line of centres as that turns."""
    return -shape.teeth[0] * line / math.tau


def crossings(at: Array, phase: Array) -> Array:
    """Return the film seconds at which the phase passes whole numbers, in order."""
    low, high = np.floor(phase[:-1]), np.floor(phase[1:])
    count = np.abs(high - low).astype(int)
    step = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(step)) - np.repeat(np.cumsum(count) - count, count)
    whole = np.where(high[step] > low[step], low[step] + 1 + number, low[step] - number)
    part = (whole - phase[step]) / (phase[step + 1] - phase[step])
    return at[step] + part * (at[step + 1] - at[step])
