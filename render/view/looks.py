"""The look of the film as WebGL takes it.

name, dark (bool), boxes [[place, size, strength, colour]] (what is reflected, places in radii as the camera stands)
lamp {place, power, colour}: the one with a shadow
ground {texture, colour, other, roughness, lines}, sky {zenith, horizon, below}, wall {kind, colour, away} or null
screen {edge, lamp, ambient, reflected, exposure}, drawing {paper, grid, line (sRGB 0..1), tone} or null
"""

from __future__ import annotations

import math
from typing import Any

import msgspec

from render.looks.look import Look, Softbox
from render.looks.looks import LOOKS

BRIGHTEST = 6.5
"""Brightness of a softbox: a reflection that is brighter is white all the same."""
LARGER = 2.4
"""Times its size, at most."""


def looks_of(look: Look, stands: bool) -> dict[str, Any]:
    """``dark`` and ``light``: what a page in these colours shows of a machine that was filmed in ``look``."""
    return {
        theme: as_shown(look if look.other is None or look.dark == (theme == "dark") else LOOKS[look.other], stands)
        for theme in ("dark", "light")
    }


def as_shown(look: Look, stands: bool) -> dict[str, Any]:
    """See the file."""
    light = look.standing if stands else look.lying
    place = light.sun.place if light.sun is not None else light.shadow
    colour = light.sun.colour if light.sun is not None else (1.0, 1.0, 1.0)
    plain = {key: msgspec.to_builtins(getattr(look, key)) for key in ("ground", "sky", "wall", "screen", "drawing")}
    return plain | {
        "name": look.name,
        "dark": look.dark,
        "boxes": [_box(box, look.screen.reflected) for box in light.softboxes],
        "lamp": {"place": list(place), "colour": list(colour)},
    }


def _box(box: Softbox, times: float) -> list[Any]:
    """Its radiance is what a lamp of its power and size has; one that is too bright is larger instead."""
    wide, high = box.size
    radiance = times * box.power / (math.pi * wide * high)
    larger = min(LARGER, math.sqrt(max(1.0, radiance / BRIGHTEST)))
    size = [round(larger * wide, 4), round(larger * high, 4)]
    return [list(box.place), size, round(min(BRIGHTEST, radiance / larger**2), 4), list(box.colour)]
