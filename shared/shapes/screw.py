"""Socket head cap screws, after ISO 4762 and without threads, and ball studs of springs and dampers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cadquery as cq

from shared.shapes.build import built_once, turned

# Socket head cap screws, after ISO 4762, without threads.


SOCKET = {1.6: 1.5, 2: 1.5, 2.5: 2.0, 3: 2.5, 4: 3.0, 5: 4.0, 6: 5.0, 8: 6.0}
SOCKET |= {10: 8.0, 12: 10.0, 16: 14.0, 20: 17.0, 24: 19.0}
"""Nominal diameter (mm) to width of the hexagon socket."""


def head_diameter(nominal: float) -> float:
    """Return the diameter of the head (mm)."""
    return {1.6: 3.0, 2: 3.8, 2.5: 4.5, 3: 5.5}.get(nominal, 1.5 * nominal + (1.0 if nominal < 12 else 0.0))


@built_once
def socket_screw(nominal: float, length: float) -> cq.Workplane:
    """Return a screw from z = -length, its head from z = 0 to z = nominal. No through hole.

    Raises ValueError for a size that is not in :data:`SOCKET`.
    """
    if nominal not in SOCKET:
        raise ValueError(f"no socket screw M{nominal:g}; there is M{', M'.join(f'{size:g}' for size in SOCKET)}")
    r, edge, k = nominal / 2, head_diameter(nominal) / 2, float(nominal)
    c = 0.12 * nominal
    body = turned(
        [(0, -length), (r - c, -length), (r, -length + c), (r, 0), (edge, 0), (edge, k - c), (edge - c, k), (0, k)]
    )
    hexagon = SOCKET[nominal]
    socket = cq.Workplane(origin=(0, 0, k / 2)).polygon(6, hexagon / math.cos(math.pi / 6)).extrude(k)
    mouth = turned(
        [
            (0, k - 0.1 * k),
            (hexagon / 2 - 0.02 * k, k - 0.1 * k),
            (hexagon / 2 + 0.2 * k, k + 0.12 * k),
            (0, k + 0.12 * k),
        ]
    )
    return body.cut(socket).cut(mouth)


# Ball studs, which carry the eyes of springs and dampers.


TIP, FLAT = 0.35, 0.06
"""Radii of the flat on a stud's last ball, and on a loose one, in that of the ball."""


@dataclass(frozen=True)
class Collar:
    """A ring on the shank (mm): from z up by ``height``."""

    z: float
    height: float
    radius: float


def ball_stud(
    shank: float, start: float, end: float, balls: Sequence[float], ball: float, collars: Sequence[Collar] = ()
) -> cq.Workplane:
    """Return a stud on the z axis from ``start`` to ``end`` (mm) with balls along it.

    Balls have the radius ``ball``.

    ``shank`` is its diameter. A ball at an end of the shank ends the stud, with a small flat. No through hole. Raises
    ValueError if balls and collars overlap.
    """
    r = shank / 2
    half, flat = math.sqrt(ball**2 - r**2), TIP * ball
    rise = math.sqrt(ball**2 - flat**2)
    swells: list[tuple[float, float, list[tuple[float, ...]]]] = []
    for z in balls:
        low = [(0.0, z - rise), (flat, z - rise)] if z <= start else [(r, z - half)]
        high = [(flat, z + rise), (0.0, z + rise)] if z >= end else [(r, z + half)]
        profile = [*low, (ball, z, *high[0]), *high[1:]]
        swells.append((low[0][1], high[-1][1], profile))
    for collar in collars:
        z0, z1, w = collar.z, collar.z + collar.height, collar.radius
        profile = [(r, z0), (w - 0.3, z0), (w, z0 + 0.3), (w, z1 - 0.3), (w - 0.3, z1), (r, z1)]
        if z0 <= start:
            profile[0] = (0.0, z0)
        swells.append((z0, z1, profile))
    swells.sort(key=lambda swell: swell[0])
    for (_, high, _), (low, _, _) in pairwise(swells):
        if low < high:
            raise ValueError(f"a stud's balls and collars overlap between {low:g} and {high:g} mm; move them apart")
    points: list[tuple[float, ...]] = []
    if not swells or swells[0][0] > start:
        points += [(0.0, start), (r - 0.3, start), (r, start + 0.3)]
    for _, _, profile in swells:
        points += profile
    if points[-1][0] > 0:
        points += [(r, end - 0.3), (r - 0.3, end), (0.0, end)]
    return turned(points)


def ball(radius: float) -> cq.Workplane:
    """Return a ball about the origin (mm).

    Its poles have small flats, since a mesh may tear at an apex.
    """
    flat, rise = FLAT * radius, radius * math.sqrt(1 - FLAT**2)
    return turned([(0.0, -rise), (flat, -rise), (radius, 0.0, flat, rise), (0.0, rise)])
