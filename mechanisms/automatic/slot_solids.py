"""The solids of a pin in a slot (rmm): the slot itself, the pin, its roller and washer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.shapes.pin import grooved, pin, washer
from shared.shapes.solid import Roll, Solid, placed

if TYPE_CHECKING:
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.plan import Plan
    from mechanisms.automatic.slots import Slot

GROOVES, GROOVE, GROOVE_DEPTH = 6, 2.6, 1.6
"""Grooves for oil in the face of a roller, by which one sees it turn: how many, width and depth (rmm)."""
RIM = 1.0
"""Between grooves and the roller's rim (rmm)."""
SEEN = 2.0
"""How far the face of a roller with grooves reaches beyond the head of its pin (rmm)."""


def slotted(slot: Slot, plan: Plan, heights: Heights) -> None:
    """Cut the slot, and put a pin with a roller through it: from below with its head on top, from above hanging."""
    sizes = plan.layout.sizes
    half = (sizes.roller + sizes.pivot.fit.running) / 2
    tool = extruded(outline.hull([(*end, half) for end in slot.ends()]), heights.thickness + 2.0, -1.0)
    plan.cut(slot.slot, tool, 1)
    plan.slots.setdefault(slot.slot, []).append(slot.ends())
    slot_pin(slot, plan, heights)


def slot_pin(slot: Slot, plan: Plan, heights: Heights, roller_diameter: float | None = None) -> None:
    """A pin with a roller at the height of the slot's body, on the pin's body: from below its head is on top."""
    sizes = plan.layout.sizes
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = slot.pin_at
    outer = roller_diameter or sizes.roller
    low, high = heights.bottom(slot.slot), heights.top(slot.slot)
    roller, roll = washer(pivot.pin + fit.running, outer, heights.thickness - 0.4, chamfer=0.4), None
    if roller_diameter is not None and outer > sizes.head.diameter + 2 * SEEN:
        roller = grooved(roller, GROOVES, outer / 2 - RIM, GROOVE, GROOVE_DEPTH)
        roll = Roll(slot.name, x, y, outer / 2, GROOVES)
    bronze = Solid(f"roller_{slot.name}", placed(roller, x, y, low + 0.2), "bronze", 1, rolls=roll)
    plan.add(slot.pin, bronze)
    if heights.bottom(slot.pin) < low:
        boss = max(low - fit.axial - pivot.washer_room - heights.top(slot.pin), 0.0)
        boss = 0.0 if boss < 0.05 else boss
        eye = Eye(sizes.eye - 0.5, pivot.held, above=boss, boss=min(9.5, sizes.hardware))
        plan.eye(slot.pin, x, y, eye)
        plan.add(slot.pin, pivot.washer_at(f"washer_{slot.name}", x, y, heights.top(slot.pin) + boss + fit.seat))
        start = heights.bottom(slot.pin) + 0.3
        shape = pin(pivot.pin, high + fit.axial - start, sizes.head)
    else:
        boss = max(heights.bottom(slot.pin) - high - fit.axial - pivot.washer_room, 0.0)
        boss = 0.0 if boss < 0.05 else boss
        eye = Eye(sizes.eye - 0.5, pivot.held, below=boss, boss=min(9.5, sizes.hardware))
        plan.eye(slot.pin, x, y, eye)
        under = heights.bottom(slot.pin) - boss - pivot.washer_room
        plan.add(slot.pin, pivot.washer_at(f"washer_{slot.name}", x, y, under))
        start = low + 0.1
        shape = pin(pivot.pin, heights.top(slot.pin) + fit.seat - start, sizes.head)
    plan.make(slot.pin, f"pin_{slot.name}", placed(shape, x, y, start), "brass", 0)
