"""The shaft of an engine as one body: its throws, counterweights and flywheel.

U_k = r [m_throw + m_ring + N_k (m_r (1 - s) + f (m_p + m_r s))]         what balances throw k, see engine.py
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.machines.engines.layout import Layout, cylinders_by_throw
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body

UPRIGHT = 0.5 * math.pi


class ShaftMasses(NamedTuple):
    """Masses that turn and swing on each throw (kg)."""

    piston: float | None
    rod: float | None
    end: float
    """Place of a rod's centre of mass from the crank pin, in parts of its length."""
    throw: float
    ring: float
    """Mass of the ring of a master rod, which other rods have not."""


def crank_sizes(name: str, bore: float, stroke: float, rod: float) -> tuple[float, float, float]:
    """Return bore, throw and rod (m) of an engine whose shaft can turn. Raises ModelError."""
    given = {"bore": bore, "stroke": stroke, "rod": rod}
    bore, stroke, rod = (positive_number(f"engine '{name}': {key}", value, "m") for key, value in given.items())
    throw = 0.5 * stroke
    if rod <= throw:
        raise ModelError(
            f"engine '{name}': the rod of {1000 * rod:g} mm is no longer than the throw of {1000 * throw:g} mm (half "
            f"the stroke), so the shaft cannot turn. Rods have 1.5 to 2 strokes, here {1500 * stroke:g} mm or more"
        )
    return bore, throw, rod


def shaft_masses(
    name: str, piston_mass: float | None, rod_mass: float | None, rod_com: float, throw_mass: float
) -> ShaftMasses:
    """Return the masses on each throw, without the ring of a master rod. Raises ModelError."""
    if (piston_mass is None) != (rod_mass is None):
        raise ModelError(f"engine '{name}': give both piston_mass and rod_mass, or neither")
    end = finite_number(f"engine '{name}': rod_com", rod_com)
    if not 0.0 <= end <= 1.0:
        raise ModelError(f"engine '{name}': rod_com is {end:g}; it must be from 0, at the crank pin, to 1")
    return ShaftMasses(piston_mass, rod_mass, end, throw_mass, 0.0)


def crankshaft(
    m: Mechanism,
    plan: Layout,
    z: np.ndarray,
    throw: float,
    share: float | None,
    masses: ShaftMasses,
    flywheel: float,
    body: str = "crank",
) -> Body:
    """Add the shaft ``body``; ``share`` None: no counterweights. Raises ModelError for negative masses."""
    piston, rod, end, throw_mass, ring = masses
    spin = not_negative_number(f"engine '{m.name}': flywheel", flywheel)
    heavy = not_negative_number(f"engine '{m.name}': throw_mass", throw_mass)
    if piston is None or rod is None:
        return m.body(body)
    piston = not_negative_number(f"engine '{m.name}': piston_mass", piston, "kg")
    rod = not_negative_number(f"engine '{m.name}': rod_mass", rod, "kg")
    points: list[tuple[float, float, float, float]] = []
    for direction, place, count in _throws(plan, z):
        outward = np.array([math.cos(UPRIGHT + direction), math.sin(UPRIGHT + direction)]) * throw
        opposite = 0.0
        if share is not None:
            opposite = heavy + (ring if count > 1 else 0.0) + count * (rod * (1 - end) + share * (piston + rod * end))
        points += [(heavy, *outward, place), (opposite, *-outward, place)]
    return _of_points(m, body, np.array(points), spin)


def _of_points(m: Mechanism, name: str, points: np.ndarray, spin: float) -> Body:
    """Return the body of point masses (n, 4) of m, x, y, z, and an inertia beside them.

    The inertia turns about the origin.
    """
    mass, at, z = points[:, 0], points[:, 1:3], points[:, 3]
    total = float(mass.sum())
    if total == 0.0:
        return m.body(name, mass=0.0, inertia=spin)
    com, middle = mass @ at / total, float(mass @ z) / total
    inertia = spin + float(mass @ ((at - com) ** 2).sum(axis=1))
    products = (mass * (z - middle)) @ (at - com)
    return m.body(name, total, com.tolist(), inertia, z=middle, products=products.tolist())


def _throws(plan: Layout, z: np.ndarray) -> list[tuple[float, float, int]]:
    """Return direction (rad), place (m) and number of rods of each throw."""
    return [(plan.cylinders[ks[0]].throw, float(z[ks].mean()), len(ks)) for ks in cylinders_by_throw(plan)]


def share_of(name: str, counterweight: str | float) -> float | None:
    """Return the part of the oscillating masses that counterweights balance; None if there are none."""
    words = {"auto": 0.5, "rotating": 0.0, "none": None}
    if isinstance(counterweight, str):
        if counterweight not in words:
            raise ModelError(
                f"engine '{name}': counterweight '{counterweight}'; it is 'auto', 'rotating', 'none' or a number"
            )
        return words[counterweight]
    return not_negative_number(f"engine '{name}': counterweight", counterweight)
