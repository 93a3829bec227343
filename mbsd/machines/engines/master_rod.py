"""Master rods: one rod of a throw runs on the crank pin, the others on knuckle pins round its big end.

    P = r e^(i p)                                  the crank pin; p: direction of the throw
    K = P + k e^(i (g + a)),  g = b_m - asin((r / l) sin(p - b_m))       g: direction of the master rod, b_m its bank
    s = Re(K e^(-i b)) + sqrt((l - k)^2 - Im(K e^(-i b))^2)              the piston from the shaft along its bank b

with the rod l from crank pin to wrist pin, the knuckle radius k and the knuckle's angle a from the master rod. The
master rod leans while the crank turns, so K goes round in an oval: articulated pistons have strokes of their own, a
little longer than 2 r, and dead centres a few degrees beside those of the layout. The free forces by formula are those
of rods on one pin; the knuckle pins add, above all, a second order that turns with the shaft, which the solver tells.

Source: Biezeno, Grammel, Technische Dynamik, ch. XII (articulated rods).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.base.quantity import counted
from mbsd.machines.engines.layout import SAME, Layout, cylinders_by_throw
from mbsd.model.cylinders.piston_motion import ArticulatedMotion

UPRIGHT = 0.5 * math.pi
AROUND = 0.56
"""Knuckle radius, in bores, where none is given: so that an eye is beside the big end."""
WAYS = ("master", "pin")


@dataclass(frozen=True)
class MasterRod:
    """The knuckle pins of each master rod.

    ``radius``: from the crank pin to the knuckle pins (m, 0.56 bores by default). ``angles``: of the knuckle pins from
    the master rod, counter-clockwise (DEGREES), one for each other rod of a throw in the order of the cylinders; by
    default those between the banks. ``cylinder``: which of the cylinders of a throw has the master rod, from 1.
    ``ring_mass``: what the master rod's big end weighs more than that of the other rods (kg), a ring of that radius.
    """

    radius: float | None = None
    angles: Sequence[float] | None = None
    cylinder: int = 1
    ring_mass: float = 0.0


class Ring(NamedTuple):
    """A ring about the pin of a rod: mass (kg) and radius (m)."""

    mass: float
    radius: float


NO_RING = Ring(0.0, 0.0)


@dataclass(frozen=True)
class Knuckle:
    """Where an articulated rod hangs, and how its piston moves."""

    master: int
    """Index of the master rod's cylinder."""
    radius: float
    """m"""
    angle: float
    """Angle from the master rod (rad)."""
    motion: ArticulatedMotion
    late: float
    """Turn of the shaft from the top dead centre of the layout to that of the piston (rad)."""

    def rod_starts(self, master: float, pin: complex, axis: float) -> float:
        """Return the rod's direction (rad) from the master rod's, the crank pin (m), the cylinder's axis."""
        side = ((pin + self.radius * cmath.exp(1j * (master + self.angle))) * cmath.exp(-1j * axis)).imag
        return axis - math.asin(side / self.motion.rod)


def knuckles(
    plan: Layout, name: str, rods: str | MasterRod | None, throw: float, rod: float, bore: float
) -> tuple[MasterRod | None, dict[int, Knuckle]]:
    """Return the knuckle pins by index of their cylinder.

    ``rods`` None: of radial engines alone. Raises ModelError.
    """
    if isinstance(rods, str) and rods not in WAYS:
        raise ModelError(f"engine '{name}': rods '{rods}'; they are 'master', 'pin' or MasterRod(...)")
    if rods == "pin" or (rods is None and not is_radial(plan)):
        return None, {}
    own = rods if isinstance(rods, MasterRod) else MasterRod()
    radius = AROUND * bore if own.radius is None else own.radius
    radius = positive_number(f"engine '{name}': radius of the knuckle pins", radius, "m")
    if radius >= rod - throw:
        raise ModelError(
            f"engine '{name}': the knuckle pins are {1000 * radius:g} mm from the crank pin. Rods of "
            f"{1000 * rod:g} mm on a throw of {1000 * throw:g} mm leave less than {1000 * (rod - throw):g} mm; make "
            "radius smaller or rod longer"
        )
    groups = [group for group in cylinders_by_throw(plan) if len(group) > 1]
    if not groups:
        raise ModelError(f"engine '{name}': rods 'master', but no throw has two rods; leave it out")
    knuckle_of: dict[int, Knuckle] = {}
    for group in groups:
        knuckle_of |= _of_throw(plan, name, own, group, throw, rod, radius)
    return own, knuckle_of


