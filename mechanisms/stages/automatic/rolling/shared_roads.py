"""Roads on ground with one surface are one road: the wheels of a vehicle run on it one behind the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.rolling.roads import Road, along, banded
from shared.shapes.polyline import distances

SAME = 0.03
"""Surfaces nearer than this to each other, where both are, are one (rmm)."""


def with_shared_roads(features: Sequence[Feature]) -> list[Feature]:
    """The features, the roads of one surface merged into the first of them."""
    shared: list[Feature] = []
    for feature in features:
        for k, other in enumerate(shared):
            both = _both(other, feature) if isinstance(other, Road) and isinstance(feature, Road) else None
            if both is not None:
                shared[k] = both
                break
        else:
            shared.append(feature)
    return shared


def _both(first: Road, second: Road) -> Road | None:
    """Two roads on one surface as one; None where they are not on one."""
    if not all(road.is_square or road.band for road in (first, second)):
        return None
    rounds = tuple(dict.fromkeys([*first.rounds, *second.rounds]))
    if first.band is None and second.band is None:
        path = _common(first.path, second.path)
        return None if path is None else along(first.name, rounds, path)
    for long, short in ((first, second), (second, first)):
        if distances(short.path, long.path).max() < SAME:
            return banded(first.name, rounds, long.path)
    return None


def _common(first: np.ndarray, second: np.ndarray) -> np.ndarray | None:
    """(n, 2) one path along both; None where they part, or where there is a gap between two that are not straight."""
    way = (first[-1] - first[0]) / np.hypot(*(first[-1] - first[0]))
    at, other = (first @ way, second @ way)
    if (np.diff(at) <= 0).any() or (np.diff(other) <= 0).any():
        return None
    across = np.array([-way[1], way[0]])
    height, others = first @ across, second @ across
    if len(first) == len(second) == 2:
        off = others - height
    else:
        low, high = max(at[0], other[0]), min(at[-1], other[-1])
        both = np.unique(np.concatenate([at, other]))
        both = both[(both >= low) & (both <= high)]
        off = np.interp(both, at, height) - np.interp(both, other, others)
    if not len(off) or np.abs(off).max() > SAME:
        return None
    return np.vstack([second[other < at[0]], first, second[other > at[-1]]])
