"""Loads of a page: arrows, torques, and gaps of contacts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from render.film.arrows import FULL, FULL_TURN, SIGNAL, Arcs, Arrows
from render.film.film import Film, torques_of, vectors_of
from render.film.heights import Heights
from render.film.poses import Moment
from render.film.solids import read_triangles
from render.film.space import SpaceHeights, Turning
from render.film.vectors import LONGEST, TINY, Scale, rounding
from shared.contract import AnyMotion
from shared.contract.clearance import Clearance
from shared.contract.quantity import written
from shared.contract.quaternions import matrices
from shared.contract.shot import Quantity

# Where two pieces come nearest: the middle of the gap, from points all over both surfaces.

Array = NDArray[np.float64]
MOST = 12
"""Pairs whose place is looked for: the nearest ones."""
FINE = 250
"""Points are at most the larger piece's size apart, divided by this, as long as there are no more than POINTS."""
POINTS = 80_000


@dataclass(frozen=True)
class GapPlace:
    """Where a gap is: in the frame of a body where it is the same in every pose, else in the world (m)."""

    at: tuple[float, float, float]
    body: str | None


def gap_places(film: Film, clearance: Clearance) -> list[GapPlace | None]:
    """Return points for each pair, at the time of its least gap.

    None beyond MOST, for missing pieces, and between layers.
    """
    out: list[GapPlace | None] = []
    for number, pair in enumerate(clearance.pairs):
        pieces = [
            film.parts.bodies[body].pieces.get(piece) if body in film.parts.bodies else None
            for body, piece in zip(pair.bodies, pair.pieces, strict=True)
        ]
        if number >= MOST or None in pieces or pair.proof == "layers":
            out.append(None)
            continue
        frames = [_frame(film, body, film.poses.time[0] if pair.time is None else pair.time) for body in pair.bodies]
        surfaces = [
            read_triangles(film.folder / piece.stl) @ turned.T + place
            for (place, turned), piece in zip(frames, pieces, strict=True)
            if piece is not None
        ]
        at = middle(*surfaces, gap=pair.gap)
        if pair.time is None:
            at = (at - frames[1][0]) @ frames[1][1]
        x, y, z = (float(value) for value in at)
        out.append(GapPlace((x, y, z), pair.bodies[1] if pair.time is None else None))
    return out


def middle(first: Array, second: Array, gap: float = np.inf) -> Array:
    """Return (3,) halfway between the two nearest points of triangles (n, 3, 3) and (m, 3, 3).

    ``gap`` (m), where it is known, spares the search among points that are much farther apart.
    """
    size = max(float(np.ptp(faces.reshape(-1, 3), axis=0).max()) for faces in (first, second))
    # Far triangles of a large piece need no points: those within reach of the other's box alone.
    near = [_overlapping(faces, other, size / 4) for faces, other in ((first, second), (second, first))]
    a, b = (_points(faces, size / FINE) for faces in near)
    tree = KDTree(b)
    distance, index = tree.query(a, distance_upper_bound=2 * gap + 4 * size / FINE)
    if not np.isfinite(distance).any():
        distance, index = tree.query(a)
    k = int(np.argmin(distance))
    return (a[k] + b[int(np.asarray(index)[k])]) / 2


def _overlapping(faces: Array, other: Array, reach: float) -> Array:
    corners = other.reshape(-1, 3)
    low, high = corners.min(axis=0) - reach, corners.max(axis=0) + reach
    there = ((faces.max(axis=1) >= low) & (faces.min(axis=1) <= high)).all(axis=1)
    return faces[there] if there.any() else faces