def ring_of(name: str, own: MasterRod, hung: Mapping[int, Knuckle], rod_mass: float | None) -> Ring:
    """Return the ring of each master rod. Raises ModelError."""
    mass = not_negative_number(f"engine '{name}': ring_mass of a master rod", own.ring_mass, "kg")
    if mass and rod_mass is None:
        raise ModelError(f"engine '{name}': ring_mass without rod_mass; give both, or neither")
    return Ring(mass, next(iter(hung.values())).radius)


def is_radial(plan: Layout) -> bool:
    """True if the cylinders stand all round one throw: no half turn is without one."""
    if len(cylinders_by_throw(plan)) > 1 or len(plan.cylinders) < 3:
        return False
    banks = np.sort(plan.banks % (2 * math.pi))
    return bool(np.diff(np.append(banks, banks[0] + 2 * math.pi)).max() < math.pi - SAME)


def _of_throw(
    plan: Layout, name: str, own: MasterRod, group: list[int], throw: float, rod: float, radius: float
) -> dict[int, Knuckle]:
    if not (isinstance(own.cylinder, int) and 1 <= own.cylinder <= len(group)):
        raise ModelError(
            f"engine '{name}': cylinder {own.cylinder} of a throw has the master rod, and a throw has {len(group)}; "
            f"give a number from 1 to {len(group)}"
        )
    master = group[own.cylinder - 1]
    others = [k for k in group if k != master]
    banks = {k: plan.cylinders[k].bank - plan.cylinders[master].bank for k in others}
    if own.angles is None:
        angles = list(banks.values())
    else:
        if len(own.angles) != len(others):
            raise ModelError(
                f"engine '{name}': {counted(len(own.angles), 'angle')} for knuckle pins; a master rod here carries "
                f"{counted(len(others), 'other rod')}, so give as many"
            )
        what = f"engine '{name}': angle of the knuckle pin of cylinder"
        angles = [math.radians(finite_number(f"{what} {k + 1}", a)) for k, a in zip(others, own.angles, strict=True)]
    knuckle_of: dict[int, Knuckle] = {}
    for k, angle in zip(others, angles, strict=True):
        for other, earlier in knuckle_of.items():
            if abs(math.remainder(angle - earlier.angle, 2 * math.pi)) < SAME:
                raise ModelError(
                    f"engine '{name}': the knuckle pins of cylinders {other + 1} and {k + 1} are in one place, "
                    f"{math.degrees(angle):g} degrees from the master rod; give MasterRod(angles=...) others"
                )
        knuckle = radius * math.cos(angle), radius * math.sin(angle)
        motion = ArticulatedMotion(throw, rod, 0.0, knuckle, banks[k], rod - radius, 0.0)
        if not motion.turns:
            raise ModelError(
                f"engine '{name}': the rod of cylinder {k + 1}, {1000 * motion.rod:g} mm from a knuckle pin "
                f"{math.degrees(angle):g} degrees from the master rod, does not let the shaft go round. Its bank is "
                f"{math.degrees(banks[k]):g} degrees from the master's: turn the knuckle pin there, or make radius "
                "smaller"
            )
        # The motion counts the throw from where it points away from the master's head.
        late = math.remainder(motion.top + math.pi - banks[k], 2 * math.pi)
        knuckle_of[k] = Knuckle(master, radius, angle, motion, late)
    return knuckle_of
