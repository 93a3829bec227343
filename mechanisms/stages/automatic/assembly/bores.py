"""Whether the bores of a body's plate leave a wall between them."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.plan import Plan

WALL = 0.5
"""Least wall between two bores (rmm)."""
ONE = 0.01
"""Bores nearer than this are one (rmm)."""


def refuse_meeting_bores(plan: Plan) -> None:
    """Raise UserError where two bores of a body meet."""
    layout = plan.layout
    for body, eyes in plan.eyes.items():
        bored = [(x, y, eye.bore) for x, y, eye in eyes if eye.bore > 0]
        for first, second in combinations(bored, 2):
            apart = math.hypot(first[0] - second[0], first[1] - second[1])
            least = (first[2] + second[2]) / 2 + WALL
            if ONE < apart < least:
                this, other = (_what(plan, body, *place[:2]) for place in (first, second))
                scale = layout.sizes.scale
                raise UserError(
                    f"{layout.m.name}: on '{body}' {this} and {other} are {apart * scale:.3g} mm apart, and their "
                    f"bores of {first[2] * scale:.3g} and {second[2] * scale:.3g} mm need {least * scale:.3g} mm; move "
                    f"one of them, or shape '{body}' by hand in {shown_file(layout.m.name, 'parts')}"
                )


def _what(plan: Plan, body: str, x: float, y: float) -> str:
    """What the bore at (x, y) of a body is for."""
    layout = plan.layout
    for kind, things in (("joint", layout.m.joints), ("force", layout.m.forces), ("contact", layout.m.contacts)):
        for name, thing in things.items():
            for marker in (thing.i, thing.j):
                u, v = layout.place(marker)
                if marker.body.name == body and math.hypot(u - x, v - y) < ONE:
                    return f"{kind} '{name}'"
    return f"what is at ({x:.3g}, {y:.3g})"
