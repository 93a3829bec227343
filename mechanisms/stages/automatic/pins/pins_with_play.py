"""Pins with play: the bushings of a clearance joint are bored as much wider as its journal moves in them.

The play is what the motion shows, to scale: the clearance and what steel yields, so that nothing meets in the film.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.features import force_kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.pins.pins import SAME, Pin
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.force import Force
    from mechanisms.stages.automatic.layout.layout import Layout

THINNEST = 0.4
"""Least wall of a bushing (rmm)."""


@force_kind("clearance_joint")
def gather(m: Mechanism, forces: list[Force], layout: Layout) -> list[Feature]:
    """A pin each. Raises UserError where play leaves no bushing, or where another pin has the place."""
    pins: list[Feature] = []
    for force in forces:
        places = {marker.body.name: layout.place(marker) for marker in (force.i, force.j)}
        _refuse_shared(m, force, places, layout)
        pins.append(Pin(force.name, m, places, play=_play(m, force, layout)))
        layout.features.append(pins[-1])  # springs may end on it
    return pins


def _play(m: Mechanism, force: Force, layout: Layout) -> float:
    first, second = force.i, force.j
    away = layout.seen(second.body.name, layout.place(second), first.body.name) - layout.place(first)
    play = float(np.hypot(*away.T).max())
    pivot = layout.sizes.pivot
    most = (pivot.bushing - 2 * THINNEST - pivot.bored()) / 2
    if play > most:
        scale = layout.sizes.scale
        raise UserError(
            f"{m.name}: clearance joint '{force.name}' moves {play * scale:.3g} mm to a side, and bushings of "
            f"{pivot.bushing * scale:.3g} mm on a pin of {pivot.pin * scale:.3g} mm have room for {most * scale:.3g} "
            f"mm; give it less clearance, or write {shown_file(m.name, 'parts')}"
        )
    return play


def _refuse_shared(m: Mechanism, force: Force, places: dict[str, tuple[float, float]], layout: Layout) -> None:
    for pin in layout.features:
        for body, (x, y) in places.items():
            if isinstance(pin, Pin) and body in pin.places:
                u, v = pin.places[body]
                if abs(x - u) < SAME and abs(y - v) < SAME:
                    raise UserError(
                        f"{m.name}: clearance joint '{force.name}' and '{pin.name}' are at one place of '{body}', and "
                        "bodies that share a pin have no play of their own in automatic parts; move one of them, or "
                        f"write {shown_file(m.name, 'parts')}"
                    )
