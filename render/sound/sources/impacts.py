"""Impacts: of rigid contacts, stops and ropes at events, of compliant contacts where gaps close.

    rigid     impulse J of the event; it lasts, after Hertz,
              tau = 2.87 (m^2 / (R E^2 v))^(1/5)     v = J / m    1 / E = 1 / E_1 + 1 / E_2    1 / m = 1 / m_1 + 1 / m_2
    yielding  J = m |v| with the rate v at which the gap closes;   tau = pi m |v| / F      F: the largest force of it

Both bodies ring. R is the radius of the second wheel or disc, else a quarter of the second body's size. That of a
stop of angles (N m s) acts on the arm of half that size. Source: Johnson, Contact Mechanics, 1985, chapter 11.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Blows, Desk
from render.sound.ringing import Modes
from render.sound.setting import Setting
from shared.contract import ContactMotion, ForceMotion

Array = NDArray[np.float64]
NAME = "impacts"
LONGEST = 0.03
"""Longest time of an impact that is heard as one (s)."""


def play(setting: Setting, desk: Desk) -> None:
    """Strike what is struck."""
    impulses: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for event in setting.motion.events:
        if event.what == "impact" and event.impulse:
            impulses[event.name].append((event.time, abs(event.impulse)))
    for name, contact in setting.heard(setting.motion.contacts):
        if impulses[name]:
            _rigid(setting, desk, contact, *np.array(impulses[name]).T)
    for _, force in setting.heard(setting.motion.forces):
        if force.measures == "gap" and force.shape is not None:
            _yielding(setting, desk, force)


def _rigid(setting: Setting, desk: Desk, contact: ContactMotion, times: Array, impulse: Array) -> None:
    first, second = (setting.modes(body) for body in contact.bodies)
    struck = second or first
    if struck is None:
        return
    if contact.unit == "rad":
        impulse = impulse / max(struck.size / 2, 1e-3)
    mass = setting.mass(*contact.bodies)
    radius = (contact.shape.radius_second if contact.shape else None) or struck.size / 4
    tau = _hertz(mass, radius, impulse / mass, first or struck, struck)
    film, index = setting.when(times)
    side = np.interp(film, setting.at, setting.side(np.asarray(contact.x), np.asarray(contact.y)))
    for body in contact.bodies:
        desk.strike(NAME, body, Blows(film, impulse[index], tau[index], side))


def _hertz(mass: float, radius: float, speed: Array, first: Modes, second: Modes) -> Array:
    modulus = 1 / (1 / first.matter.modulus + 1 / second.matter.modulus)
    return np.minimum(2.87 * (mass**2 / (radius * modulus**2 * np.maximum(speed, 1e-4))) ** 0.2, LONGEST)


def _yielding(setting: Setting, desk: Desk, force: ForceMotion) -> None:
    gap, rate, effort = (np.asarray(values) for values in (force.value, force.rate, force.effort))
    closing = np.flatnonzero((gap[:-1] > 0) & (gap[1:] <= 0))
    if not len(closing):
        return
    assert force.shape is not None
    bodies, time = force.shape.bodies, setting.time
    part = gap[closing] / (gap[closing] - gap[closing + 1])
    times = time[closing] + part * (time[closing + 1] - time[closing])
    speed = np.abs(rate[closing])
    mass = setting.mass(*bodies)
    opens = np.append(np.flatnonzero((gap[:-1] <= 0) & (gap[1:] > 0)), len(gap) - 1)
    until = opens[np.searchsorted(opens, closing + 1)]
    most = np.array([effort[a + 1 : b + 1].max(initial=1e-9) for a, b in zip(closing, until, strict=True)])
    tau = np.minimum(np.pi * mass * speed / most, LONGEST)
    film, index = setting.when(times)
    acting = force.actions[-1]
    side = np.interp(film, setting.at, setting.side(np.asarray(acting.x), np.asarray(acting.y)))
    for body in bodies:
        desk.strike(NAME, body, Blows(film, (mass * speed)[index], tau[index], side))
