"""Wheels in space: discs with their rims, and how another body holds one by its axle.

A body that comes along the axis ends in a stub axle; one that comes from aside ends in a fork round the wheel.
"""

from __future__ import annotations

import cadquery as cq
import numpy as np

from mbsd.spatial.model.body import Body, Marker
from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import MM, Array, Moves, Sizes
from mechanisms.stages.automatic.space.pieces import End
from mechanisms.stages.automatic.space.round import across, unit
from shared.shapes.build import turned

TAPER = 1.2
"""Height of the taper of a sharp rim, in halves of the wheel's width."""
SHARP = 0.04
"""Half of the width of a sharp rim, in halves of the wheel's width."""
ASIDE = 0.25
"""Cosine to the axle below which a body comes from aside, and ends in a fork."""
Rim = tuple[float, float]
"""Radii of the ring of a wheel that rolls, and of the section of its rim (mm); a section of 0 is a sharp edge."""
HUB = 0.7
"""How far a hub stands out of its wheel at either side, in rods."""


def disc_half(body: Body, sizes: Sizes) -> float:
    """Return half of the width of the disc as which a body was added (mm)."""
    shape = body.shape
    assert shape is not None
    return max(0.5 * MM * shape.length, 0.05 * MM * shape.radius, 0.5 * sizes.rod)


def disc_solid(body: Body, sizes: Sizes, rim: Rim | None) -> cq.Shape:
    """Return the disc of a body about its x axis; ``rim`` is that of one that rolls."""
    shape, x, zero = body.shape, np.eye(3)[0], np.zeros(3)
    assert shape is not None
    radius, half = MM * shape.radius, disc_half(body, sizes)
    if rim is None:
        return shapes.disc(zero, x, radius, half)
    radius, tube = rim
    if tube > 0.0:
        profile = [(0, -tube), (radius, -tube), (radius + tube, 0, radius, tube), (0, tube)]
    else:
        inner, edge = radius - TAPER * half, SHARP * half
        profile = [(0, -half), (inner, -half), (radius, -edge), (radius, edge), (inner, half), (0, half)]
    return turned(profile).val().rotate(cq.Vector(0, 0, 0), cq.Vector(0, 1, 0), 90)  # pyright: ignore[reportReturnType, reportAttributeAccessIssue]


def rims(moves: Moves) -> dict[str, Rim]:
    """Return the rim of each disc that rolls; one with a flat tyre has none."""
    return {
        pair.wheel.body.name: (pair.ring, pair.rim)
        for pair in moves.rolling()
        if is_wheel(pair.wheel) and (pair.leans or pair.rim > 0.0)
    }


def is_wheel(marker: Marker) -> bool:
    """Return True if a body is a disc about the axis of a joint at its middle."""
    shape = marker.body.shape
    centred = np.linalg.norm(marker.place) < 1e-6 and abs(marker.axis[0]) > 1 - 1e-9
    return bool(shape is not None and shape.kind == "disc" and centred)


def axle_ends(
    name: str,
    wheel: Marker,
    holder: Marker,
    rest: Array,
    sizes: Sizes,
    rim: Rim | None,
    front: float | None = None,
) -> tuple[End, End]:
    """Return the ends of a wheel and of the body that holds it.

    ``rest`` (3,) is where the holder's rod comes from (mm, its frame), ``rim`` that of the wheel (rims),
    ``front`` how far the wheel reaches on the far side if that is not where its hub ends (mm).
    """
    place, axis = MM * np.array(holder.place), np.array(holder.axis)
    x, zero = np.eye(3)[0], np.zeros(3)
    assert wheel.body.shape is not None
    room = MM * wheel.body.shape.radius if rim is None else sum(rim)
    half = disc_half(wheel.body, sizes) + HUB * sizes.rod
    bored = End(name, zero, cuts=[shapes.disc(zero, x, sizes.pin + sizes.play, half + sizes.rod)], holes=1)
    way = unit(rest - place)
    if abs(way @ axis) < ASIDE:
        return bored, _fork(name, place, axis, across(axis, way), half + sizes.play, sizes, room)
    back = float(np.sign(way @ axis)) * axis
    collar, wide = half + sizes.play + 0.35 * sizes.rod, 1.7 * sizes.pin
    node = place + (collar + 1.1 * sizes.rod) * back  # a rod across the axle passes the hub
    tip = place - ((half if front is None else front) + sizes.play + 0.7 * sizes.rod) * back
    end = End(name, node, [shapes.rod(node, tip, sizes.pin)])
    nuts = (place + collar * back, tip + 0.35 * sizes.rod * back)
    end.adds += [shapes.disc(nut, axis, wide, 0.35 * sizes.rod) for nut in nuts]
    end.lines = [(place, node, sizes.pin)]
    return bored, end


def _fork(name: str, place: Array, axis: Array, back: Array, inner: float, sizes: Sizes, room: float) -> End:
    wall, width, bridge = 0.8 * sizes.rod, 1.3 * sizes.rod, 1.2 * sizes.rod
    depth = room + 1.2 * sizes.rod
    end = End(name, place + (depth + 0.5 * bridge) * back, holes=1)
    end.adds = shapes.yoke(place, axis, back, inner, wall, width, depth, bridge)
    end.adds.append(shapes.disc(place, axis, sizes.pin, inner + 0.5 * wall))
    cheeks = [(inner + wall / 2) * axis, -(inner + wall / 2) * axis]
    end.lines = [(place + side, place + side + depth * back, wall / 2) for side in cheeks]
    return end
