"""Socket head cap screws, after ISO 4762, without threads."""

from __future__ import annotations

import math

import cadquery as cq

from shared.shapes.build import turned
from shared.shapes.once import built_once

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
        [
            (0, -length),
            (r - c, -length),
            (r, -length + c),
            (r, 0),
            (edge, 0),
            (edge, k - c),
            (edge - c, k),
            (0, k),
        ]
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
