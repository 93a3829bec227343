"""Finds pieces that are equal but for their place: they are made several times, but drawn and listed once.

Two pieces are equal if a turn on the bed brings each corner of one mesh to a corner of the other, as it lies or turned
over. Mirror images are not equal unless they are also turned images of each other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.spatial import KDTree

from mechanisms.stages.print.laying import Laid

NEAR = 5e-3
"""Corners that are nearer (mm) are the same; single precision leaves a thousandth of it."""
ALIKE = 1e-4
"""Relative difference of volumes that is looked at closer."""


def groups(pieces: Sequence[tuple[str, Laid]]) -> list[list[int]]:
    """Indices of equal pieces of one material, each given as (material, mesh); in the order of their first."""
    kinds: list[list[int]] = []
    marks: list[tuple[str, float]] = []
    for index, (material, piece) in enumerate(pieces):
        volume = volume_of(piece)
        for group, (other, theirs) in zip(kinds, marks, strict=True):
            near = abs(volume - theirs) <= ALIKE * theirs
            if material == other and near and is_equal(piece, pieces[group[0]][1]):
                group.append(index)
                break
        else:
            kinds.append([index])
            marks.append((material, volume))
    return kinds


def is_equal(piece: Laid, other: Laid) -> bool:
    """Whether a turn, as it lies or turned over, and a shift bring the corners of one onto those of the other."""
    if abs(piece.size[2] - other.size[2]) > NEAR or len(piece.vertices) != len(other.vertices):
        return False
    first, second = _centred(piece), _centred(other)
    over = first * [1.0, -1.0, -1.0] + [0.0, 0.0, piece.size[2]]
    tree = KDTree(second)
    return any(_falls_on(corners, second, tree) for corners in (first, over))


def _falls_on(first: np.ndarray, second: np.ndarray, tree: KDTree) -> bool:
    """Whether a turn about the vertical brings each corner onto one of the others."""
    reach = np.hypot(first[:, 0], first[:, 1])
    far = int(np.argmax(reach))
    same = np.abs(np.hypot(second[:, 0], second[:, 1]) - reach[far]) < NEAR
    same &= np.abs(second[:, 2] - first[far, 2]) < NEAR
    start = math.atan2(first[far, 1], first[far, 0])
    for x, y, _ in second[same]:
        c, s = math.cos(math.atan2(y, x) - start), math.sin(math.atan2(y, x) - start)
        turned = first @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        if tree.query(turned[::17], distance_upper_bound=NEAR)[0].max() < NEAR:
            away, at = tree.query(turned, distance_upper_bound=NEAR)
            if away.max() < NEAR and len(np.unique(at)) == len(second):
                return True
    return False


def volume_of(piece: Laid) -> float:
    """Volume of the closed mesh (mm^3)."""
    corners = piece.triangles
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


def _centred(piece: Laid) -> np.ndarray:
    """Corners about the vertical through their middle."""
    return piece.vertices - [*piece.vertices[:, :2].mean(axis=0), 0.0]
