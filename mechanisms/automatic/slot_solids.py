"""The solids of a pin in a slot (rmm): the slot itself, the pin, its roller and washer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.shapes.pin import pin, washer
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.plan import Plan
    from mechanisms.automatic.slots import Slot


def slotted(slot: Slot, plan: Plan, heights: Heights) -> None:
    """Cut the slot, and put a pin with a roller through it: from below with its head on top, from above hanging."""
    sizes = plan.layout.sizes
    half = (sizes.roller + sizes.pivot.fit.running) / 2
    tool = extruded(outline.hull([(*end, half) for end in slot.ends()]), heights.thickness + 2.0, -1.0)
    plan.cut(slot.slot, tool, 1)
    slot_pin(slot, plan, heights)


def slot_pin(slot: Slot, plan: Plan, heights: Heights, roller_diameter: float | None = None) -> None:
    """A pin with a roller at the height of the slot's body, on the pin's body: from below its head is on top."""
    sizes = plan.layout.sizes
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = slot.pin_at
    outer = roller_diameter or sizes.roller
    low, high = heights.bottom(slot.slot), heights.top(slot.slot)
    roller = washer(pivot.pin + fit.running, outer, heights.thickness - 0.4, chamfer=0.4)
    plan.make(slot.pin, f"roller_{slot.name}", placed(roller, x, y, low + 0.2), "bronze", 1)
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