def _points(triangles: Array, apart: float) -> Array:
    """Return (k, 3) corners, and places inside of triangles that are larger than ``apart``."""
    edges = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    parts = np.clip(np.ceil(edges / apart), 1, 200).astype(int)
    total = int(((parts + 1) * (parts + 2) // 2).sum())
    if total > POINTS:
        parts = np.maximum(1, (parts / math.sqrt(total / POINTS)).astype(int))
    out = []
    for count in np.unique(parts):
        i, j = (values.ravel() for values in np.meshgrid(np.arange(count + 1), np.arange(count + 1)))
        inside = i + j <= count
        weights = np.stack([i, j, count - i - j], axis=1)[inside] / count
        out.append(np.einsum("kc,ncd->nkd", weights, triangles[parts == count]).reshape(-1, 3))
    return np.concatenate(out)


def _frame(film: Film, body: str, time: float) -> tuple[Array, Array]:
    """Return the place (3,) and the rotation (3, 3) of a body at a time."""
    if film.in_space is not None:
        place, q = film.poses.over(body, np.array([time]))
        return place[0], matrices(q[0])
    x, y, theta = film.poses.body(body, Moment(float(time), 0))
    c, s = math.cos(theta), math.sin(theta)
    return np.array([x, y, 0.0]), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


# Arrows, arcs and clearances of the page: the same ones and the same scales as in the film.
#
# arrows    full: length of the largest (m); longest: cut at so many of it; tiny: left out below this part of it;
#           scales {unit: {largest, reference, cut, words}}; list [{quantity, row, name, unit, place, value (2 T,), z}];
#           row: of the legend, which has the colour and the head (shared/contract/signals.py)
# arcs      full: sweep of the largest (rad); scale as above or null; list [{quantity, row, name, place (2 T,),
#           value (T,), radius, z}]
# clearance limit (m), pairs [{bodies, pieces, gap (as proven), time, at, on}] nearest first; at (m) is where,
#               in the frame of the body `on` or in the world, or null

ALL: tuple[Quantity, ...] = ("velocities", "accelerations", "forces", "reactions")
PAIRS = 60
"""Number of pairs of the clearance, at most."""


def arrows_of(motion: AnyMotion, size: float, heights: Heights | SpaceHeights | None = None) -> dict[str, Any]:
    """Return straight arrows of all quantities.

    ``size`` (m) is that of the machine, ``heights`` where it has parts.
    """
    arrows = Arrows(np.asarray(motion.time), vectors_of(motion, ALL), size)
    return {
        "full": FULL * size,
        "longest": LONGEST,
        "tiny": TINY,
        "scales": {unit: _scale(scale) for unit, scale in arrows.scales.items()},
        "list": [
            {
                "quantity": vector.quantity,
                "row": vector.row,
                "name": vector.name,
                "unit": vector.unit,
                "bodies": list(vector.bodies),
                "place": vector.place.astype(np.float32),
                "value": vector.value.astype(np.float32),
                "z": heights.arrow(vector.bodies, *map(float, vector.place[0])) if heights else 0.0,
            }
            for vector in arrows.vectors
        ],
    }


def arcs_of(motion: AnyMotion, size: float, heights: Heights | SpaceHeights | None = None) -> dict[str, Any]:
    """Return curved arrows: torques of joints, drivers, springs, loads."""
    least = rounding(vectors_of(motion, ("forces", "reactions")), size)
    arcs = Arcs(np.asarray(motion.time), torques_of(motion, ALL), size, least)
    return {
        "full": FULL_TURN,
        "scale": _scale(arcs.scale) if arcs.scale else None,
        "list": [
            {
                "quantity": torque.quantity,
                "row": SIGNAL[torque.quantity],
                "name": torque.name,
                "bodies": list(torque.bodies),
                "place": torque.place.astype(np.float32),
                "value": torque.value.astype(np.float32),
                **({"about": torque.about.astype(np.float32)} if isinstance(torque, Turning) else {}),
                "radius": spec.radius,
                "z": heights.arrow(torque.bodies, *map(float, torque.place[0])) if heights else 0.0,
            }
            for torque, spec in zip(arcs.torques, arcs.specs(), strict=True)
        ],
    }


def clearance_of(clearance: Clearance, film: Film | None = None) -> dict[str, Any]:
    """Return the nearest pairs; with their places where the machine has parts."""
    places = gap_places(film, clearance) if film else [None] * len(clearance.pairs)
    return {
        "limit": clearance.limit,
        "pairs": [
            {
                "bodies": list(pair.bodies),
                "pieces": list(pair.pieces),
                "gap": pair.proven,
                "time": pair.time,
                "at": list(place.at) if place else None,
                "on": place.body if place else None,
            }
            for pair, place in zip(clearance.pairs[:PAIRS], places[:PAIRS], strict=True)
        ],
    }


def _scale(scale: Scale) -> dict[str, Any]:
    return {
        "largest": scale.largest,
        "reference": scale.reference,
        "cut": scale.cut,
        "words": written(scale.reference, scale.unit),
    }
