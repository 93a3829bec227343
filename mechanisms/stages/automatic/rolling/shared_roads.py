"""Roads on ground with one surface are one road: the wheels of a vehicle run on it one behind the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.rolling.roads import Road, along

SAME = 0.03
"""Surfaces nearer than this to each other, where both are, are one (rmm)."""


def with_shared_roads(features: Sequence[Feature]) -> list[Feature]:
    """The features, the roads of one surface merged into the first of them."""
    found: list[Feature] = []
    for feature in features:
        if isinstance(feature, Road) and feature.is_square:
            for k, other in enumerate(found):
                path = _common(other.path, feature.path) if isinstance(other, Road) and other.is_square else None
                if isinstance(other, Road) and path is not None:
                    found[k] = along(other.name, tuple(dict.fromkeys([*other.rounds, *feature.rounds])), path)
                    break
            else:
                found.append(feature)
        else:
            found.append(feature)
    return found


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
