"""Prismatic joints by their slides; those on ground whose rails would cross are the grooves of one plate."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout import limits
from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.slides.common_rails import on_one_line, with_common_rails
from mechanisms.stages.automatic.slides.crossings import with_crossings
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, RAIL, Slide

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Feature, Layout

FAR = 4.0
"""Stops farther beyond the travel than it is long, or than this (half lengths of a block), are not made."""
BESIDE = 0.5
"""Between the end of a rail and the pin beyond it (rmm)."""


@kind("prismatic")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """One for each joint, but one for those on ground that cross, and for those of two bodies along one line; several
    blocks along one line have a common rail where they can.
    """
    slides: list[Slide] = []
    for joint in joints:
        rail_at, block_at = (*layout.place(joint.i), joint.i.angle), (*layout.place(joint.j), joint.j.angle)
        along = layout.seen(joint.j.body.name, block_at[:2], joint.i.body.name) - np.array(rail_at[:2])
        place = along @ np.array([math.cos(joint.i.angle), math.sin(joint.i.angle)])
        travel = float(place.min()), float(place.max())
        lower, upper = (None if end is None else layout.sizes.of_metres(end) for end in limits.sliding(joint, m))
        ends = limits.reached((lower, upper), travel, FAR * HALF_LENGTH)
        given = [end for end in ends if end is not None]
        travel = min(travel[0], *given, travel[1]), max(travel[1], *given, travel[0])
        slide = Slide(joint.name, joint.i.body.name, joint.j.body.name, rail_at, block_at, travel, ends)
        slide = replace(slide, shorter=_room_for_pins(slide, m, layout))
        if given or not any(_repeats(slide, other) for other in slides):
            slides.append(slide)
    return with_crossings(with_common_rails(slides, layout), layout)


def _repeats(slide: Slide, other: Slide) -> bool:
    """Whether another slide of the same two bodies guides along the same line already."""
    return slide.block == other.block and on_one_line(slide, other)


def _room_for_pins(slide: Slide, m: Mechanism, layout: Layout) -> tuple[float, float]:
    """By how much the rail's ends are shortened beside pins of its own body: down to the end of the block at most."""
    if slide.rail == "ground":
        return 0.0, 0.0
    c, s = math.cos(slide.rail_at[2]), math.sin(slide.rail_at[2])
    near = RAIL / 2 + layout.sizes.hardware + BESIDE
    first, last = slide.travel[0] - HALF_LENGTH, slide.travel[1] + HALF_LENGTH
    before = behind = 0.0
    for joint in m.joints.values():
        for marker in (joint.i, joint.j):
            if joint.kind.pair != "pin" or marker.body.name != slide.rail:
                continue
            x, y = layout.place(marker)
            x, y = x - slide.rail_at[0], y - slide.rail_at[1]
            along, aside = c * x + s * y, abs(c * y - s * x)
            if aside < near:
                reach = math.sqrt(near * near - aside * aside)
                if along < slide.travel[0]:
                    before = max(before, along + reach - first)
                elif along > slide.travel[1]:
                    behind = max(behind, last - (along - reach))
    return min(before, RAIL / 2), min(behind, RAIL / 2)
