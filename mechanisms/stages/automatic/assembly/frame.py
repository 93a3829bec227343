"""The base: a plate, engraved with the joints' names, a rule and a dial round what is driven; it lies, or stands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.plan import BOLT_HOLE
from mechanisms.stages.automatic.standing.back_plate import BackPlate, Upright
from shared.shapes.base import base_plate, foot
from shared.shapes.engraving import LETTERS, dial, engraved, rule, text
from shared.shapes.screw import SOCKET, head_diameter, socket_screw
from shared.shapes.solid import Solid, placed
from shared.shapes.standards import screw_length, screw_name

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.layout.plan import Foot, Plan
    from mechanisms.stages.automatic.layout.sizes import Sizes

PLATE, FOOT_HEIGHT = 12.0, 3.0
MARGIN = (48.0, 40.0)
"""Margins of the plate beyond the places where something stands (rmm)."""
SLIM = (42.0, 36.0)
"""Margins of a plate on a stand, whose corners carry no screws."""
INSET = 12.0
"""Inset of the screws at the corners."""
LONGEST_RULE = 420.0
DIAL = 22.5
MOST_LETTERS = 3


def base(plan: Plan, engraved_too: bool = True) -> list[Solid]:
    """The plate, the ground's main piece, ``engraved_too`` unless nobody is to see it; screws and feet, or spacers to a
    wall, where it is on no stand. Nothing where the ground itself is all that one needs.
    """
    back = back_plate(plan)
    if back is None:
        return []
    upright, (x0, y0, x1, y1) = Upright.of(plan.mount), back.corners
    bolts = [(x, y, 2 * radius, BOLT_HOLE) for x, y, radius in back.holes]
    rests = plan.mount.kind in ("desk", "wall")
    corners = [(x, y) for x in (x0 + INSET, x1 - INSET) for y in (y0 + INSET, y1 - INSET)] if rests else []
    screw = _corner_screw(plan.layout.sizes)
    plate = base_plate((x0, y0, x1, y1), PLATE, 12.0, corners, screw.diameter, screw.room, bolts)
    if engraved_too:
        plate = engraved(plate, _marks(plan, upright, (x0, y0, x1, y1)), 0.0)
    seat = plan.layout.sizes.pivot.fit.seat
    solids = [Solid("base_plate", plate, "aluminium_black", len(corners))]
    under = foot(18.0, FOOT_HEIGHT, screw.diameter + 0.4)
    for i, (x, y) in enumerate(corners):
        solids += [
            Solid(f"corner_screw_{i + 1}", placed(screw.shape, x, y, seat - screw.room[1]), "steel", 0, buy=screw.buy),
            Solid(f"foot_{i + 1}", placed(under, x, y, -PLATE - seat), "rubber", 1),
        ]
    return [replace(solid, shape=upright.in_model(solid.shape)) for solid in solids]


def back_plate(plan: Plan) -> BackPlate | None:
    """The plate (rmm) as its mount has it; None where the ground itself is all that one needs."""
    if plan.mount.kind == "ground" and all(stand.road for stand in plan.feet) and not plan.base_under:
        return None
    upright, sizes = Upright.of(plan.mount), plan.layout.sizes
    hole = sizes.screw / sizes.finished + 0.4
    bolts = [(*upright.seen_place(x, y), hole / 2) for stand in plan.feet for x, y in stand.holes]
    return BackPlate(_extent(plan, upright), 0.0, PLATE, 1.0, sizes.pivot.fit.seat, tuple(bolts))


@dataclass(frozen=True)
class _Screw:
    """Screw of a corner (rmm), through the plate and its foot. ``room``: diameter and depth of its counterbore."""

    shape: cq.Workplane
    diameter: float
    room: tuple[float, float]
    buy: str = ""


def _corner_screw(sizes: Sizes) -> _Screw:
    """The standard screw next to 5 rmm; of 5 rmm where none is near."""
    nominal = min(SOCKET, key=lambda size: abs(size - 5.0 * sizes.finished))
    diameter = nominal / sizes.finished
    room = head_diameter(nominal) / sizes.finished + 0.5, diameter + 0.4
    longest = PLATE + FOOT_HEIGHT - room[1] - 0.4
    length = screw_length(nominal, longest * sizes.finished)
    if length is None or not 4.0 < diameter < 6.25:
        return _Screw(socket_screw(5.0, 8.5), 5.0, (9.0, 5.4))
    shape = socket_screw(nominal, length)
    shape = shape.newObject([shape.val().scale(1 / sizes.finished)])
    return _Screw(shape, diameter, room, screw_name(nominal, length))


def _extent(plan: Plan, upright: Upright) -> tuple[float, float, float, float]:
    """Extent of the plate: round all feet; without any, under what moves; and as far as one wishes."""
    if plan.feet:
        places = np.array([[stand.x, stand.y] for stand in plan.feet])
    else:
        places = np.concatenate([plan.layout.poses[body][:, :2] for body in plan.layout.moving])
    places = upright.seen(places)
    (x0, y0), (x1, y1) = places.min(axis=0), places.max(axis=0)
    right, up = MARGIN if plan.mount.kind in ("desk", "wall") else SLIM
    under = [upright.seen_place(x, y) for x, y in plan.base_under]
    corners = np.array([[x0 - right, y0 - up], [x1 + right, y1 + up], *under])
    return (*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())


def _marks(plan: Plan, upright: Upright, extent: tuple[float, float, float, float]) -> list[cq.Face]:
    y0 = extent[1]
    marks: list[cq.Face] = []
    feet = [_seen(stand, upright) for stand in plan.feet]
    xs = [stand.x for stand in feet]
    middle = (min(xs) + max(xs)) / 2 if xs else 0.0
    for stand, there in zip(feet, plan.feet, strict=True):
        if stand.dial and plan.layout.room_on_base(there.x, there.y) > DIAL + 4.0:
            marks += dial(stand.x, stand.y, DIAL, 10.0)
        marks += _letters(stand, middle, feet)
    reach = max(xs) - min(xs) if xs else 0.0
    if 30.0 < reach < LONGEST_RULE:
        marks += _ruler(plan.layout.sizes, reach, min(xs), y0)
    return marks


def _seen(stand: Foot, upright: Upright) -> Foot:
    x, y = upright.seen_place(stand.x, stand.y)
    return replace(stand, x=x, y=y)


def _letters(stand: Foot, middle: float, feet: Sequence[Foot]) -> list[cq.Face]:
    """The joint's name beside its foot, away from the others, if it is short and its place is free."""
    if not 0 < len(stand.label) <= MOST_LETTERS or any(letter not in LETTERS for letter in stand.label):
        return []
    aside = stand.radius + 10.5 + 3.0 * (len(stand.label) - 1) + (4.0 if stand.dial else 0.0)
    x = stand.x + (aside if stand.x > middle + 1.0 else -aside)
    if any(math.hypot(x - s.x, stand.y - s.y) < s.radius + 8.0 for s in feet if s is not stand):
        return []
    return text(stand.label, 7.0, x, stand.y, width=1.2)


def _ruler(sizes: Sizes, reach: float, x: float, y0: float) -> list[cq.Face]:
    """A rule in millimetres of the finished piece, its strokes 3 to 8 rmm apart."""
    step = next(
        s for power in range(-3, 6) for s in (10.0**power, 5 * 10.0**power) if s * 0.999 / sizes.finished >= 3.0
    )
    short = step / sizes.finished
    marks = rule(reach, x, y0 + 3.4, step=short)
    count = math.floor(reach / short + 1e-9)
    every = next(n for n in (2, 4, 10, 20, 40, 100) if n * short >= 14.0 + 2.0 * len(f"{count * step:g}"))
    for i in range(0, count + 1, every):
        label = f"{i * step:g}"
        if all(letter in LETTERS for letter in label):
            marks += text(label, 2.6, x + i * short, y0 + 9.0, width=0.45)
    return marks
