"""A dead-beat escapement after Graham: each swing of a pendulum lets a wheel go on by half a tooth, which pushes it.
Teeth rest on arcs about the pendulum's pivot, where they only slide, and push on the slanted ends of the pallets."""

from cmath import rect
from dataclasses import dataclass
from math import acos, cos, pi, sqrt, tan

from mbsd import Mechanism

DURATION = 8.0
LOCK, DROP, ARC, LENGTH, AIR = 0.03, 0.035, 0.36, 0.22, 1.5e-3


@dataclass(frozen=True)
class Params:
    """Teeth, teeth between the pallets, radius of tips (m), lift (rad), bob (kg), torque (N m)."""

    teeth: int = 15
    between: int = 3
    radius: float = 0.05
    lift: float = 0.09
    bob: float = 0.3
    torque: float = 1.2e-3

    @property
    def far(self) -> float:
        """From the pivot to the wheel's axle (m), so that teeth pass the pallets along the pivot's radii."""
        return self.radius / cos(pi * (self.between + 0.5) / self.teeth)


def pallet(p: Params, side: int) -> list[complex]:
    """Return x + iy about the pivot: the entry (side -1) locks on its outer arc, the exit (1) on its inner one."""
    half, corners = pi / p.teeth, []
    reaches = [p.between * half + DROP / 2, (p.between + 1) * half - DROP / 2][::side]
    for reach, turn in zip(reaches, (p.lift - LOCK, -p.lift - LOCK), strict=True):
        r = sqrt(p.radius**2 + p.far**2 - 2 * p.radius * p.far * cos(reach))
        corners.append((r, pi / 2 + side * (acos((r * r + p.far**2 - p.radius**2) / (2 * r * p.far)) + turn / 2)))
    (locks, at), (leaves, last) = corners
    return [rect(locks, at + side * ARC), rect(locks, at), rect(leaves, last), rect(leaves, at + side * ARC)]


def build(p: Params) -> Mechanism:
    """The wheel is above the pivot and turns clockwise; a tooth falls on the entry pallet at the start."""
    m, boss = Mechanism("escapement", gravity=(0, -9.81)), 0.26 * p.radius
    wheel, pendulum = m.body("wheel", 0.05, inertia=4e-5), m.body("pendulum", p.bob, (0, -LENGTH), 4e-4)
    m.revolute("axle", m.ground.at(0, p.far), wheel.origin)
    m.revolute("pivot", m.ground.at(0, 0), pendulum.origin)
    tooth = [(k + part, r) for k in range(p.teeth) for part, r in ((0.12, 0.8), (0.0, 1.0), (0.45, 0.8))]
    m.outline(wheel, [(z.real, z.imag) for z in (rect(p.radius * r, 2 * pi * k / p.teeth) for k, r in tooth)])
    entry, leaving = pallet(p, -1), pallet(p, 1)
    inner = 0.75 * entry[3] + 0.25 * entry[2], 0.8j * boss, 0.75 * leaving[0] + 0.25 * leaving[1]
    arms = [boss, entry[0], *inner, leaving[3]]
    m.outline(pendulum, [(-boss, 0, 1.0), *((z.real, z.imag) for z in arms)], name="anchor")
    for side, name, (end, *rest) in ((-1, "entry", entry), (1, "exit", leaving)):
        m.outline(pendulum, [(end.real, end.imag, -side * tan(ARC / 4)), *((z.real, z.imag) for z in rest)], name=name)
        m.outline_contact(f"{name}_beat", wheel, name)
    m.torque("weight", wheel, -p.torque)
    m.torsion_spring("air", m.ground, pendulum, 0.0, damping=AIR)
    m.start_near(wheel=-90 + 180 / p.teeth * (p.between + 1), pendulum=6)
    return m
