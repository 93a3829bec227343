"""What the crank pins of a shaft carry: the masses that its counterweights are to balance.

A rod of mass m, its centre of mass at the part s of its length from the crank pin, is replaced by masses at its ends:

    m (1 - s) turns with the pin,    m s + m_p slides with the piston

Half of what slides, put on the pin, turns with the shaft like the first order of its force that does; the other half
turns against the shaft, and no counterweight takes it. Source: Norton, Design of Machinery, ch. 13 and 14.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shared.contract.materials import MATERIALS
from shared.shapes.units import cubic_metres, mm

if TYPE_CHECKING:
    from mechanisms.stages.automatic.shafts.bodies.kinds import Link, LinkEye, Machine, Shaft
    from shared.shapes.solid import Solid

SLIDES = 0.5
"""The part of what slides that counterweights balance."""


@dataclass(frozen=True)
class Load:
    """A mass (kg) that turns with a shaft, at a place from its axis (mm)."""

    mass: float
    x: float
    y: float
    z: float


def loads(machine: Machine, shaft: Shaft, made: Mapping[str, Sequence[Solid]]) -> list[Load]:
    """One for each link on the shaft; masses are those that the model gives, else those of the solids in ``made``."""
    on_pins = []
    for throw in shaft.throws:
        link = machine.links.get(throw.link)
        if link is not None:
            on = next(eye for eye in link.eyes if eye.joint == throw.joint)
            mass = _on_pin(machine, link, on, made)
            on_pins.append(Load(mass, throw.x - shaft.axis[0], throw.y - shaft.axis[1], throw.z))
    return on_pins


def _on_pin(machine: Machine, link: Link, on: LinkEye, made: Mapping[str, Sequence[Solid]]) -> float:
    """Mass on a pin (kg): of a link, of the piston that it drives, and of rods on it that drive others."""
    mass, com = _mass(machine, link.body, made)
    others = [eye for eye in link.eyes if eye is not on and math.hypot(eye.x - on.x, eye.y - on.y) > 0]
    far = next((eye for eye in others if eye.on in machine.pistons), None) or max(
        others, key=lambda eye: math.hypot(eye.x - on.x, eye.y - on.y), default=None
    )
    if far is None:
        return mass
    u, v = far.x - on.x, far.y - on.y
    part = min(1.0, max(0.0, ((com[0] - on.x) * u + (com[1] - on.y) * v) / (u * u + v * v)))
    share = mass * (1 - part)
    if far.on in machine.pistons:
        share += SLIDES * (mass * part + _mass(machine, far.on, made)[0])
    for eye in others:
        rod = machine.links.get(eye.on)
        if rod is not None and any(end.on in machine.pistons for end in rod.eyes):
            share += _on_pin(machine, rod, next(end for end in rod.eyes if end.joint == eye.joint), made)
    return share


def _mass(machine: Machine, body: str, made: Mapping[str, Sequence[Solid]]) -> tuple[float, tuple[float, float]]:
    """Mass (kg) and centre of mass (mm) of a body."""
    given = machine.m.bodies[body]
    if given.mass_given:
        return given.mass, (mm(given.com[0]), mm(given.com[1]))
    total, x, y = 0.0, 0.0, 0.0
    for solid in made.get(body, ()):
        shape = solid.shape.val()
        mass, centre = MATERIALS[solid.material].density * cubic_metres(shape.Volume()), shape.Center()
        total, x, y = total + mass, x + mass * centre.x, y + mass * centre.y
    return total, ((x / total, y / total) if total else (0.0, 0.0))
