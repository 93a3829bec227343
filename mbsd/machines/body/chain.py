"""The chain of a lifter: foot, shank, thigh and trunk, their joints, the barbell, one repetition.

Angles of joints are counted as in anatomy, 0 in standing:

    hip flexion = pi - (trunk - thigh)      knee flexion = thigh - shank      dorsiflexion = -pi/2 - shank - foot

where trunk, thigh, shank and foot are the angles of the bodies (rad), the lifter facing right. The moments extend these
joints: positive ones stretch hip and knee and press the toes down. Guides are drivers that make the motion; they give
nothing, because :func:`mbsd.machines.body.lift.lifted` finds the moments that make the same motion.

A repetition goes up, pauses, goes down, pauses, again and again. Each way has the least jerk from rest to rest:

    f = bottom + (top - bottom) s(u),  s = 10 u^3 - 15 u^4 + 6 u^5,  u = (t - begin) / duration

Source: T. Flash, N. Hogan, J. Neurosci. 5 (1985) 1688.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.quantity import counted
from mbsd.machines.body.figure import Figure, MassProperties, combined
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body
from mbsd.model.laws import Motion
from mbsd.model.laws.function import function

MOMENTS = ("hip_extensors", "knee_extensors", "plantarflexors", "shoulder_extensors")
"""Torques at the joints, by the muscles that give them where they are positive."""
PLATE = 0.225
"""Radius of the usual plates of a barbell (m)."""
BAR_INERTIA = 0.4 * PLATE**2
"""Inertia of a loaded barbell, by its mass (m^2). It does not turn: its plates hang on sleeves."""


@dataclass(frozen=True)
class Lifter:
    """The bodies of a figure in a mechanism."""

    figure: Figure
    foot: Body
    shank: Body
    thigh: Body
    trunk: Body


def add_lifter(m: Mechanism, figure: Figure, arms: MassProperties | None) -> Lifter:
    """Add foot, shank, thigh and trunk, joined, with moments at the joints.

    ``arms`` are fixed to the trunk.
    """
    trunk = figure.limb("trunk")
    if arms is not None:
        trunk = combined((trunk, arms))
    foot = add_body(m, "foot", figure.foot())
    shank = add_body(m, "shank", figure.limb("shank"), figure.length("shank"))
    thigh = add_body(m, "thigh", figure.limb("thigh"), figure.length("thigh"))
    body = add_body(m, "trunk", trunk, figure.length("trunk"))
    m.revolute("ankle", foot.origin, shank.end)
    m.revolute("knee", thigh.end, shank.start)
    m.revolute("hip", thigh.start, body.start)
    m.torque("hip_extensors", body, 0.0, against=thigh)
    m.torque("knee_extensors", shank, 0.0, against=thigh)
    m.torque("plantarflexors", shank, 0.0, against=foot)
    return Lifter(figure, foot, shank, thigh, body)


def add_body(m: Mechanism, name: str, given: MassProperties, length: float | None = None) -> Body:
    """Return a body with these mass properties; a bar where it has a length (m)."""
    if length is None:
        return m.body(name, given.mass, given.com, given.inertia)
    return m.bar(name, length, given.mass, given.com, given.inertia)


def add_barbell(m: Mechanism, load: float, carrier: Body, x: float, y: float) -> Body:
    """Return a barbell of ``load`` (kg) on the body ``carrier`` at (x, y) of its frame (m).

    Its middle is traced.
    """
    mass = not_below(m.name, "load", load, 0.0, "kg")
    barbell = m.body("barbell", mass, (0.0, 0.0), mass * BAR_INERTIA)
    m.revolute("bar", carrier.at(x, y), barbell.origin)
    m.angle_lock("sleeves", m.ground.origin, barbell.origin)
    m.trace("bar", barbell.origin)
    return barbell


def not_below(mechanism: str, name: str, value: float, least: float, unit: str) -> float:
    """Return a finite number of at least ``least``. Raises ModelError."""
    number = finite_number(f"{mechanism}: {name}", value)
    if number < least:
        raise ModelError(f"{mechanism}: {name} is {number:g} {unit}; it must be {least:g} {unit} or more")
    return number


def ends_given(mechanism: str, name: str, ends: tuple[float, float], least: float, most: float) -> tuple[float, float]:
    """Return two angles given in DEGREES, as radians. Raises ModelError beyond ``least`` .. ``most``."""
    if len(ends) != 2:
        raise ModelError(
            f"{mechanism}: {name} has {counted(len(ends), 'value')}; give degrees at the bottom and at the top"
        )
    for place, degrees in zip(("bottom", "top"), ends, strict=True):
        number = finite_number(f"{mechanism}: {name} at the {place}", degrees)
        if not least <= number <= most:
            raise ModelError(
                f"{mechanism}: {name} is {number:g} degrees at the {place}; it must be from {least:g} to {most:g}"
            )
    return math.radians(ends[0]), math.radians(ends[1])


@dataclass(frozen=True)
class Tempo:
    """How long each phase lasts (s): up from the bottom, at the top, down, at the bottom."""

    up: float = 1.0
    hold: float = 0.5
    down: float = 1.5
    rest: float = 0.5

    def __post_init__(self) -> None:
        for name in ("up", "hold", "down", "rest"):
            number = finite_number(f"tempo: {name}", getattr(self, name))
            if number < 0 or (number == 0 and name in ("up", "down")):
                raise ModelError(
                    f"tempo: {name} is {number:g} s; a phase that moves takes time, a pause has none below 0"
                )

    @property
    def period(self) -> float:
        """Duration of a whole repetition (s)."""
        return self.up + self.hold + self.down + self.rest

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times (s) at which a phase begins, within a repetition."""
        return self.up, self.up + self.hold, self.up + self.hold + self.down

    def part(self, time: float) -> tuple[float, float, float]:
        """Return the part of the rise at a time (s), its rate (1/s) and acceleration (1/s^2)."""
        t = time % self.period
        _, begin, end = self.breaks
        if t >= end:
            return 0.0, 0.0, 0.0
        if t >= begin:
            s, ds, dds = _least_jerk((t - begin) / self.down)
            return 1.0 - s, -ds / self.down, -dds / self.down**2
        s, ds, dds = _least_jerk(min(t / self.up, 1.0))
        return s, ds / self.up, dds / self.up**2


def repetition(bottom: float, top: float, tempo: Tempo) -> Motion:
    """Return the law (rad or m) of a repetition that begins at the bottom.

    It is constant if both ends are the same.
    """
    way = top - bottom
    if way == 0.0:
        from mbsd.model.laws.formulas import polynomial

        return polynomial(bottom)
    return function(
        lambda t: bottom + way * tempo.part(t)[0],
        lambda t: way * tempo.part(t)[1],
        lambda t: way * tempo.part(t)[2],
        period=tempo.period,
        breaks=tempo.breaks,
        shortest=min(tempo.up, tempo.down),
    )


def _least_jerk(u: float) -> tuple[float, float, float]:
    return (
        u**3 * (10.0 + u * (-15.0 + 6.0 * u)),
        30.0 * u**2 * (1.0 - u) ** 2,
        60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
    )
