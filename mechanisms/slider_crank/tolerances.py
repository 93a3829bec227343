"""Stray of the press's punch at the end of its stroke, with bars cut to class m and pins H7/g6."""

from __future__ import annotations

from typing import Any

from mbsd import Clearance
from mbsd.measures import largest
from mechanisms.slider_crank.mechanism import Params

PIN = 0.008
"""Diameter of the pins (m)."""
ROOM = 0.3e-3
"""Error of the stroke's end that is allowed (m): the punch passes the blank, and must not touch the die."""


def tolerances(p: Params) -> dict[str, dict[str, Any]]:
    """By result."""
    pin = Clearance.from_fit(PIN, "H7/g6")
    sizes = {"crank": "m", "rod": "m", "guide": {"y": 1e-4}, "O": pin, "A": pin, "B": pin}
    end = ((p.rod + p.crank) ** 2 - p.offset**2) ** 0.5
    return {"end_of_stroke": {"sizes": sizes, "result": largest("slider.x"), "limits": (end - ROOM, end + ROOM)}}
