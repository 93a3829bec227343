"""Estimates masses of bodies that have none yet: each counts as a uniform aluminium plate through its markers.

    outline       convex hull of discs of radius r about the markers: a disc, a bar with round ends, or a plate
    r             the wheel's radius where a joint rolls there; else 0.06 L; 0.12 L where there is one marker alone
    thickness h   0.05 L;  L: the largest distance between two markers of one body, ground included
    mass          rho h A;  centre of mass and second moments of the polygon by Green's theorem

A 120 mm linkage gets bars of 14 x 6 mm, about what its parts become.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from shared.contract.materials import MATERIALS

if TYPE_CHECKING:
    from mbsd import Marker, Mechanism

HALF_WIDTH, THICKNESS = 0.06, 0.05
"""Half width and thickness of a bar, as parts of L."""
LEAST_SIZE = 0.1
"""L (m) where no body has two markers apart."""
CORNERS = 96
"""Corners of the polygon that stands for a disc."""


@dataclass(frozen=True)
class Estimate:
    """kg, centre of mass (m, body frame), inertia about it (kg m^2)."""

    mass: float
    com: tuple[float, float]
    inertia: float


def estimated_masses(m: Mechanism) -> dict[str, Estimate]:
    """What each moving body would weigh, by name, whatever mass it has."""
    discs: dict[str, list[tuple[float, float, float]]] = {name: [] for name in m.bodies}
    for marker, radius in _discs(m):
        discs[marker.body.name].append((marker.x, marker.y, radius))
    for name, body in m.bodies.items():
        if body.length is not None:
            discs[name] += [(0.0, 0.0, 0.0), (body.length, 0.0, 0.0)]
    size = max((_extent(disc) for disc in discs.values()), default=0.0) or LEAST_SIZE
    return {name: _plate(disc, size) for name, disc in discs.items() if name != "ground"}


def _discs(m: Mechanism) -> Iterator[tuple[Marker, float]]:
    """Every marker that is used, with the radius of the wheel about it (m), or 0."""
    from mbsd.model.force import ForceKind
    from mbsd.model.teeth import with_radii

    for joint in chain(m.joints.values(), m.drivers.values(), m.contacts.values(), m.forces.values()):
        params = with_radii(joint.params)
        rolls = not isinstance(joint.kind, ForceKind) or joint.kind.surface is not None
        wheel = params.get("radius", 0.0) if rolls and "slots" not in params else 0.0
        yield joint.i, float(params.get("radius_i", 0.0))
        yield joint.j, float(params.get("radius_j", wheel))
    for marker in m.traces.values():
        yield marker, 0.0


def _extent(discs: list[tuple[float, float, float]]) -> float:
    places = np.array([disc[:2] for disc in discs]).reshape(-1, 2)
    if not len(places):
        return 0.0
    return float(np.hypot(*(places[:, None] - places).transpose(2, 0, 1)).max())


def _plate(discs: list[tuple[float, float, float]], size: float) -> Estimate:
    from scipy.spatial import ConvexHull

    places = discs or [(0.0, 0.0, 0.0)]
    alone = len({disc[:2] for disc in places}) == 1
    least = size * HALF_WIDTH * (2.0 if alone else 1.0)
    turn = 2 * np.pi * np.arange(CORNERS) / CORNERS
    rim = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = np.concatenate([np.array([x, y]) + max(radius, least) * rim for x, y, radius in places])
    outline = points[ConvexHull(points).vertices]  # counter-clockwise
    ahead = np.roll(outline, -1, axis=0)
    cross = outline[:, 0] * ahead[:, 1] - outline[:, 1] * ahead[:, 0]
    area = float(cross.sum() / 2)
    com = (cross[:, None] * (outline + ahead)).sum(axis=0) / (6 * area)
    about_origin = float((cross * ((outline * outline) + outline * ahead + ahead * ahead).sum(axis=1)).sum() / 12)
    surface = MATERIALS["aluminium"].density * THICKNESS * size
    return Estimate(surface * area, (float(com[0]), float(com[1])), surface * (about_origin - area * float(com @ com)))
