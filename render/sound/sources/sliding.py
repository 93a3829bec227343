"""Friction: pins in bores, sliders on guides, followers on cams, sliding contacts, rolling wheels.

    sliding   P = mu N v         v: speed of the surfaces; of a pin omega r, r a fiftieth of the machine's size
    rolling   P = c N v          c = 0.002, v = omega r
    friction  P as data.json has it, of forces that are friction, and of dampers

A part 1e-6 of P leaves as noise about the frequency v / l at which roughness of wave length l = 0.2 mm passes, and ten
times lower of wheels. Friction that the model does not have, mu = 0.1, is that of oiled metal. In slow motion roughness
passes more slowly. Source: Akay 2002, Acoustics of Friction, J. Acoust. Soc. Am. 111, 1525.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Desk
from render.sound.ringing import of_power
from render.sound.setting import Setting
from shared.contract import ContactMotion, ForceMotion, JointMotion

Array = NDArray[np.float64]
NAME = "friction"
FRICTION, ROLLING = 0.1, 0.002
EFFICIENCY = 1e-6
ROUGHNESS, ROLLED = 2e-4, 2e-3
"""Wave lengths of roughness (m)."""
PIN = 1 / 50
BAND = (300.0, 5000.0)
"""Frequencies of the noise (Hz)."""


class Rubbing(NamedTuple):
    """A sliding pair: power (W), speed (m/s), places (m), all (T,); wave length of its roughness (m)."""

    power: Array
    speed: Array
    x: Array
    y: Array
    length: float = ROUGHNESS


def play(setting: Setting, desk: Desk) -> None:
    """Play the noise of all that slides with friction."""
    for rubbing in _all(setting):
        if rubbing.power.max(initial=0.0) > 0:
            level = of_power(setting.series(rubbing.power), EFFICIENCY) * (setting.rate > 0)
            centre = np.clip(setting.series(rubbing.speed) * setting.rate / rubbing.length, *BAND)
            desk.noise(NAME, level, centre, setting.side(rubbing.x, rubbing.y))


def _all(setting: Setting) -> Iterator[Rubbing]:
    for _, joint in setting.heard(setting.motion.joints):
        yield from _joint(setting, joint)
    for _, force in setting.heard(setting.motion.forces):
        yield from _force(setting, force)
    for _, contact in setting.heard(setting.motion.contacts):
        yield from _contact(setting, contact)


def _joint(setting: Setting, joint: JointMotion) -> Iterator[Rubbing]:
    load, x, y = np.hypot(joint.fx, joint.fy), np.asarray(joint.x), np.asarray(joint.y)
    if joint.pair == "pin" or joint.look in ("roller", "captive"):
        speed = np.abs(setting.turning(joint.bodies)) * setting.film.size * PIN
        yield Rubbing(FRICTION * load * speed, speed, x, y)
    elif joint.pair is not None:
        speed = setting.slip(joint.bodies, x, y)
        yield Rubbing(FRICTION * load * speed, speed, x, y)
    elif joint.acts is not None:
        yield from _touching(setting, joint, load, np.asarray(joint.acts.x), np.asarray(joint.acts.y))


def _touching(
    setting: Setting, joint: JointMotion | ContactMotion, load: Array, x: Array, y: Array
) -> Iterator[Rubbing]:
    """Yield slides where its surfaces have different speeds, and rolls as its bodies turn."""
    speed = setting.slip(joint.bodies, x, y)
    yield Rubbing(FRICTION * load * speed, speed, x, y)
    radius = joint.shape.radius_second if joint.shape else None
    if radius and not (joint.shape and joint.shape.teeth):
        rolled = np.abs(setting.turning(joint.bodies)) * radius
        yield Rubbing(ROLLING * load * rolled, rolled, x, y, ROLLED)


def _force(setting: Setting, force: ForceMotion) -> Iterator[Rubbing]:
    if not force.actions or force.drives or force.gas is not None:
        return
    acting, power = force.actions[-1], np.maximum(-np.asarray(force.power), 0.0)
    x, y = np.asarray(acting.x), np.asarray(acting.y)
    speed = np.abs(force.rate) if force.rate is not None else np.zeros(len(x))
    if force.normal is not None:
        yield Rubbing(power, speed, x, y)
    elif force.measures == "gap" and force.shape is not None and force.shape.radius_second:
        rolled = np.abs(setting.turning(force.shape.bodies)) * force.shape.radius_second
        yield Rubbing(5 * ROLLING * np.abs(force.effort or 0.0) * rolled, rolled, x, y, ROLLED)
    elif force.look == "cylinder":
        yield Rubbing(power, speed, x, y)


def _contact(setting: Setting, contact: ContactMotion) -> Iterator[Rubbing]:
    places = contact.acts or contact
    x, y = np.asarray(places.x), np.asarray(places.y)
    closed = np.array([state != "open" for state in contact.state])
    load = np.where(closed, np.abs(contact.normal), 0.0)
    if contact.unit == "m" and not contact.look:
        yield from _touching(setting, contact, load, x, y)
