"""Ends of rods and of distance drivers: places on two bodies that are apart."""

from __future__ import annotations

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Fixing, Marker, Place
from mbsd.spatial.model.entries import own_marker, refuse_same
from mbsd.spatial.model.mechanism import Model, own_body


def ends_given(
    m: Model, what: str, first: Fixing, second: Fixing, start: Place | None, end: Place | None
) -> tuple[Marker, Marker]:
    """Return markers at both ends, given or from places of the world (m). Raises ModelError."""
    markers = []
    for body, place, name in ((first, start, "start"), (second, end, "end")):
        if isinstance(body, Marker):
            if place is not None:
                raise ModelError(f"{what} has a marker and {name}=; a marker has a place, so leave {name} out")
            markers.append(own_marker(m, what, body))
        elif place is None:
            raise ModelError(f"{what} needs {name}=(x, y, z), a place of the world in the design pose (m)")
        else:
            markers.append(own_body(m, body, what).world_marker(np.array(place, float), np.eye(3)))
    refuse_same(what, *markers)
    return markers[0], markers[1]


def design_distance(i: Marker, j: Marker) -> float:
    """Return how far two markers are apart in the design pose (m)."""
    return float(np.linalg.norm(j.world_place - i.world_place))
