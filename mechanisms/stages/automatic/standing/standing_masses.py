"""How low the solids of a machine ever reach, and where their common centre of mass is (mm, kg), as it stands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.planar import convex_hull
from shared.contract.materials import MATERIALS
from shared.shapes.facets import facets
from shared.shapes.rough_box import rough_size

CHORD, ANGLE = 0.002, 0.4
"""Coarse meshes: largest distance from the surface, in edges, for each mm of the solid; largest angle (rad)."""

if TYPE_CHECKING:
    from mechanisms.stages.automatic.standing.back_plate import Upright
    from shared.shapes.solid import Solid


@dataclass(frozen=True)
class Hull:
    """Hull of one solid, in its body's frame: corners (n, 2) round it in the plane, its heights, mass and centre."""

    corners: np.ndarray
    heights: tuple[float, float]
    mass: float
    centre: np.ndarray

    @classmethod
    def of(cls, solid: Solid, shape: cq.Workplane | None = None) -> Hull:
        """Hull of its ``shape`` or one that is turned, by a coarse mesh."""
        whole = (solid.shape if shape is None else shape).solids()
        faces = facets(whole.vals()[0], CHORD * rough_size(whole), ANGLE, relative=True).astype(float)
        places = faces.reshape(-1, 3)
        parts = np.einsum("ij,ij->i", faces[:, 0], np.cross(faces[:, 1], faces[:, 2])) / 6
        centre = (parts[:, None] * faces.sum(axis=1)).sum(axis=0) / 4 / parts.sum()
        mass = MATERIALS[solid.material].density * 1e-9 * float(parts.sum())
        heights = float(places[:, 2].min()), float(places[:, 2].max())
        return cls(convex_hull(places[:, :2]), heights, mass, centre)


@dataclass(frozen=True)
class Standing:
    """All that a stand has to carry, over the motion."""

    low: np.ndarray
    """(3,) of the box round what is on ground and what moves: right, up, towards the viewer."""
    high: np.ndarray
    moving: float
    """How low anything that moves reaches; infinite where nothing does."""
    centres: np.ndarray
    """(T, 3) of the common centre of mass."""


def standing(bodies: Mapping[str, Sequence[Solid]], poses: Mapping[str, np.ndarray], upright: Upright) -> Standing:
    """Over the ``poses`` (T, 3) (mm, rad) of the bodies; of one without poses nothing is known."""
    still = np.zeros((1, 3))
    lows, highs, moving = [], [], np.inf
    mass, moment = 0.0, np.zeros((1, 3))
    for body, solids in bodies.items():
        if body != "ground" and body not in poses:
            continue
        hulls = [Hull.of(solid, upright.as_seen(solid.shape) if body == "ground" else None) for solid in solids]
        for own in hulls:
            path, turn = (still, None) if body == "ground" else (poses[body], upright)
            corners = np.array([_seen(corner, path, turn) for corner in own.corners])
            low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
            lows.append([*low, own.heights[0]])
            highs.append([*high, own.heights[1]])
            moving = moving if body == "ground" else min(moving, float(low[1]))
            there = _seen(own.centre[:2], path, turn)
            moment = moment + own.mass * np.column_stack([there, np.full(len(there), own.centre[2])])
            mass += own.mass
    return Standing(np.min(lows, axis=0), np.max(highs, axis=0), moving, moment / mass)


def _seen(place: np.ndarray, poses: np.ndarray, upright: Upright | None) -> np.ndarray:
    """(T, 2) a place of a body's frame over its poses (T, 3), as right and up; without a turn as it is."""
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    x = poses[:, 0] + c * place[0] - s * place[1]
    y = poses[:, 1] + s * place[0] + c * place[1]
    return np.column_stack([x, y]) if upright is None else upright.seen(np.column_stack([x, y]))
