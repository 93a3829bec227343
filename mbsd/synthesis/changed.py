"""A mechanism with other lengths and places, as a new one."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import replace

from mbsd.model.body import Marker
from mbsd.model.change import change
from mbsd.model.mechanism import Model, new_name, own_body
from mbsd.model.numbers import lengthened, place_in


def changed(m: Model, values: Mapping[str, object]) -> Model:
    """A copy of ``m`` with lengths of bars and rods (one number, m) and places of joints and traced points ((x, y), m).

    A bar's new end moves whatever is at its end, forces included, and a uniform rod stays one; other masses are kept.
    Raises ModelError for a name of none.
    """
    out = copy.deepcopy(m)
    for name, value in values.items():
        if isinstance(value, tuple):
            for axis, coordinate in zip("xy", value, strict=True):
                place_in(out, name, axis).put(out, coordinate)
        else:
            change(out, name, lengthened(out, name, float(value)))  # pyright: ignore[reportArgumentType]
    return out


def traced_copy(m: Model, name: str, marker: Marker) -> Model:
    """A copy of ``m`` that follows one more point. Raises ModelError for a marker of another mechanism."""
    own_body(m, marker.body, "fit_path: point")
    out = copy.deepcopy(m)
    new_name(out, name, "trace", out.traces)
    out.traces[name] = replace(marker, body=out.bodies[marker.body.name])
    return out
