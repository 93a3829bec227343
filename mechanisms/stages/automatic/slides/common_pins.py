"""A pin that runs in several slots: one pin of its body, with a roller in each of them.

A crank that moves two yokes, or indexes two Geneva wheels, has its slots on one side of it or on both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from mechanisms.stages.automatic.pins.pins import Pin
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mechanisms.stages.automatic.layout.layout import Feature, Layout

SAME = 0.02
"""Pins nearer than this are one (rmm)."""


class InSlot(Protocol):
    """A pin in a slot: a joint's name, the bodies of slot and pin, and the pin's place on its body (rmm)."""

    @property
    def name(self) -> str:
        """Name of the joint."""
        ...

    @property
    def slot(self) -> str:
        """The body that has the slot."""
        ...

    @property
    def pin(self) -> str:
        """The body that has the pin."""
        ...

    @property
    def pin_at(self) -> tuple[float, float]:
        """Where the pin is on its body (rmm)."""
        ...

    @property
    def layer(self) -> str:
        """What decides the layer of the slot."""
        ...


def common(slot: InSlot, layout: Layout) -> list[InSlot]:
    """All through slots in which the pin of ``slot`` runs, this one among them."""
    through: list[InSlot] = [
        s for s in (getattr(feature, "runs_through", None) for feature in layout.features) if s is not None
    ]
    return [other for other in through if other.pin == slot.pin and math.dist(other.pin_at, slot.pin_at) < SAME]


def passed(slot: InSlot, layout: Layout) -> frozenset[str]:
    """Names of the items that the pin passes through by design."""
    names = [
        (other.slot, f"the slotted plate of {other.name}", f"the wheel of {other.name}")
        for other in common(slot, layout)
    ]
    return frozenset(name for here in names for name in here)


def refuse_pins_of_both_kinds(m: Mechanism, features: Sequence[Feature]) -> None:
    """Raise UserError where a pin that runs in a slot is at the place of a revolute joint's pin."""
    pins = [feature for feature in features if isinstance(feature, Pin)]
    for slot in (getattr(feature, "runs_through", None) for feature in features):
        if slot is None:
            continue
        for other in pins:
            place = other.places.get(slot.pin)
            if place is not None and math.dist(place, slot.pin_at) < SAME:
                raise UserError(
                    f"{m.name}: the pin of joint '{slot.name}' is where {slot.pin} has that of joint '{other.name}'; "
                    f"give it a place of its own on {slot.pin}, or write {shown_file(m.name, 'parts')}"
                )
