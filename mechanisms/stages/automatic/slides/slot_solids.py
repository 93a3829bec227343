"""The solids of a pin in a slot (rmm): the slot, its plate where that is on ground, the pin, its roller and washer."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.layout.planar import convex_hull
from mechanisms.stages.automatic.pins.pin_solids import standing
from mechanisms.stages.automatic.slides.common_pins import InSlot, common
from mechanisms.stages.automatic.slides.slots import POST, Slot
from shared.shapes import outline
from shared.shapes.band import band, loop
from shared.shapes.build import eased, extruded
from shared.shapes.link import Eye
from shared.shapes.pin import Head, grooved, pin, washer
from shared.shapes.solid import Roll, Solid, placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

GROOVES, GROOVE, GROOVE_DEPTH = 6, 2.6, 1.6
"""Grooves for oil in the face of a roller, by which one sees it turn: how many, width and depth (rmm)."""
RIM = 1.0
"""Between grooves and the rim of a large roller (rmm); in a small one they go through."""
SEEN = 2.0
"""How far the face of a large roller reaches beyond the head of its pin (rmm)."""
SMALL = Head(10.4, 3.2, 1.0)
"""Head of the pin of a small roller, whose face shows round it (rmm)."""
SMALL_GROOVE = 1.7
"""Width of the grooves of a small roller (rmm)."""
ROLLER_WALL = 0.4
"""Least wall of a roller (rmm)."""
PIECES = 24
"""About so many straight pieces stand for a curved slot."""
CHANNEL = 4.6
"""Depth of a slot that does not go through (rmm)."""


@build.register(Slot)
def slotted(slot: Slot, plan: Plan, heights: Heights) -> None:
    """Cut the slot, and put a pin with a roller through it: from below with its head on top, from above hanging."""
    sizes = plan.layout.sizes
    tool = _tool(slot.path, (sizes.roller + sizes.pivot.fit.running) / 2, heights.thickness + 2.0).translate((0, 0, -1))
    if slot.slot == "ground":
        _plate(slot, tool, plan, heights)
    else:
        plan.cut(slot.slot, tool, 1)
        _keep_free(slot, plan)
    slot_pin(slot, plan, heights)


def _keep_free(slot: Slot, plan: Plan) -> None:
    """Tell the plate where its slot is, as straight pieces of it."""
    places = [(float(x), float(y)) for x, y in slot.path[:: max(1, len(slot.path) // PIECES)]]
    last = (float(slot.path[-1][0]), float(slot.path[-1][1]))
    kept = plan.slots.setdefault(slot.slot, [])
    kept += [[a, b] for a, b in pairwise([*places, last]) if a != b]


def _tool(path: np.ndarray, half: float, height: float) -> cq.Workplane:
    if len(path) == 2:
        return extruded(outline.hull([(float(x), float(y), half) for x, y in path]), height)
    return extruded(band(path, half), height)


def channelled(slot: Slot, plan: Plan, heights: Heights) -> None:
    """Cut a channel all round into the face where the pin comes from, and put a pin with a roller into it."""
    sizes = plan.layout.sizes
    half, low = (sizes.roller + sizes.pivot.fit.running) / 2, heights.bottom(slot.layer)
    below = slot.pin == "ground" or heights.bottom(slot.pin) < low
    tool = extruded(loop(slot.path, half), CHANNEL + 1.0, -1.0 if below else heights.thickness - CHANNEL)
    inner = extruded(loop(slot.path, -half), CHANNEL + 3.0, -2.0 if below else heights.thickness - CHANNEL - 1.0)
    tool = tool.cut(inner)
    if slot.slot == "ground":
        _plate(slot, tool, plan, heights, 0)
    else:
        plan.cut(slot.slot, tool, 0)
        _keep_free(slot, plan)
    slot_pin(slot, plan, heights, depth=CHANNEL)


def _plate(slot: Slot, tool: cq.Workplane, plan: Plan, heights: Heights, holes: int = 1) -> None:
    """On posts on the base."""
    seat, low = plan.layout.sizes.pivot.fit.seat, heights.bottom(slot.layer)
    wide = slot.radius(plan.layout)
    hull = convex_hull(np.array([(x, y) for x, y, _ in slot.outline(plan.layout)]), 1e-4)
    shape = extruded(outline.hull([(float(x), float(y), wide) for x, y in hull]), heights.thickness)
    shape = eased(shape, 0.6, ">Z", chamfer=True).cut(tool)
    plan.make("ground", f"slot_{slot.name}", placed(shape, z=low), "aluminium", holes)
    for k, (x, y) in enumerate(slot.posts(plan.layout), start=1):
        post = extruded(outline.circle(x, y, POST / 2), low - 2 * seat, seat)
        plan.make("ground", f"post_{slot.name}_{k}", post, "steel", 0)
        plan.feet.append(Foot("", x, y, POST / 2 + 2.0))


def slot_pin(
    slot: Slot, plan: Plan, heights: Heights, roller_diameter: float | None = None, depth: float | None = None
) -> None:
    """A pin with a roller at the height of the slot, on the pin's body: from below its head is on top.

    In a groove of a ``depth`` the pin ends. Through slots at one place of the body have one pin. With a
    ``roller_diameter`` of 0 the pin is bare.
    """
    through: list[InSlot] = [slot] if roller_diameter is not None or depth is not None else common(slot, plan.layout)
    outer = plan.layout.sizes.roller if roller_diameter is None else roller_diameter
    large = outer > plan.layout.sizes.head.diameter + 2 * SEEN
    if outer > 0:
        _roller(slot, outer, large, depth, plan, heights)
    if slot.name == through[-1].name:
        _pin(through, large, depth, plan, heights)


def _is_below(slot: InSlot, heights: Heights) -> bool:
    """Whether the pin comes from below."""
    return slot.pin == "ground" or heights.bottom(slot.pin) < heights.bottom(slot.layer)


def _roller(slot: Slot, outer: float, large: bool, depth: float | None, plan: Plan, heights: Heights) -> None:
    pivot, (x, y) = plan.layout.sizes.pivot, slot.pin_at
    thick = (heights.thickness if depth is None else depth - 0.4) - 0.4
    bore = pivot.pin + pivot.fit.running
    turns = outer - bore >= 2 * ROLLER_WALL
    if not turns:  # of clockwork, whose clearances are wide beside its pins: it is pressed on
        bore = pivot.held
    if outer - bore < 2 * ROLLER_WALL:
        raise UserError(_no_wall(slot, outer, plan.layout))
    reach, width = (outer / 2 - RIM, GROOVE) if large else (outer, SMALL_GROOVE)
    roller = grooved(washer(bore, outer, thick, chamfer=0.4), GROOVES, reach, width, GROOVE_DEPTH)
    roll = Roll(slot.name, x, y, outer / 2, GROOVES) if turns else None
    below = _is_below(slot, heights)
    at = heights.bottom(slot.layer) + 0.2 if below else heights.top(slot.layer) - 0.2 - thick
    plan.add(slot.pin, Solid(f"roller_{slot.name}", placed(roller, x, y, at), "bronze", 1, rolls=roll))


def _no_wall(slot: Slot, outer: float, layout: Layout) -> str:
    scale, pin = layout.sizes.scale, layout.sizes.pivot.held
    return (
        f"{layout.m.name}: the roller of '{slot.name}' is {outer * scale:.3g} mm in diameter, and on a pin of "
        f"{layout.sizes.pin:g} mm it needs {(pin + 2 * ROLLER_WALL) * scale:.3g} mm or more; make it larger, the pins "
        f"thinner (automatic(m, pin=...)), or write {shown_file(layout.m.name, 'parts')}"
    )


def _pin(through: list[InSlot], large: bool, depth: float | None, plan: Plan, heights: Heights) -> None:
    """From the lowest to the highest of the slots, or from its body, with a boss and a washer on each side of that."""
    sizes = plan.layout.sizes
    pivot, fit, first = sizes.pivot, sizes.pivot.fit, through[0]
    body, (x, y) = first.pin, first.pin_at
    above = [(heights.bottom(slot.layer), heights.top(slot.layer)) for slot in through if _is_below(slot, heights)]
    under = [(heights.bottom(slot.layer), heights.top(slot.layer)) for slot in through if not _is_below(slot, heights)]
    head = None if depth is not None else SMALL if above and not large else sizes.head
    if above:
        end = max(high for _, high in above) + fit.axial if depth is None else above[0][0] + depth - 0.4
    else:
        end = heights.top(body) + (fit.seat if depth is None else -0.3)
    if body == "ground":
        height = min(low for low, _ in above) - fit.axial - pivot.washer_room
        standing(first.name, (x, y), height, plan, levels=heights.levels)
        plan.add("ground", pivot.washer_at(f"washer_{first.name}", x, y, height + fit.seat))
        start = 0.5
    else:
        rise = _boss(min(low for low, _ in above) - heights.top(body), plan) if above else 0.0
        drop = _boss(heights.bottom(body) - max(high for _, high in under), plan) if under else 0.0
        eye = Eye(sizes.eye - 0.5, pivot.held, above=rise, below=drop, boss=min(9.5, sizes.hardware))
        plan.eye(body, x, y, eye)
        if above:
            plan.add(body, pivot.washer_at(f"washer_{first.name}", x, y, heights.top(body) + rise + fit.seat))
        if under:
            at = heights.bottom(body) - drop - pivot.washer_room
            plan.add(body, pivot.washer_at(f"washer_{first.name}", x, y, at))
        start = heights.bottom(body) + 0.3
        if under:
            start = min(low for low, _ in under) + 0.1 if depth is None else under[0][1] - depth + 0.4
    shape = pin(pivot.pin, end - start, head)
    plan.make(body, f"pin_{first.name}", placed(shape, x, y, start), "brass", 0)


def _boss(gap: float, plan: Plan) -> float:
    """How high a boss is that leaves room for a washer and for the slot's plate to move."""
    pivot = plan.layout.sizes.pivot
    height = gap - pivot.fit.axial - pivot.washer_room
    return 0.0 if height < 0.05 else height
