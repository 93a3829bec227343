"""How far each piece is lifted while a machine comes apart: what came last goes first, and comes back last."""

from __future__ import annotations

from collections.abc import Sequence

from render.film.exploded import Lift
from render.film.story.ramp import eased

EACH = 0.45
"""Part of the time of coming apart that each layer takes."""


def lifted(lifts: Sequence[Lift], part: float) -> list[float]:
    """Heights (m) of all pieces over where they belong, when the machine is apart by a ``part`` 0 .. 1."""
    layers = lifts[-1].order or 1
    delays = [(1 - lift.order / layers) * (1 - EACH) for lift in lifts]
    return [lift.distance * eased((part - delay) / EACH) for lift, delay in zip(lifts, delays, strict=True)]
