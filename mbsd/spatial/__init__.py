"""Mechanisms in space: bodies with six freedoms, joints by places and axes, driven motions.

    from mbsd.spatial import Mechanism, constant_rate

Numbers in SI, angles in radians, right-handed. Nothing planar imports this package; docs/space.md shows it.
"""

from __future__ import annotations

from mbsd.model.laws import constant_rate, cycloidal, function, harmonic, polynomial, recorded, table
from mbsd.spatial.mechanism import Body, Joint, Marker, Mechanism

__all__ = [
    "Body",
    "Joint",
    "Marker",
    "Mechanism",
    "constant_rate",
    "cycloidal",
    "function",
    "harmonic",
    "polynomial",
    "recorded",
    "table",
]
