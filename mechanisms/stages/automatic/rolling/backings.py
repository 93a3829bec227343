"""What lies behind the surface of a road: matter down to a straight lower side, or a band along it where that would
cross the surface, itself or the way of what runs on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cadquery as cq
import numpy as np
from manifold3d import CrossSection, FillRule, OpType

from mechanisms.stages.automatic.layout.planar import convex_hull
from mechanisms.stages.automatic.layout.profiles import area
from shared.shapes.build import extruded
from shared.shapes.polyline import distances, simplified

THICK = 10.0
"""Thickness of a road under its surface, of a band, and of a wall (rmm)."""
CHORD = 0.006
"""How far the facets of a surface may stray from it (rmm)."""
PIECES = 48
"""Pieces of a road in the plane."""
LONGEST = 2.0
"""Mitre at a sharp corner, in the thickness."""
SAME = 1e-6
"""Two areas of a polygon that differ by less, as a part of them, are one."""


@dataclass(frozen=True, eq=False)
class Band:
    """Matter of even thickness on the right of a surface (rmm): its borders, and convex pieces that cover it."""

    border: np.ndarray
    """(n, 2) counter-clockwise."""
    holes: Sequence[np.ndarray]
    pieces: Sequence[np.ndarray]
    back: np.ndarray
    """(k, 2) the other side, from behind the first place of the surface to behind the last."""

    def wall(self, low: float, high: float) -> cq.Workplane:
        """From one height to another."""
        return extruded(polygon(self.border), high - low, low, [polygon(hole) for hole in self.holes])


def straight_back(path: np.ndarray, thick: float = THICK) -> np.ndarray:
    """(2, 2) corners of a straight lower side, behind the last place of a surface and behind the first."""
    under = behind(path[-1] - path[0])
    lowest = float((path @ under).max()) + thick
    return np.array([path[k] + (lowest - path[k] @ under) * under for k in (-1, 0)])


def is_simple(path: np.ndarray, feet: np.ndarray) -> bool:
    """Whether the polygon of a surface and its lower corners crosses itself nowhere: then its signed area is that of
    what it goes round.
    """
    corners = np.vstack([simplified(path, CHORD), feet])
    signed = abs(area(corners)) / 2
    return abs(CrossSection([corners], FillRule.EvenOdd).area() - signed) < SAME * signed


def is_free(path: np.ndarray, feet: np.ndarray, centres: np.ndarray, radius: float) -> bool:
    """Whether the polygon of a surface and its lower corners crosses itself nowhere, and what runs on the surface, a
    disc about ``centres`` (T, 2), is clear of its other sides.
    """
    others = np.vstack([path[-1:], feet, path[:1]])
    return is_simple(path, feet) and bool(distances(centres, others).min() >= radius)


def is_clear(backing: Band, path: np.ndarray, centres: np.ndarray, radius: float) -> bool:
    """Whether a disc about ``centres`` (T, 2) that runs on a surface is clear of the other sides of the band there."""
    return bool(distances(centres, np.vstack([path[-1:], backing.back[::-1], path[:1]])).min() >= radius)


def band(path: np.ndarray, thick: float = THICK) -> Band | None:
    """Behind a surface; None where that is in several parts."""
    surface = simplified(path, CHORD)
    back = surface - thick * _mitres(surface)
    quads = [
        convex_hull(np.array([*front, *rear])) for front, rear in zip(pairwise(surface), pairwise(back), strict=True)
    ]
    loops = CrossSection.batch_boolean([CrossSection([quad]) for quad in quads], OpType.Add).to_polygons()
    outer = [corners for corners in loops if area(corners) > 0]
    if len(outer) != 1:
        return None
    few = max(1, len(quads) // PIECES)
    pieces = [convex_hull(np.vstack(quads[k : k + few])) for k in range(0, len(quads), few)]
    return Band(outer[0], [corners for corners in loops if area(corners) < 0], pieces, back)


def polygon(corners: np.ndarray) -> cq.Wire:
    """A closed one, at z = 0."""
    return cq.Wire.makePolygon([cq.Vector(float(x), float(y), 0.0) for x, y in corners], close=True)


def _mitres(path: np.ndarray) -> np.ndarray:
    """(n, 2) from a polyline's places to those at a unit distance on its left, at corners as far as LONGEST."""
    way = np.diff(path, axis=0)
    way /= np.hypot(*way.T)[:, None]
    left = np.column_stack([-way[:, 1], way[:, 0]])
    before, after = np.vstack([left[:1], left]), np.vstack([left, left[-1:]])
    cosine = (before * after).sum(axis=1)[:, None]
    return (before + after) / np.maximum(1.0 + cosine, 2.0 / LONGEST)


def behind(way: np.ndarray) -> np.ndarray:
    """(2,) the unit vector to the right of a way."""
    return np.array([way[1], -way[0]]) / np.hypot(*way)
